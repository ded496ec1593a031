#include "onmesh/poisson/gap_filling.h"

#include <algorithm>

#include "onmesh/base/triangle.h"

namespace onmesh {

namespace {

// Lengths in spacings. Larger cells than the base are divided at once; a cell of the finest size
// that takes no dart counts as covered, which leaves gaps up to twice that.
constexpr double kPartRadius = 64;
constexpr double kBaseRadius = 0.8;
constexpr double kFinestRadius = 0.5e-3;

template <class Emit>
void split_until(const FaceFrame& frame, const Cell& cell, double radius, const Emit& emit) {
  if (!cell.meets(frame)) return;
  if (cell.radius() <= radius) {
    emit(cell);
    return;
  }
  for (const Cell& half : cell.split()) split_until(frame, half, radius, emit);
}

class Divider {
 public:
  Divider(const SpacingField& field, const FaceFrame& frame, CellList& list)
      : field_(field), frame_(frame), list_(list) {}

  void divide(const Cell& cell) {
    stack_ = field_.sources_near(frame_, cell);
    divide(cell, 0, stack_.size());
  }

 private:
  void divide(const Cell& cell, std::size_t first, std::size_t count) {
    if (!cell.meets(frame_)) return;
    kept_.clear();
    CellSpacing spacing;
    spacing.bound(field_, frame_, cell, stack_.data() + first, count, &kept_);
    if (cell.radius() <= kBaseRadius * spacing.centre) {
      list_.cells.push_back({frame_.face, Index(list_.sources.size()), Index(kept_.size()), cell});
      list_.sources.insert(list_.sources.end(), kept_.begin(), kept_.end());
      return;
    }
    const std::size_t own = stack_.size();
    stack_.insert(stack_.end(), kept_.begin(), kept_.end());
    const std::size_t own_count = kept_.size();
    for (const Cell& half : cell.split()) divide(half, own, own_count);
    stack_.resize(own);
  }

  const SpacingField& field_;
  const FaceFrame& frame_;
  CellList& list_;
  std::vector<Index> stack_, kept_;
};

// Squared distance in the face's plane to the closest and to the farthest point of a cell.
double squared_to_closest(const Vec2& p, const Cell& cell) {
  return (cell.low - p).cwiseMax(p - cell.high).cwiseMax(0.0).squaredNorm();
}
double squared_to_farthest(const Vec2& p, const Cell& cell) {
  return (p - cell.low).cwiseMax(cell.high - p).squaredNorm();
}

}  // namespace

std::vector<FaceCell> make_parts(const TriangleMesh& mesh, const SpacingField& field,
                                 const std::vector<Index>& faces) {
  std::vector<FaceCell> parts;
  for (const Index f : faces) {
    const FaceFrame frame(f, mesh.corners(f));
    if (!(frame.size.y() > 0)) continue;
    split_until(frame, {Vec2::Zero(), frame.size}, kPartRadius * field.most(f),
                [&](const Cell& cell) {
                  parts.push_back({f, 0, 0, cell});
                });
  }
  return parts;
}

void divide(const TriangleMesh& mesh, const SpacingField& field, const FaceCell& part,
            CellList& list) {
  const FaceFrame frame(part.face, mesh.corners(part.face));
  Divider(field, frame, list).divide(part.cell);
}

GapFilling::GapFilling(const DiskSet& disks, const ConnectedBall& ball)
    : disks_(&disks), ball_(ball), frame_(0, disks.mesh().corners(0)) {}

bool GapFilling::cover(const FaceCell& cell, const Index* sources, SplitMix& random,
                       DartBlock& block) {
  const Index face = cell.face;
  if (frame_.face != face) frame_ = FaceFrame(face, disks_->mesh().corners(face));
  random_ = &random;
  block_ = &block;
  near_.clear();
  sources_.assign(sources, sources + cell.sources);
  CellSpacing spacing;
  spacing.bound(disks_->field(), frame_, cell.cell, sources, cell.sources);
  const double radius = cell.cell.radius();
  const Vec3 centre = frame_.position(cell.cell.centre());
  const bool covered = disks_->visit(
      centre, spacing.low, spacing.high, spacing.high + radius, [&](const PointGrid::Entry& entry) {
        const double squared_spacing = entry.spacing * entry.spacing;
        const double reach = std::min(spacing.high, entry.spacing) + radius;
        if (!((entry.position - centre).squaredNorm() < reach * reach * (1 + 1e-6))) return false;
        const Vec3 d = entry.position - frame_.origin;
        const Vec2 foot(d.dot(frame_.x_axis), d.dot(frame_.y_axis));
        const double height =
            (d - foot.x() * frame_.x_axis - foot.y() * frame_.y_axis).squaredNorm();
        const bool joined = disks_->reaches(entry.number, entry.label, face);
        near_.push_back(
            {foot, height, squared_spacing, entry.position, entry.number, entry.label, joined});
        return joined && squared_to_farthest(foot, cell.cell) + height <
                             std::min(squared_spacing, spacing.low * spacing.low);
      });
  return covered || fill(cell.cell, {0, near_.size()}, {0, sources_.size()});
}

// The cell is done when a sample covers it, else a dart is tried and then its halves (cf. Gamito &
// Maddock 2009, Ebeida et al. 2012).
bool GapFilling::fill(const Cell& cell, const Range& near, const Range& sources) {
  if (!cell.meets(frame_)) return true;
  const std::size_t first = near_.size(), first_source = sources_.size();
  CellSpacing spacing;
  Range own_sources = sources;
  if (sources.first < sources.last) {
    kept_.clear();
    spacing.bound(disks_->field(), frame_, cell, sources_.data() + sources.first,
                  sources.last - sources.first, &kept_);
    sources_.insert(sources_.end(), kept_.begin(), kept_.end());
    own_sources = {first_source, sources_.size()};
  } else {
    spacing.centre = spacing.low = spacing.high = disks_->field().most(frame_.face);
  }
  const double squared_low = spacing.low * spacing.low;
  const double squared_high = spacing.high * spacing.high;

  bool covered = false, unjoined = false;
  for (std::size_t i = near.first; i < near.last && !covered; ++i) {
    const Near& sample = near_[i];
    // A little more, since rounding differs between the frame and space.
    if (!(squared_to_closest(sample.foot, cell) + sample.squared_height <
          std::min(sample.squared_spacing, squared_high) * (1 + 1e-6)))
      continue;
    covered = sample.joined && squared_to_farthest(sample.foot, cell) + sample.squared_height <
                                   std::min(sample.squared_spacing, squared_low);
    unjoined |= !sample.joined;
    near_.push_back(Near(sample));
  }
  if (!covered && unjoined) covered = settle_unjoined(cell, spacing, first);
  if (!covered) {
    const bool finest = cell.radius() <= kFinestRadius * spacing.centre;
    if (finest ? throw_last_dart(cell) : throw_dart(cell, own_sources, first)) return false;
    if (!finest) {
      const Range own{first, near_.size()};
      auto halves = cell.split();
      if (random_->next() & 1) std::swap(halves[0], halves[1]);
      for (const Cell& half : halves)
        if (!fill(half, own, own_sources)) return false;
    }
  }
  near_.resize(first);
  sources_.resize(first_source);
  return true;
}

// Looks from the cell at the samples whose balls do not reach its face: those that no point's ball
// reaches are dropped from near_, those that every point's ball reaches are joined.
// Returns whether one of them covers the cell.
bool GapFilling::settle_unjoined(const Cell& cell, const CellSpacing& spacing, std::size_t first) {
  // Each point's ball lies in the outer ball and holds the inner one.
  const Vec3 centre = frame_.position(cell.centre());
  const double radius = cell.radius();
  ball_.find(frame_.face, centre, spacing.high + radius);
  const auto lost = [&](const Near& near) { return !near.joined && !ball_.found(near.face); };
  near_.erase(std::remove_if(near_.begin() + std::ptrdiff_t(first), near_.end(), lost),
              near_.end());
  ball_.find(frame_.face, centre, std::max(spacing.low - radius, 0.0));
  for (std::size_t i = first; i < near_.size(); ++i) {
    if (near_[i].joined || !ball_.found(near_[i].face)) continue;
    near_[i].joined = true;
    if (squared_to_farthest(near_[i].foot, cell) + near_[i].squared_height <
        std::min(near_[i].squared_spacing, spacing.low * spacing.low))
      return true;
  }
  return false;
}

// Throws a dart anywhere into the cell, near which the samples near_[first, ...) are.
bool GapFilling::throw_dart(const Cell& cell, const Range& sources, std::size_t first) {
  const double u = random_->uniform(), v = random_->uniform();
  const Vec2 place = cell.low + Vec2(u, v).cwiseProduct(cell.high - cell.low);
  const SurfacePoint dart{frame_.face, frame_.barycentric(place)};
  if (dart.barycentric.minCoeff() < 0) return false;
  const Vec3 position = disks_->mesh().position(dart);
  double spacing = disks_->field().most(frame_.face);
  for (std::size_t i = sources.first; i < sources.last; ++i)
    spacing = std::min(spacing, disks_->field().limit(sources_[i], position));
  const auto close = [&](const Near& near) {
    return (near.position - position).squaredNorm() <
           std::min(near.squared_spacing, spacing * spacing);
  };
  bool unjoined = false;
  for (std::size_t i = first; i < near_.size(); ++i) {
    if (!close(near_[i])) continue;
    if (near_[i].joined) return false;
    unjoined = true;
  }
  ball_.find(dart.face, position, spacing);
  if (unjoined) {
    for (std::size_t i = first; i < near_.size(); ++i)
      if (close(near_[i]) && ball_.found(near_[i].face)) return false;
  }
  add_dart(dart, position, spacing);
  return true;
}

// Throws a dart at the point of the face that is closest to the centre of a cell of the finest
// size. This point may lie just outside the cell, where near_ is not complete.
bool GapFilling::throw_last_dart(const Cell& cell) {
  const auto corners = disks_->mesh().corners(frame_.face);
  const SurfacePoint dart{frame_.face,
                          closest_barycentric(corners, frame_.position(cell.centre()))};
  const Vec3 position = disks_->mesh().position(dart);
  const double spacing = disks_->field().at(frame_.face, position);
  if (disks_->room(dart, position, spacing, ball_, true) < spacing) return false;
  add_dart(dart, position, spacing);
  return true;
}

// \pre ball_ holds what the dart's ball reaches
void GapFilling::add_dart(const SurfacePoint& dart, const Vec3& position, double spacing) {
  block_->add(dart, position, spacing, random_->next(), ball_.result());
}

}  // namespace onmesh
