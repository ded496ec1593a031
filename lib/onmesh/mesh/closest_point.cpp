#include "onmesh/mesh/closest_point.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <utility>

#include "onmesh/base/error.h"
#include "onmesh/base/triangle.h"

namespace onmesh {

namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangle = Kernel::Triangle_3;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, std::vector<Triangle>::const_iterator>;
using AabbTree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

Kernel::Point_3 to_cgal(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

double squared_distance(const CGAL::Bbox_3& box, const Vec3& p) {
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    const double d = std::max({box.min(k) - p[k], p[k] - box.max(k), 0.0});
    sum += d * d;
  }
  return sum;
}

}  // namespace

struct ClosestPoint::Tree {
  std::vector<Triangle> triangles;  // faces with area
  std::vector<Index> faces;         // their indices in the mesh
  std::vector<std::array<Vec3, 3>> corners;
  double rounding = 0;  // length below which distances are noise
  AabbTree aabb;
};

namespace {

struct Candidate {
  Index face = kNone;
  double squared_distance = 0;
  Vec3 barycentric = Vec3::Zero();
};

// Visits the nearer box first. CGAL's own closest-point query keeps whichever of several equally
// close faces it meets first; here all of them are kept, so that the lowest index can be chosen.
template <typename Tree>
class ClosestFaces {
 public:
  using Priority = double;

  ClosestFaces(const Tree& tree, const Vec3& point) : tree_(tree), point_(point) {}

  /// Only faces within `limit` that are not labelled `label`.
  ClosestFaces(const Tree& tree, const Vec3& point, double limit, const std::vector<Index>& labels,
               Index label)
      : tree_(tree), point_(point), labels_(&labels), label_(label), limit_(limit * limit) {}

  bool go_further() const { return true; }

  template <typename Query, typename Node>
  bool do_intersect(const Query&, const Node& node) const {
    return squared_distance(node.bbox(), point_) <= limit_;
  }

  template <typename Query, typename Node>
  std::pair<bool, Priority> do_intersect_with_priority(const Query&, const Node& node) const {
    const double d = squared_distance(node.bbox(), point_);
    return {d <= limit_, -d};
  }

  template <typename Query>
  void intersection(const Query&, const Primitive& primitive) {
    const auto i = std::size_t(primitive.id() - tree_.triangles.begin());
    Candidate c;
    c.face = tree_.faces[i];
    if (labels_ != nullptr && (*labels_)[c.face] == label_) return;
    c.barycentric = closest_barycentric(tree_.corners[i], point_);
    c.squared_distance = (interpolate(tree_.corners[i], c.barycentric) - point_).squaredNorm();
    if (c.squared_distance > limit_) return;
    if (c.squared_distance < best_) {
      best_ = c.squared_distance;
      const double d = std::sqrt(best_) * (1 + 1e-12) + tree_.rounding;
      limit_ = std::min(limit_, d * d);
    }
    found_.push_back(c);
  }

  std::optional<SurfacePoint> result() const {
    const Candidate* lowest = nullptr;
    for (const Candidate& c : found_)
      if (c.squared_distance <= limit_ && (!lowest || c.face < lowest->face)) lowest = &c;
    if (lowest == nullptr) return std::nullopt;
    return SurfacePoint{lowest->face, lowest->barycentric};
  }

 private:
  const Tree& tree_;
  const Vec3 point_;
  const std::vector<Index>* const labels_ = nullptr;
  const Index label_ = kNone;
  double best_ = std::numeric_limits<double>::infinity();
  double limit_ = std::numeric_limits<double>::infinity();
  std::vector<Candidate> found_;
};

}  // namespace

ClosestPoint::ClosestPoint(const TriangleMesh& mesh) : tree_(std::make_unique<Tree>()) {
  double largest = 0;
  for (Index f = 0; f < Index(mesh.faces.size()); ++f) {
    const auto t = mesh.corners(f);
    const double longest = std::max(
        {(t[1] - t[0]).squaredNorm(), (t[2] - t[1]).squaredNorm(), (t[0] - t[2]).squaredNorm()});
    if (!((t[1] - t[0]).cross(t[2] - t[0]).norm() > 1e-14 * longest)) continue;
    tree_->triangles.emplace_back(to_cgal(t[0]), to_cgal(t[1]), to_cgal(t[2]));
    tree_->faces.push_back(f);
    tree_->corners.push_back(t);
    for (const Vec3& p : t) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  }
  if (tree_->faces.empty()) throw InputError("the mesh has no face with area to project onto");
  tree_->rounding = 1e-14 * largest;
  tree_->aabb.do_not_accelerate_distance_queries();
  tree_->aabb.insert(tree_->triangles.cbegin(), tree_->triangles.cend());
  tree_->aabb.build();  // now: the first query would do it otherwise, and queries are const
}

ClosestPoint::~ClosestPoint() = default;
ClosestPoint::ClosestPoint(ClosestPoint&&) noexcept = default;
ClosestPoint& ClosestPoint::operator=(ClosestPoint&&) noexcept = default;

SurfacePoint ClosestPoint::closest(const Vec3& point) const {
  ClosestFaces<Tree> search(*tree_, point);
  tree_->aabb.traversal_with_priority(to_cgal(point), search);
  return *search.result();
}

std::optional<SurfacePoint> ClosestPoint::closest_other(const Vec3& point, double limit,
                                                        const std::vector<Index>& labels,
                                                        Index label) const {
  ClosestFaces<Tree> search(*tree_, point, limit, labels, label);
  tree_->aabb.traversal_with_priority(to_cgal(point), search);
  return search.result();
}

}  // namespace onmesh
