// The numbers in a glTF file: accessors (3.6.2 of the specification) (internal).
#pragma once

#include <vector>

#include "onmesh/mesh_io/gltf/gltf_file.h"

namespace onmesh {

/// How an accessor stores its numbers.
enum class GltfType { i8, u8, i16, u16, u32, f32 };

/// What an accessor says of itself.
struct GltfAccessor {
  JsonPlace place;
  std::size_t count = 0;  ///< elements
  int components = 0;     ///< numbers per element
  GltfType type = GltfType::f32;
  bool normalized = false;  ///< integers stand for [0,1] or [-1,1]

  /// "float32", "uint16 (normalized)"
  std::string type_name() const;
};

/// \throw InputError naming the accessor
GltfAccessor describe_accessor(const GltfFile& file, Index accessor);

/// All numbers of an accessor, with its sparse ones put in; normalised where it says so (3.6.2.2).
/// Without a buffer view they are zero.
/// \param components that each element should have; 16 = a 4 x 4 matrix
/// \throw InputError naming the accessor, also if its elements do not lie in their buffer view
std::vector<double> read_numbers(GltfFile& file, Index accessor, int components);

/// The vertex indices of an accessor.
/// \param vertices that there are
/// \throw InputError as above, and if one is out of range
std::vector<Index> read_indices(GltfFile& file, Index accessor, std::size_t vertices);

}  // namespace onmesh
