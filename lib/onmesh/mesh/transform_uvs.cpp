#include "onmesh/mesh/transform_uvs.h"

#include <array>
#include <bit>
#include <cstdint>
#include <map>
#include <optional>
#include <unordered_map>

namespace onmesh {
namespace {

/// What is done to UVs: the different pairs of a map and wrap modes, that of faces without a
/// material first.
struct UvUses {
  std::vector<UvTransform> transforms;  ///< per use
  std::vector<Index> of_material;       ///< which use each material has
};

UvUses find_uses(const TriangleMesh& mesh, const std::vector<UvTransform>& transforms) {
  UvUses result;
  // By the bits of the map, which may hold what is not a number, and by the modes.
  std::map<std::array<std::uint64_t, 7>, Index> numbers;
  const auto number_of = [&](const UvTransform& transform, const std::optional<WrapModes>& wrap) {
    std::array<std::uint64_t, 7> key{};
    for (int i = 0; i < 6; ++i) {
      key[static_cast<std::size_t>(i)] = std::bit_cast<std::uint64_t>(transform(i / 3, i % 3));
    }
    if (wrap) {
      key[6] = 1 + 3 * static_cast<std::uint64_t>(wrap->u) + static_cast<std::uint64_t>(wrap->v);
    }
    const auto [at, is_new] =
        numbers.try_emplace(key, static_cast<Index>(result.transforms.size()));
    if (is_new) result.transforms.push_back(transform);
    return at->second;
  };
  number_of(UvTransform::Identity(), std::nullopt);
  for (std::size_t m = 0; m < mesh.materials.size(); ++m) {
    const bool is_given = m < transforms.size();
    const UvTransform transform = is_given ? transforms[m] : UvTransform(UvTransform::Identity());
    result.of_material.push_back(number_of(transform, mesh.materials[m].wrap));
  }
  return result;
}

}  // namespace

UvTransform scale_and_offset(const Vec2& scale, const Vec2& offset) {
  UvTransform result = UvTransform::Zero();
  result(0, 0) = scale.x();
  result(1, 1) = scale.y();
  result.col(2) = offset;
  return result;
}

Index transform_uvs(TriangleMesh& mesh, const std::vector<UvTransform>& transforms) {
  const UvUses uses = find_uses(mesh, transforms);
  if (uses.transforms.size() == 1) return 0;
  // The first use of a UV keeps its number, others get one of their own.
  std::vector<Index> use_of(mesh.uvs.size(), kNone);
  std::unordered_map<std::uint64_t, Index> numbers;  // of (use, UV)
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const Index material = mesh.face_materials[f];
    const Index use = material == kNone ? 0 : uses.of_material[material];
    for (Index& uv : mesh.face_uvs[f]) {
      if (uv == kNone || use_of[uv] == use) continue;
      if (use_of[uv] == kNone) {
        use_of[uv] = use;
        continue;
      }
      const auto [at, is_new] =
          numbers.try_emplace(std::uint64_t{use} << 32 | uv, static_cast<Index>(mesh.uvs.size()));
      if (is_new) {
        mesh.uvs.push_back(Vec2(mesh.uvs[uv]));
        use_of.push_back(use);
      }
      uv = at->second;
    }
  }
  Index missing = 0;
  for (std::size_t i = 0; i < mesh.uvs.size(); ++i) {
    // What stays as it is must do so bit for bit.
    if (use_of[i] == kNone || uses.transforms[use_of[i]] == UvTransform::Identity()) continue;
    mesh.uvs[i] = uses.transforms[use_of[i]] * mesh.uvs[i].homogeneous();
    missing += mesh.uvs[i].allFinite() ? 0 : 1;
  }
  if (missing == 0) return 0;
  for (auto& corners : mesh.face_uvs) {
    for (Index& uv : corners) {
      if (uv != kNone && !mesh.uvs[uv].allFinite()) uv = kNone;
    }
  }
  for (Vec2& uv : mesh.uvs) {
    if (!uv.allFinite()) uv.setZero();
  }
  return missing;
}

}  // namespace onmesh
