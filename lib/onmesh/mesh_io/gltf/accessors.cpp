#include "onmesh/mesh_io/gltf/accessors.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>

#include "onmesh/base/byte_order.h"
#include "onmesh/base/text_scan.h"

namespace onmesh {
namespace {

GltfType parse_component_type(const JsonPlace& place) {
  switch (place.whole_number()) {
    case 5120:
      return GltfType::i8;
    case 5121:
      return GltfType::u8;
    case 5122:
      return GltfType::i16;
    case 5123:
      return GltfType::u16;
    case 5125:
      return GltfType::u32;
    case 5126:
      return GltfType::f32;
    default:
      place.fail("is no component type");
  }
}

int components_of(const JsonPlace& place) {
  const std::string& name = place.text();
  if (name == "SCALAR") return 1;
  if (name == "VEC2") return 2;
  if (name == "VEC3") return 3;
  if (name == "VEC4") return 4;
  if (name == "MAT4") return 16;
  place.fail("is not read: " + quote(name));
}

std::size_t size_of(GltfType type) {
  constexpr std::array<std::size_t, 6> kSizes = {1, 1, 2, 2, 4, 4};
  return kSizes[std::size_t(type)];
}

/// Calls work with a number of the type.
template <class Work>
void with_type(GltfType type, const Work& work) {
  switch (type) {
    case GltfType::i8:
      return work(std::int8_t{});
    case GltfType::u8:
      return work(std::uint8_t{});
    case GltfType::i16:
      return work(std::int16_t{});
    case GltfType::u16:
      return work(std::uint16_t{});
    case GltfType::u32:
      return work(std::uint32_t{});
    case GltfType::f32:
      return work(float{});
  }
}

/// Elements that follow each other in a buffer view.
struct Elements {
  const char* first = nullptr;  ///< null: all are zero
  std::size_t stride = 0;       ///< bytes
};

/// \param at the accessor, or a part of its sparse ones: names the buffer view and the offset in it
/// \param count elements of `size` bytes
Elements find_elements(GltfFile& file, const JsonPlace& at, std::size_t count, std::size_t size) {
  const auto view = at.find_index("bufferView", file.root().size_of("bufferViews"));
  if (!view) return {};
  const std::uint64_t stride = file.element("bufferViews", *view).whole_number("byteStride", size);
  const std::uint64_t offset = at.whole_number("byteOffset", 0);
  const std::string_view bytes = file.view(*view);
  if (stride < size) at.fail("elements of its buffer view overlap (byteStride)");
  // Divided rather than multiplied: nothing overflows.
  const bool fits =
      count == 0 || (offset <= bytes.size() && size <= bytes.size() - offset &&
                     count - 1 <= (bytes.size() - offset - size) / std::size_t(stride));
  if (!fits) {
    at.fail(std::to_string(count) + " elements from byte " + std::to_string(offset) +
            " reach beyond the buffer view, which has " + std::to_string(bytes.size()) + " bytes");
  }
  return {bytes.data() + offset, std::size_t(stride)};
}

/// Copy elements, converted, to where each goes.
/// \param target called with the number of an element
template <class Out, class Target>
void convert(const GltfAccessor& accessor, const Elements& elements, std::size_t count,
             const Target& target) {
  const auto components = std::size_t(accessor.components);
  with_type(accessor.type, [&](auto zero) {
    using Stored = decltype(zero);
    const double unit = accessor.normalized && !std::is_floating_point_v<Stored>
                            ? double(std::numeric_limits<Stored>::max())
                            : 1.0;
    for (std::size_t i = 0; i < count; ++i) {
      const char* from = elements.first + i * elements.stride;
      Out* const to = target(i);
      for (std::size_t c = 0; c < components; ++c, from += sizeof(Stored)) {
        const auto stored = from_bytes<Stored>(from, std::endian::little);
        if constexpr (std::is_same_v<Out, double>) {
          to[c] = unit == 1 ? double(stored) : std::max(double(stored) / unit, -1.0);
        } else {
          to[c] = Out(stored);
        }
      }
    }
  });
}

/// Where the sparse elements go, ascending.
std::vector<Index> read_sparse_indices(GltfFile& file, const JsonPlace& sparse, std::size_t count,
                                       std::size_t of) {
  const JsonPlace at = sparse.at("indices");
  at.at("bufferView");
  GltfAccessor described{at, count, 1, parse_component_type(at.at("componentType")), false};
  if (described.type != GltfType::u8 && described.type != GltfType::u16 &&
      described.type != GltfType::u32)
    at.at("componentType").fail("is none of an index");
  const Elements elements = find_elements(file, at, count, size_of(described.type));
  std::vector<Index> indices(count);
  convert<Index>(described, elements, count, [&](std::size_t i) { return &indices[i]; });
  for (std::size_t i = 0; i < count; ++i) {
    if (indices[i] >= of) at.fail("index " + std::to_string(indices[i]) + " is out of range");
    if (i > 0 && indices[i] <= indices[i - 1]) at.fail("does not ascend");
  }
  return indices;
}

template <class Out>
std::vector<Out> read_elements(GltfFile& file, const GltfAccessor& accessor) {
  const auto components = std::size_t(accessor.components);
  const std::size_t size = size_of(accessor.type) * components;
  // Its buffer counts for what may be made of it. What does not lie in one may be any number.
  const Elements elements = find_elements(file, accessor.place, accessor.count, size);
  file.take_memory(double(accessor.count) * double(components * sizeof(Out)), accessor.place);
  std::vector<Out> values(accessor.count * components);
  if (elements.first != nullptr) {
    convert<Out>(accessor, elements, accessor.count,
                 [&](std::size_t i) { return &values[i * components]; });
  }
  const auto sparse = accessor.place.find("sparse");
  if (!sparse) return values;
  const std::uint64_t count = sparse->at("count").whole_number();
  if (count > accessor.count) sparse->at("count").fail("is larger than the accessor's");
  const std::vector<Index> indices = read_sparse_indices(file, *sparse, count, accessor.count);
  const JsonPlace at = sparse->at("values");
  at.at("bufferView");
  const Elements replaced = find_elements(file, at, count, size);
  convert<Out>(accessor, replaced, count,
               [&](std::size_t i) { return &values[indices[i] * components]; });
  return values;
}

}  // namespace

std::string GltfAccessor::type_name() const {
  constexpr std::array<const char*, 6> kNames = {"int8",   "uint8",  "int16",
                                                 "uint16", "uint32", "float32"};
  return std::string(kNames[std::size_t(type)]) + (normalized ? " (normalized)" : "");
}

GltfAccessor describe_accessor(const GltfFile& file, Index accessor) {
  const JsonPlace place = file.element("accessors", accessor);
  GltfAccessor found{place, place.at("count").whole_number(), components_of(place.at("type")),
                     parse_component_type(place.at("componentType")), place.flag("normalized")};
  if (found.count >= kNone) place.at("count").fail("is more than 32 bits can count");
  return found;
}

std::vector<double> read_numbers(GltfFile& file, Index accessor, int components) {
  const GltfAccessor found = describe_accessor(file, accessor);
  if (found.components != components) {
    found.place.at("type").fail("should have " + std::to_string(components) +
                                " numbers per element");
  }
  if (found.type == GltfType::u32) found.place.at("componentType").fail("is one of indices only");
  return read_elements<double>(file, found);
}

std::vector<Index> read_indices(GltfFile& file, Index accessor, std::size_t vertices) {
  const GltfAccessor found = describe_accessor(file, accessor);
  const bool is_index =
      found.type == GltfType::u8 || found.type == GltfType::u16 || found.type == GltfType::u32;
  if (!is_index || found.components != 1) found.place.fail("is no accessor of indices");
  std::vector<Index> indices = read_elements<Index>(file, found);
  for (const Index i : indices) {
    if (i >= vertices) {
      found.place.fail("vertex index " + std::to_string(i) + " is out of range (" +
                       std::to_string(vertices) + " vertices)");
    }
  }
  return indices;
}

}  // namespace onmesh
