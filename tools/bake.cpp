#include "bake.h"

#include <cmath>
#include <numbers>

#include "onmesh/atlas/texel_map.h"
#include "onmesh/base/parallel.h"
#include "onmesh/base/random.h"
#include "onmesh/base/triangle.h"
#include "onmesh/mesh/ray_caster.h"
#include "onmesh/mesh/shading_normals.h"

namespace onmesh::tools {
Image bake_sky(const TriangleMesh& mesh, int size, int rays, std::uint64_t seed) {
  const TexelMap map = make_texel_map(mesh, size, size);
  const RayCaster caster(mesh);
  const auto normals = shading_normals(mesh);
  const double reach = mesh.diagonal(), offset = 1e-4 * reach;
  Image image = make_image(size, size, 1);
  parallel_over(mesh.faces.size(), [&](std::size_t face) {
    const auto f = Index(face);
    const auto corner = mesh.corners(f);
    const Vec3 flat = (corner[1] - corner[0]).cross(corner[2] - corner[0]).stableNormalized();
    for (Index k = map.face_offsets[f]; k < map.face_offsets[f + 1]; ++k) {
      const Index texel = map.tiles[0].texel(map.claims[k]);
      const Vec3 at = map.barycentric(f, map.claims[k]);
      const Vec3 normal = interpolate(normals[f], at).normalized();
      const Vec3 from = interpolate(corner, at) + offset * flat;
      const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
      SplitMix random(seed, texel);
      int seen = 0;
      for (int ray = 0; ray < rays; ++ray) {
        const double square = random.uniform();
        const double turn = 2 * std::numbers::pi * random.uniform();
        const Vec3 direction = std::sqrt(1 - square) * normal +
                               std::sqrt(square) * (std::cos(turn) * u + std::sin(turn) * v);
        seen += direction.y() > 0 && direction.dot(flat) > 0 &&
                !caster.meets(from, from + reach * direction);
      }
      image.pixels[texel] = float(seen) / float(rays);
    }
  });
  return image;
}

}  // namespace onmesh::tools
