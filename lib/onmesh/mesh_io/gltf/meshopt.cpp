#include <array>
#include <cstdint>

#include "onmesh/base/text_scan.h"
#include "onmesh/mesh_io/gltf/compression.h"

#ifdef ONMESH_HAS_MESHOPT
#include <meshoptimizer.h>
#endif

namespace onmesh {

#ifdef ONMESH_HAS_MESHOPT

namespace {

using Filter = void (*)(void* buffer, std::size_t count, std::size_t stride);

Filter filter_of(const JsonPlace& place, std::size_t stride) {
  const std::string name = place.text("filter");
  const auto refuse_stride = [&](bool fits) {
    if (!fits) place.at("byteStride").fail("does not go with the filter " + name);
  };
  if (name.empty() || name == "NONE") return nullptr;
  if (name == "OCTAHEDRAL") {
    refuse_stride(stride == 4 || stride == 8);
    return meshopt_decodeFilterOct;
  }
  if (name == "QUATERNION") {
    refuse_stride(stride == 8);
    return meshopt_decodeFilterQuat;
  }
  if (name == "EXPONENTIAL") {
    refuse_stride(stride % 4 == 0);
    return meshopt_decodeFilterExp;
  }
  place.at("filter").fail("is unknown: " + quote(name));
}

}  // namespace

bool can_read_meshopt() { return true; }

std::string unpack_meshopt(std::string_view packed, const JsonPlace& place) {
  const std::size_t count = place.at("count").whole_number();
  const std::size_t stride = place.at("byteStride").whole_number();
  const std::string mode = place.at("mode").text();
  const auto* const bytes = reinterpret_cast<const unsigned char*>(packed.data());
  const auto refuse_stride = [&](bool fits) {
    if (!fits) place.at("byteStride").fail("does not go with the mode " + mode);
  };
  std::string result(count * stride, '\0');
  int error = 0;
  if (mode == "ATTRIBUTES") {
    refuse_stride(stride >= 4 && stride <= 256 && stride % 4 == 0);
    const Filter filter = filter_of(place, stride);
    error = meshopt_decodeVertexBuffer(result.data(), count, stride, bytes, packed.size());
    if (error == 0 && filter != nullptr) filter(result.data(), count, stride);
  } else if (mode == "TRIANGLES") {
    refuse_stride(stride == 2 || stride == 4);
    if (count % 3 != 0) place.at("count").fail("is no multiple of three");
    error = meshopt_decodeIndexBuffer(result.data(), count, stride, bytes, packed.size());
  } else if (mode == "INDICES") {
    refuse_stride(stride == 2 || stride == 4);
    error = meshopt_decodeIndexSequence(result.data(), count, stride, bytes, packed.size());
  } else {
    place.at("mode").fail("is unknown: " + quote(mode));
  }
  if (error != 0) place.fail("the compressed data are damaged");
  return result;
}

#else

bool can_read_meshopt() { return false; }

std::string unpack_meshopt(std::string_view /*packed*/, const JsonPlace& place) {
  place.fail("this program was built without meshoptimizer");
}

#endif

}  // namespace onmesh
