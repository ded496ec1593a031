#include "onmesh/mesh/ray_caster.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include "onmesh/base/error.h"

namespace onmesh {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangle = Kernel::Triangle_3;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, std::vector<Triangle>::const_iterator>;
using AabbTree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

Kernel::Point_3 to_cgal(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

}  // namespace

struct RayCaster::Tree {
  std::vector<Triangle> triangles;
  AabbTree aabb;
};

RayCaster::RayCaster(const TriangleMesh& mesh) : tree_(std::make_unique<Tree>()) {
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (mesh.is_degenerate(f)) continue;
    const auto corner = mesh.corners(f);
    tree_->triangles.emplace_back(to_cgal(corner[0]), to_cgal(corner[1]), to_cgal(corner[2]));
  }
  if (tree_->triangles.empty()) throw InputError("no face of the mesh has area");
  tree_->aabb.rebuild(tree_->triangles.begin(), tree_->triangles.end());
  tree_->aabb.build();
}
RayCaster::~RayCaster() = default;
RayCaster::RayCaster(RayCaster&&) noexcept = default;

bool RayCaster::meets(const Vec3& from, const Vec3& to) const {
  return tree_->aabb.do_intersect(Kernel::Segment_3(to_cgal(from), to_cgal(to)));
}

}  // namespace onmesh
