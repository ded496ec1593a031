#include <cstdint>
#include <limits>
#include <memory>

#include "onmesh/mesh_io/gltf/compression.h"

#ifdef ONMESH_HAS_DRACO
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#endif

namespace onmesh {

#ifdef ONMESH_HAS_DRACO

namespace {

/// Where the decoder reads numbers of elements, before it makes room for them.
class DracoHeader {
 public:
  DracoHeader(std::string_view bytes, const JsonPlace& place) : bytes_(bytes), place_(place) {}

  /// Hold the triangles that the data promise against the accessor's: bytes of the file should say
  /// how much is decoded, not a number in them.
  /// \return whether the triangles are in edgebreaker's order, not one by one
  bool check(const DracoSize& size) {
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
    if (!size.fits(found)) place_.fail("has another number of triangles than its accessor");
    return method == 1;
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

/// Bytes that the decoder needs for attributes: each number is an integer first, then of its type.
double unpacked_bytes(const draco::PointCloud& points) {
  double bytes = 0;
  for (int i = 0; i < points.num_attributes(); ++i) {
    const draco::PointAttribute& attribute = *points.attribute(i);
    const double number = sizeof(std::int32_t) + draco::DataTypeLength(attribute.data_type());
    bytes += number * attribute.num_components() * points.num_points();
  }
  return bytes;
}

/// Stops where it knows what attributes there are, before it makes room for them, if that is too
/// much.
template <class Decoder>
class BoundedDecoder : public Decoder {
 public:
  explicit BoundedDecoder(double most_bytes) : most_bytes_(most_bytes) {}

  bool is_too_large() const { return is_too_large_; }

 protected:
  bool DecodeAllAttributes() override {
    is_too_large_ = unpacked_bytes(*this->point_cloud()) > most_bytes_;
    return !is_too_large_ && Decoder::DecodeAllAttributes();
  }

 private:
  double most_bytes_;
  bool is_too_large_ = false;
};

template <class Decoder>
std::unique_ptr<draco::Mesh> decode(std::string_view packed, const JsonPlace& place,
                                    double most_bytes) {
  draco::DecoderBuffer buffer;
  buffer.Init(packed.data(), packed.size());
  BoundedDecoder<Decoder> decoder(most_bytes);
  auto mesh = std::make_unique<draco::Mesh>();
  const bool is_decoded = decoder.Decode(draco::DecoderOptions(), &buffer, mesh.get()).ok();
  if (decoder.is_too_large()) place.fail("its attributes would become much larger than the file");
  if (!is_decoded) place.fail("the Draco data are damaged");
  return mesh;
}

}  // namespace

bool can_read_draco() { return true; }

DracoMesh unpack_draco(std::string_view packed, const JsonPlace& place,
                       const std::vector<DracoAttribute>& wanted, const DracoSize& size) {
  const bool is_edgebreaker = DracoHeader(packed, place).check(size);
  const auto decoded = is_edgebreaker
                           ? decode<draco::MeshEdgebreakerDecoder>(packed, place, size.most_bytes)
                           : decode<draco::MeshSequentialDecoder>(packed, place, size.most_bytes);
  const draco::Mesh& mesh = *decoded;
  const std::size_t vertices = size.vertices;
  if (mesh.num_points() != vertices || !size.fits(mesh.num_faces()))
    place.fail("has another number of vertices or triangles than its accessors");
  DracoMesh result;
  result.vertices = vertices;
  result.unpacked_bytes = unpacked_bytes(mesh);
  result.corners.reserve(3 * std::size_t(mesh.num_faces()));
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
                       const std::vector<DracoAttribute>& /*wanted*/, const DracoSize& /*size*/) {
  place.fail("this program was built without Draco");
}

#endif

}  // namespace onmesh
