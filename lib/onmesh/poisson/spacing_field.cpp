#include "onmesh/poisson/spacing_field.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "onmesh/atlas/texel_map.h"
#include "onmesh/base/error.h"

namespace onmesh {

namespace {

constexpr double kMostAnisotropy = 16;
constexpr double kTolerance = 1e-3;  // the sampler's: a sample may be that much farther away
constexpr Index kLeafSize = 4;

double squared_distance_to_triangle(const std::array<Vec3, 3>& t, const Vec3& p) {
  const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
  const double squared = normal.squaredNorm();
  bool inside = squared > 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 edge = t[(k + 1) % 3] - t[k], d = p - t[k];
    inside = inside && edge.cross(d).dot(normal) >= 0;
    const double length = edge.squaredNorm();
    const double s = length > 0 ? std::clamp(d.dot(edge) / length, 0.0, 1.0) : 0.0;
    least = std::min(least, (d - s * edge).squaredNorm());
  }
  if (!inside) return least;
  const double height = (p - t[0]).dot(normal);
  return std::min(least, height * height / squared);
}

/// Radius of the disc inscribed in a texel on the face.
double texel_disc(const TriangleMesh& mesh, const TexelMap& map, Index face) {
  const auto t = mesh.corners(face);
  const Eigen::Matrix3d& rates = map.to_barycentric(face);
  const Vec3 side_x = rates(0, 0) * t[0] + rates(1, 0) * t[1] + rates(2, 0) * t[2];
  const Vec3 side_y = rates(0, 1) * t[0] + rates(1, 1) * t[1] + rates(2, 1) * t[2];
  const double longer = std::max(side_x.norm(), side_y.norm());
  const double disc = 0.5 * side_x.cross(side_y).norm() / longer;
  return std::max(disc, 0.5 * longer / kMostAnisotropy) / (1 + kTolerance);
}

}  // namespace

SpacingField::SpacingField(double spacing) : least_(spacing), largest_(spacing) {}

SpacingField::SpacingField(const TriangleMesh& mesh, const TexelMap& map)
    : mesh_(&mesh),
      least_(std::numeric_limits<double>::infinity()),
      largest_(0),
      discs_(map.texel_area.size(), 0.0) {
  for (Index f = 0; f < Index(discs_.size()); ++f) {
    if (!(map.texel_area[f] > 0) || map.face_offsets[f + 1] == map.face_offsets[f]) continue;
    discs_[f] = texel_disc(mesh, map, f);
    if (!(discs_[f] > 0) || !std::isfinite(discs_[f])) {
      discs_[f] = 0;
      continue;
    }
    least_ = std::min(least_, discs_[f]);
    largest_ = std::max(largest_, discs_[f]);
    sources_.push_back(f);
  }
  if (sources_.empty()) throw InputError("no texel lies on the surface");
  for (double& disc : discs_)
    if (disc == 0) disc = largest_;
  if (!graded()) return;
  nodes_.reserve(sources_.size());
  build(0, Index(sources_.size()));
}

// Halves the sources at the median of their centroids along the longest side of the box.
void SpacingField::build(Index first, Index last) {
  const std::size_t at = nodes_.size();
  Node node{
      Vec3::Constant(std::numeric_limits<double>::infinity()), Vec3(), largest_, first, last, 0};
  node.high = -node.low;
  for (Index i = first; i < last; ++i) {
    for (const Vec3& p : mesh_->corners(sources_[i])) {
      node.low = node.low.cwiseMin(p);
      node.high = node.high.cwiseMax(p);
    }
    node.least = std::min(node.least, discs_[sources_[i]]);
  }
  nodes_.push_back(node);
  if (last - first <= kLeafSize) return;
  int axis = 0;
  (node.high - node.low).maxCoeff(&axis);
  const Index middle = first + (last - first) / 2;
  const auto place = [&](Index f) {
    const auto t = mesh_->corners(f);
    return t[0][axis] + t[1][axis] + t[2][axis];
  };
  std::nth_element(sources_.begin() + first, sources_.begin() + middle, sources_.begin() + last,
                   [&](Index a, Index b) {
                     const double pa = place(a), pb = place(b);
                     return pa != pb ? pa < pb : a < b;
                   });
  build(first, middle);
  nodes_[at].second = Index(nodes_.size());
  build(middle, last);
}

// Calls visit(source) for the sources of all leaves with within(node).
template <class Within, class Visit>
void SpacingField::visit(const Within& within, const Visit& visit) const {
  std::array<Index, 64> stack;  // at most one entry per level: halving 2^32 sources takes 32
  std::size_t size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const Index at = stack[--size];
    const Node& node = nodes_[at];
    if (!within(node)) continue;
    if (node.second == 0) {
      for (Index i = node.first; i < node.last; ++i) visit(sources_[i]);
    } else {
      stack[size++] = node.second;
      stack[size++] = at + 1;
    }
  }
}

double SpacingField::limit(Index source, const Vec3& position) const {
  return discs_[source] +
         kSlope * std::sqrt(squared_distance_to_triangle(mesh_->corners(source), position));
}

double SpacingField::at(Index face, const Vec3& position) const {
  double spacing = most(face);
  if (nodes_.empty()) return spacing;
  const auto within = [&](const Node& node) {
    const double room = (spacing - node.least) / kSlope;
    const Vec3 d = (node.low - position).cwiseMax(position - node.high).cwiseMax(0.0);
    return room > 0 && d.squaredNorm() < room * room;
  };
  visit(within, [&](Index source) {
    if (discs_[source] < spacing) spacing = std::min(spacing, limit(source, position));
  });
  return spacing;
}

std::vector<Index> SpacingField::sources_near(const FaceFrame& frame, const Cell& cell) const {
  std::vector<Index> result;
  if (nodes_.empty()) return result;
  const Vec3 centre = frame.position(cell.centre());
  const double radius = cell.radius(), most_here = most(frame.face);
  const auto within = [&](const Node& node) {
    const double room = (most_here - node.least) / kSlope;
    const Vec3 d = (node.low - centre).cwiseMax(centre - node.high).cwiseMax(0.0);
    return room > 0 && d.squaredNorm() < (room + radius) * (room + radius);
  };
  visit(within, [&](Index source) {
    if (source != frame.face && discs_[source] < most_here &&
        limit(source, centre) - kSlope * radius < most_here)
      result.push_back(source);
  });
  return result;
}

bool CellSpacing::bound(const SpacingField& field, const FaceFrame& frame, const Cell& cell,
                        const Index* sources, std::size_t count, std::vector<Index>* kept) {
  const double most = field.most(frame.face);
  centre = low = high = most;
  if (count == 0) return false;
  const Vec3 position = frame.position(cell.centre());
  limits_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    limits_[i] = field.limit(sources[i], position);
    centre = std::min(centre, limits_[i]);
  }
  const double change = field.slope() * cell.radius();
  high = std::min(most, centre + change);
  low = std::max(field.least(), centre - change);
  bool any = false;
  for (std::size_t i = 0; i < count; ++i) {
    if (!(limits_[i] - change < high)) continue;
    any = true;
    if (kept) kept->push_back(sources[i]);
  }
  if (!any) centre = low = high;
  return any;
}

namespace {

/// Integral of 1 / spacing^2 over the cells of a face, relative to their area.
class DensityIntegral {
 public:
  DensityIntegral(const SpacingField& field, const FaceFrame& frame)
      : field_(field),
        frame_(frame),
        whole_{Vec2::Zero(), frame.size},
        sources_(field.sources_near(frame, whole_)) {}

  double mean() {
    if (sources_.empty()) return 1 / (field_.most(frame_.face) * field_.most(frame_.face));
    add(whole_, 0, sources_.size());
    return sum_ / area_;
  }

 private:
  void add(const Cell& cell, std::size_t first, std::size_t count) {
    if (!cell.meets(frame_)) return;
    const std::size_t own = sources_.size();
    CellSpacing spacing;
    kept_.clear();
    const bool varies = spacing.bound(field_, frame_, cell, sources_.data() + first, count, &kept_);
    if (!varies || cell.radius() <= 0.5 * spacing.centre) {
      sum_ += cell.area() / (spacing.centre * spacing.centre);
      area_ += cell.area();
      return;
    }
    sources_.insert(sources_.end(), kept_.begin(), kept_.end());
    const std::size_t own_count = sources_.size() - own;
    for (const Cell& half : cell.split()) add(half, own, own_count);
    sources_.resize(own);
  }

  const SpacingField& field_;
  const FaceFrame& frame_;
  const Cell whole_;
  std::vector<Index> sources_, kept_;  // a stack; those of the cell at hand
  double sum_ = 0, area_ = 0;
};

}  // namespace

double SpacingField::expected_samples(const TriangleMesh& mesh,
                                      const std::vector<Index>& faces) const {
  std::vector<double> counts(faces.size());
  oneapi::tbb::parallel_for(std::size_t(0), faces.size(), [&](std::size_t i) {
    const FaceFrame frame(faces[i], mesh.corners(faces[i]));
    const double area = 0.5 * frame.size.prod();
    counts[i] =
        frame.size.y() > 0 ? kPoissonDensity * area * DensityIntegral(*this, frame).mean() : 0;
  });
  return std::accumulate(counts.begin(), counts.end(), 0.0);
}

}  // namespace onmesh
