// The samples of a Poisson set in the making, and the rule by which they keep apart.
#pragma once

#include <cstdint>
#include <vector>

#include "onmesh/poisson/connected_ball.h"
#include "onmesh/poisson/point_grid.h"
#include "onmesh/poisson/spacing_field.h"

namespace onmesh {

/// A point that wants to become a sample.
struct Dart {
  SurfacePoint point;
  Vec3 position;
  double spacing;
  std::uint64_t rank;  ///< of two darts too close to each other the lower one goes first
  Index first_reach = 0, reach = 0;  ///< the faces it reaches, in its block: first and number
};

/// Darts thrown by one thread.
struct DartBlock {
  std::vector<Dart> darts;
  /// Per dart, the faces that the ball of its spacing reaches, sorted; none if only its own.
  std::vector<Index> reach;

  /// \param reached faces that the ball of its spacing reaches, its own first
  void add(const SurfacePoint& point, const Vec3& position, double spacing, std::uint64_t rank,
           const std::vector<Index>& reached);
};

/// The samples, found by where they are.
///
/// Two samples conflict when they are closer in space than the smaller of their spacings ("smaller
/// disks" of Mitchell, Rand, Ebeida and Bajaj, "Variable radii Poisson-disk sampling", 2012), and
/// the surface joins them within the ball of its own spacing around one of them.
///
/// Queries are const and may run in parallel; settle() and append() may not run beside them.
class DiskSet {
 public:
  /// \param origin no sample is below it in any coordinate
  /// \param expected_samples about how many there will be
  /// \pre mesh and field outlive this
  DiskSet(const TriangleMesh& mesh, const SpacingField& field, const Vec3& origin,
          std::size_t expected_samples);

  const TriangleMesh& mesh() const { return mesh_; }
  const SpacingField& field() const { return field_; }
  const std::vector<SurfacePoint>& samples() const { return samples_; }
  const std::vector<double>& spacings() const { return spacings_; }
  std::vector<SurfacePoint> take_samples() { return std::move(samples_); }
  std::vector<double> take_spacings() { return std::move(spacings_); }
  void set_spacing(Index sample, double spacing) { spacings_[sample] = spacing; }

  /// Whether the ball around the sample, which lies on face `own`, reaches the face.
  bool reaches(Index sample, Index own, Index face) const;

  /// Visit samples as PointGrid does; the entries' labels are their faces.
  template <typename Visit>
  bool visit(const Vec3& centre, double low, double high, double radius, const Visit& visit) const {
    return grid_.visit(centre, low, high, radius, visit);
  }

  /// Distance to the closest sample that a point with this spacing conflicts with, the spacing if
  /// there is none. Leaves in `ball` what the ball of that radius around the point reaches, unless
  /// it returns as soon as there is `any`.
  /// \param point with its position in space and its spacing
  /// \param any whether the distance to any such sample will do
  /// \param skip a sample that does not count
  double room(const SurfacePoint& point, const Vec3& position, double spacing, ConnectedBall& ball,
              bool any = false, Index skip = kNone) const;

  /// Add darts that conflict with no sample, in the order of their rank, unless they conflict with
  /// one added before. The result depends neither on the number of threads nor on the order of the
  /// darts, but that is the order in which they are numbered.
  void settle(const std::vector<DartBlock>& blocks);

  /// Add all of them, whether they conflict or not.
  void append(const DartBlock& block);

 private:
  void add(const Dart& dart, const Index* reach);

  const TriangleMesh& mesh_;
  const SpacingField& field_;
  const Vec3 origin_;
  PointGrid grid_;
  std::vector<SurfacePoint> samples_;
  std::vector<double> spacings_;
  std::vector<std::size_t> reach_offsets_{0};
  std::vector<Index> reach_;  // as DartBlock::reach
};

}  // namespace onmesh
