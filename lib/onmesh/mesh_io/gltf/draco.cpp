#include <array>
#include <cstdint>
#include <limits>

#include "onmesh/mesh_io/gltf/compression.h"

#ifdef ONMESH_HAS_DRACO
#include <draco/compression/decode.h>
#endif

namespace onmesh {

#ifdef ONMESH_HAS_DRACO

namespace {

/// Where the decoder reads numbers of elements, before it makes room for them.
class DracoHeader {
 public:
  DracoHeader(std::string_view bytes, const JsonPlace& place) : bytes_(bytes), place_(place) {}

  /// Hold the triangles that the data promise against the accessors': bytes of the file should say
  /// how much is decoded, not a number in them.
  void check(std::size_t triangles) {
    if (!bytes_.starts_with("DRACO")) place_.fail("is no Draco data");
    at_ = 5;
    const unsigned major = byte(), minor = byte();
    if (major != 2 || minor > 2) place_.fail("Draco data of another version than 2");
    if (byte() != 1) place_.fail("is a point cloud, not a mesh");
    const unsigned method = byte();
    const unsigned flags = byte() | byte() << 8U;
    if ((flags & 0x8000U) != 0) place_.fail("Draco data with metadata are not read");
    const bool is_varint = minor >= 2;
    if (method == 1) {                // edgebreaker
      byte();                         // how it is traversed
      if (!is_varint) word();         // vertices made by splits
      is_varint ? varint() : word();  // vertices
    }
    const std::uint64_t found = is_varint ? varint() : word();
    if (found != triangles) place_.fail("has another number of triangles than its accessor");
  }

 private:
  unsigned byte() {
    if (at_ >= bytes_.size()) place_.fail("the Draco data end early");
    return static_cast<unsigned char>(bytes_[at_++]);
  }
  std::uint64_t word() {
    std::uint64_t value = 0;
    for (unsigned shift = 0; shift < 32; shift += 8) value |= std::uint64_t(byte()) << shift;
    return value;
  }
  std::uint64_t varint() {
    std::uint64_t value = 0;
    for (unsigned shift = 0; shift < 63; shift += 7) {
      const unsigned next = byte();
      value |= std::uint64_t(next & 127U) << shift;
      if (next < 128) return value;
    }
    place_.fail("the Draco data are damaged");
  }

  std::string_view bytes_;
  const JsonPlace& place_;
  std::size_t at_ = 0;
};

}  // namespace

bool can_read_draco() { return true; }

DracoMesh unpack_draco(std::string_view packed, const JsonPlace& place,
                       const std::vector<DracoAttribute>& wanted, std::size_t vertices,
                       std::size_t corners) {
  DracoHeader(packed, place).check(corners / 3);
  draco::DecoderBuffer buffer;
  buffer.Init(packed.data(), packed.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) place.fail("the Draco data are damaged");
  const draco::Mesh& mesh = *decoded.value();
  if (mesh.num_points() != vertices || std::size_t(mesh.num_faces()) * 3 != corners)
    place.fail("has another number of vertices or triangles than its accessors");
  DracoMesh result;
  result.vertices = vertices;
  result.corners.reserve(corners);
  for (draco::FaceIndex f(0); f < mesh.num_faces(); ++f) {
    for (const draco::PointIndex& point : mesh.face(f)) {
      if (point.value() >= vertices) place.fail("a vertex index is out of range");
      result.corners.push_back(point.value());
    }
  }
  for (const DracoAttribute& attribute : wanted) {
    const bool is_id = attribute.id <= std::numeric_limits<std::uint32_t>::max();
    const draco::PointAttribute* const found =
        is_id ? mesh.GetAttributeByUniqueId(std::uint32_t(attribute.id)) : nullptr;
    if (found == nullptr || found->num_components() != attribute.components)
      place.at("attributes").fail("the Draco data have no such attribute");
    auto& values = result.attributes.emplace_back(vertices * std::size_t(attribute.components));
    for (draco::PointIndex p(0); p < mesh.num_points(); ++p) {
      const draco::AttributeValueIndex at = found->mapped_index(p);
      double* const out = values.data() + p.value() * std::size_t(attribute.components);
      if (at.value() >= found->size() ||
          !found->ConvertValue(at, std::int8_t(attribute.components), out))
        place.at("attributes").fail("the Draco data are damaged");
    }
  }
  return result;
}

#else

bool can_read_draco() { return false; }

DracoMesh unpack_draco(std::string_view /*packed*/, const JsonPlace& place,
                       const std::vector<DracoAttribute>& /*wanted*/, std::size_t /*vertices*/,
                       std::size_t /*corners*/) {
  place.fail("this program was built without Draco");
}

#endif

}  // namespace onmesh
