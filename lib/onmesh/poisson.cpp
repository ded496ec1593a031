#include "onmesh/poisson.h"

#include <CGAL/Random.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/point_generators_3.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <tuple>
#include <utility>

#include "onmesh/error.h"
#include "onmesh/face_frame.h"
#include "onmesh/point_grid.h"
#include "onmesh/projection.h"
#include "onmesh/surface_ball.h"
#include "onmesh/texel_map.h"

namespace onmesh {

namespace {

constexpr double kDensity = 0.6965;  // samples per spacing^2 in a maximal random set on a plane
constexpr double kMaxSamples = 1 << 28;
constexpr int kBatchesPerSample = 4;  // candidates come in batches of a quarter of the samples ...
constexpr int kBatches = 32;          // ... fewer leave more to the filling, which is less random

// Lengths in spacings. Larger cells than the base are split at once; a cell of the finest size that
// takes no dart counts as covered, which leaves gaps up to the tolerance.
constexpr double kBaseRadius = 0.8;
constexpr double kFinestRadius = 0.5e-3;
constexpr double kTolerance = 1e-3;
constexpr double kGridCell = 3.2;

constexpr double kQuantile = 0.02;  // share of texels that may be smaller than the disc
constexpr double kMaxPerTexel = 16;

// Random numbers with the same bits everywhere: splitmix64 (Steele, Lea & Flood 2014).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t next() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15U;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31);
  }
  double uniform() { return double(next() >> 11) * 0x1p-53; }

 private:
  std::uint64_t state_;
};

Vec3 position_on(const TriangleMesh& mesh, const SurfacePoint& p) {
  const auto t = mesh.corners(p.face);
  return p.barycentric[0] * t[0] + p.barycentric[1] * t[1] + p.barycentric[2] * t[2];
}

class Sampler {
 public:
  Sampler(const TriangleMesh& mesh, const PoissonOptions& options, const Progress& progress);
  std::vector<SurfacePoint> run();

 private:
  // A sample near a cell. Joined: every point of the cell that is within the spacing of the sample
  // conflicts with it; otherwise that depends on the point.
  struct Near {
    Vec2 foot;              // in the face's frame
    double squared_height;  // above it
    Index sample;
    bool joined;
  };
  // Samples near a cell: near_[first, last), and those added since, fresh_[fresh, ...).
  struct NearRange {
    std::size_t first, last, fresh;
  };

  void throw_candidates();
  void fill(const FaceFrame& frame, const Cell& cell);
  void fill(const FaceFrame& frame, const Cell& cell, const NearRange& parent);
  bool settle_unjoined(const FaceFrame& frame, const Cell& cell, std::size_t first);
  bool throw_dart(const FaceFrame& frame, const Cell& cell, bool finest, std::size_t first);
  bool throw_dart(const SurfacePoint& dart);
  void add(const SurfacePoint& sample, const Vec3& position);

  bool close(const Vec3& p, const Vec3& q) const {
    return (p - q).squaredNorm() < squared_spacing_;
  }
  // Whether the ball around the sample reaches the face.
  bool reaches(Index sample, Index face) const {
    if (samples_[sample].face == face) return true;
    const auto first = reach_.begin() + std::ptrdiff_t(reach_offsets_[sample]);
    const auto last = reach_.begin() + std::ptrdiff_t(reach_offsets_[sample + 1]);
    return std::binary_search(first, last, face);
  }
  Near make_near(const FaceFrame& frame, Index sample, bool joined) const {
    const Vec3 d = positions_[sample] - frame.origin;
    const Vec2 foot(d.dot(frame.x_axis), d.dot(frame.y_axis));
    const double height = (d - foot.x() * frame.x_axis - foot.y() * frame.y_axis).squaredNorm();
    return {foot, height, sample, joined};
  }
  bool meets(const Near& near, const Cell& cell) const {
    const Vec2 d = (cell.low - near.foot).cwiseMax(near.foot - cell.high).cwiseMax(0.0);
    // A little more, since rounding differs between the frame and space.
    return d.squaredNorm() + near.squared_height < squared_spacing_ * (1 + 1e-6);
  }
  bool covers(const Near& near, const Cell& cell) const {
    const Vec2 d = (near.foot - cell.low).cwiseMax(cell.high - near.foot);
    return near.joined && d.squaredNorm() + near.squared_height < squared_spacing_;
  }
  void report(double done) const {
    if (progress_) progress_("sample", done);
  }

  const TriangleMesh& mesh_;
  const Progress& progress_;
  const double spacing_, squared_spacing_;
  const std::uint64_t seed_;
  std::vector<Index> faces_;        // to sample
  std::vector<double> area_below_;  // area of faces_ up to and including each
  Vec3 origin_;
  double expected_ = 0;  // estimate of the number of samples
  Random random_;
  SurfaceBall ball_;
  PointGrid grid_;

  std::vector<SurfacePoint> samples_;
  std::vector<Vec3> positions_;
  std::vector<std::size_t> reach_offsets_{0};
  std::vector<Index> reach_;  // per sample, faces its ball reaches, sorted; none if only its own

  std::vector<Near> near_;   // stack of the filling
  std::vector<Near> fresh_;  // samples added by the filling since it gathered near_
  double filled_ = 0;        // area done
  std::size_t gathers_ = 0;
};

Sampler::Sampler(const TriangleMesh& mesh, const PoissonOptions& options, const Progress& progress)
    : mesh_(mesh),
      progress_(progress),
      spacing_(options.spacing),
      squared_spacing_(spacing_ * spacing_),
      seed_(Random(options.seed).next()),
      random_(seed_),
      ball_(mesh) {
  origin_ = Vec3::Constant(std::numeric_limits<double>::infinity());
  double area = 0, longest = 0;
  for (Index f = 0; f < Index(mesh.faces.size()); ++f) {
    if (!options.faces.empty() && !options.faces[f]) continue;
    const auto t = mesh.corners(f);
    const double face_area = 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).norm();
    if (!(face_area > 0)) continue;
    area += face_area;
    faces_.push_back(f);
    area_below_.push_back(area);
    for (std::size_t k = 0; k < 3; ++k) {
      longest = std::max(longest, (t[(k + 1) % 3] - t[k]).norm());
      origin_ = origin_.cwiseMin(t[k]);
    }
  }
  if (faces_.empty()) throw InputError("no face to sample has area");
  // However thin the surface beside an edge, a sample covers at most two spacings of its length.
  expected_ = std::max(kDensity * area / squared_spacing_, longest / (2 * spacing_));
  if (!(expected_ <= kMaxSamples)) {
    std::ostringstream message;
    message << "Poisson samples " << spacing_ << " apart would be about " << expected_
            << ", more than 2^28: choose a larger spacing";
    throw InputError(message.str());
  }
  grid_ = PointGrid(origin_, kGridCell * spacing_, std::size_t(expected_));
}

std::vector<SurfacePoint> Sampler::run() {
  throw_candidates();
  for (const Index f : faces_) {
    const FaceFrame frame(f, mesh_.corners(f));
    if (frame.size.y() > 0) fill(frame, {Vec2::Zero(), frame.size});
  }
  report(1);
  return std::move(samples_);
}

// Points uniform over the area, each kept unless it conflicts with one kept before.
void Sampler::throw_candidates() {
  using Point = CGAL::Simple_cartesian<double>::Point_3;
  // CGAL's mesh generators don't tell the face, and draw the point in it from a global generator.
  // So faces are picked here, and the triangle given to CGAL is that of barycentric coordinates.
  CGAL::Random random(unsigned(seed_ >> 32));
  CGAL::Random_points_in_triangle_3<Point> points(Point(1, 0, 0), Point(0, 1, 0), Point(0, 0, 1),
                                                  random);
  // Taken in batches sorted by place, which finds the samples near them in the cache.
  struct Candidate {
    std::array<Index, 3> place;
    Index number;
    bool operator<(const Candidate& c) const {
      return std::tie(place, number) < std::tie(c.place, c.number);
    }
  };
  std::vector<SurfacePoint> batch(std::size_t(std::ceil(expected_ / kBatchesPerSample)));
  std::vector<Candidate> order(batch.size());
  for (int i = 0; i < kBatches; ++i) {
    report(0.5 * i / kBatches);
    for (std::size_t j = 0; j < batch.size(); ++j, ++points) {
      const double target = random.get_double(0, area_below_.back());
      const auto face = std::upper_bound(area_below_.begin(), area_below_.end() - 1, target);
      batch[j] = {faces_[std::size_t(face - area_below_.begin())],
                  {points->x(), points->y(), points->z()}};
      const Vec3 place = (position_on(mesh_, batch[j]) - origin_) / (kGridCell * spacing_);
      order[j] = {{Index(place[0]), Index(place[1]), Index(place[2])}, Index(j)};
    }
    std::sort(order.begin(), order.end());
    for (const Candidate& c : order) throw_dart(batch[c.number]);
  }
}

// Makes the set maximal on the cell: gathers the samples near it once it is small enough.
void Sampler::fill(const FaceFrame& frame, const Cell& cell) {
  if (!cell.meets(frame)) return;
  const double radius = cell.radius();
  if (radius > kBaseRadius * spacing_) {
    for (const Cell& half : cell.split()) fill(frame, half);
    return;
  }
  filled_ += 0.5 * cell.area();
  if (++gathers_ % 65536 == 0) report(0.5 + 0.5 * std::min(filled_ / area_below_.back(), 1.0));
  near_.clear();
  fresh_.clear();
  const bool covered = grid_.visit(frame.position(cell.centre()), spacing_ + radius, [&](Index i) {
    Near near = make_near(frame, i, false);
    if (!meets(near, cell)) return false;
    near.joined = reaches(i, frame.face);
    near_.push_back(near);
    return covers(near, cell);
  });
  if (!covered) fill(frame, cell, {0, near_.size(), 0});
}

// The cell is done when a sample covers it, else gets a dart and is split (cf. Gamito & Maddock
// 2009, Ebeida et al. 2012).
void Sampler::fill(const FaceFrame& frame, const Cell& cell, const NearRange& parent) {
  const std::size_t first = near_.size();
  bool covered = false, unjoined = false;
  const auto consider = [&](const Near& near) {
    if (!meets(near, cell)) return;
    covered = covers(near, cell);
    unjoined |= !near.joined;
    near_.push_back(near);
  };
  for (std::size_t i = parent.first; i < parent.last && !covered; ++i) consider(Near(near_[i]));
  for (std::size_t i = parent.fresh; i < fresh_.size() && !covered; ++i) consider(fresh_[i]);
  covered = covered || !cell.meets(frame);
  if (!covered && unjoined) covered = settle_unjoined(frame, cell, first);

  if (!covered) {
    const bool finest = cell.radius() <= kFinestRadius * spacing_;
    if (throw_dart(frame, cell, finest, first)) {
      near_.push_back(fresh_.back());
      covered = covers(fresh_.back(), cell);
    }
    covered |= finest;  // up to the tolerance
  }
  if (!covered) {
    const NearRange range{first, near_.size(), fresh_.size()};
    for (const Cell& half : cell.split()) fill(frame, half, range);
  }
  near_.resize(first);
}

// Looks from the cell at the samples whose balls do not reach its face: those that no point's ball
// reaches are dropped from near_, those that every point's ball reaches are joined.
// Returns whether one of them covers the cell.
bool Sampler::settle_unjoined(const FaceFrame& frame, const Cell& cell, std::size_t first) {
  // Each point's ball lies in the outer ball and holds the inner one.
  const Vec3 centre = frame.position(cell.centre());
  const double radius = cell.radius();
  ball_.find(frame.face, centre, spacing_ + radius);
  const auto lost = [&](const Near& near) {
    return !near.joined && !ball_.found(samples_[near.sample].face);
  };
  near_.erase(std::remove_if(near_.begin() + std::ptrdiff_t(first), near_.end(), lost),
              near_.end());
  ball_.find(frame.face, centre, spacing_ - radius);
  for (std::size_t i = first; i < near_.size(); ++i) {
    if (near_[i].joined || !ball_.found(samples_[near_[i].sample].face)) continue;
    near_[i].joined = true;
    if (covers(near_[i], cell)) return true;
  }
  return false;
}

// Throws a dart into the cell, near which the samples near_[first, ...) are: anywhere in it, or if
// it is of the finest size, at the point inside the face that is closest to its centre.
bool Sampler::throw_dart(const FaceFrame& frame, const Cell& cell, bool finest, std::size_t first) {
  SurfacePoint dart{frame.face, Vec3::Zero()};
  const auto keep = [&] {  // as a near sample of the cell, on whose face it lies
    fresh_.push_back(make_near(frame, Index(samples_.size() - 1), true));
    return true;
  };
  if (finest) {
    // This point may lie just outside the cell, where near_ is not complete.
    const auto corners = mesh_.corners(frame.face);
    dart.barycentric = closest_barycentric(corners, frame.position(cell.centre()));
    return throw_dart(dart) && keep();
  }
  const double u = random_.uniform(), v = random_.uniform();
  const Vec2 place = cell.low + Vec2(u, v).cwiseProduct(cell.high - cell.low);
  dart.barycentric = frame.barycentric(place);
  if (dart.barycentric.minCoeff() < 0) return false;
  const Vec3 p = position_on(mesh_, dart);
  for (std::size_t i = first; i < near_.size(); ++i)
    if (near_[i].joined && close(positions_[near_[i].sample], p)) return false;
  ball_.find(dart.face, p, spacing_);
  for (std::size_t i = first; i < near_.size(); ++i)
    if (close(positions_[near_[i].sample], p) && ball_.found(samples_[near_[i].sample].face))
      return false;
  add(dart, p);
  return keep();
}

// Adds the dart unless it conflicts with a sample.
bool Sampler::throw_dart(const SurfacePoint& dart) {
  const Vec3 p = position_on(mesh_, dart);
  bool unjoined = false;
  const bool conflict = grid_.visit(p, spacing_, [&](Index i) {
    if (!close(positions_[i], p)) return false;
    if (reaches(i, dart.face)) return true;
    unjoined = true;
    return false;
  });
  if (conflict) return false;
  ball_.find(dart.face, p, spacing_);
  if (unjoined && grid_.visit(p, spacing_, [&](Index i) {
        return close(positions_[i], p) && ball_.found(samples_[i].face);
      }))
    return false;
  add(dart, p);
  return true;
}

// \pre ball_ holds what the sample's ball reaches
void Sampler::add(const SurfacePoint& sample, const Vec3& position) {
  const std::vector<Index>& reached = ball_.result();
  if (reached.size() > 1) {
    const auto old = std::ptrdiff_t(reach_.size());
    reach_.insert(reach_.end(), reached.begin(), reached.end());
    std::sort(reach_.begin() + old, reach_.end());
  }
  reach_offsets_.push_back(reach_.size());
  samples_.push_back(sample);
  positions_.push_back(position);
  grid_.insert(position);
}

}  // namespace

std::vector<SurfacePoint> poisson_samples(const TriangleMesh& mesh, const PoissonOptions& options,
                                          const Progress& progress) {
  const double squared = options.spacing * options.spacing;
  if (!(options.spacing > 0) || !(squared > 0) || !std::isfinite(squared))
    throw UsageError("the spacing of Poisson samples must be a positive number");
  return Sampler(mesh, options, progress).run();
}

double least_sample_distance(const TriangleMesh& mesh, const std::vector<SurfacePoint>& samples,
                             double spacing) {
  std::vector<Vec3> positions(samples.size());
  Vec3 origin = Vec3::Constant(std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    positions[i] = position_on(mesh, samples[i]);
    origin = origin.cwiseMin(positions[i]);
  }
  PointGrid grid(origin, kGridCell * spacing, samples.size());
  for (const Vec3& p : positions) grid.insert(p);
  SurfaceBall ball(mesh);
  double least = 4 * spacing * spacing;
  bool any = false;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    bool searched = false;  // the ball around this sample
    grid.visit(positions[i], std::sqrt(least), [&](Index j) {
      const double squared = (positions[i] - positions[j]).squaredNorm();
      if (j == i || squared > least) return false;
      if (squared < spacing * spacing) {
        if (!searched) ball.find(samples[i].face, positions[i], spacing);
        searched = true;
        if (!ball.found(samples[j].face)) return false;  // j's own turn comes, or came
      }
      least = squared;
      any = true;
      return false;
    });
  }
  return any ? std::sqrt(least) : std::numeric_limits<double>::infinity();
}

double default_poisson_spacing(const TriangleMesh& mesh, const TexelMap& map) {
  std::vector<std::pair<double, Index>> discs;  // radius of a face's texel disc, number of texels
  double area = 0, texels = 0;
  for (Index f = 0; f < Index(map.texel_area.size()); ++f) {
    if (!(map.texel_area[f] > 0)) continue;
    area += mesh.face_area(f);
    const Index claims = map.face_offsets[f + 1] - map.face_offsets[f];
    if (claims == 0) continue;
    const auto t = mesh.corners(f);
    const Eigen::Matrix3d& rates = map.to_barycentric(f);
    const Vec3 side_x = rates(0, 0) * t[0] + rates(1, 0) * t[1] + rates(2, 0) * t[2];
    const Vec3 side_y = rates(0, 1) * t[0] + rates(1, 1) * t[1] + rates(2, 1) * t[2];
    const double longer = std::max(side_x.norm(), side_y.norm());
    discs.emplace_back(0.5 * side_x.cross(side_y).norm() / longer, claims);
    texels += claims;
  }
  if (discs.empty()) throw InputError("no texel lies on the surface");
  std::sort(discs.begin(), discs.end());
  std::size_t i = 0;
  for (double smaller = discs[0].second; smaller <= kQuantile * texels; smaller += discs[i].second)
    ++i;
  // A sample is found up to the filling's tolerance beyond the spacing.
  const double radius = discs[i].first / (1 + kTolerance);
  return std::max(radius, std::sqrt(kDensity * area / (kMaxPerTexel * texels)));
}

}  // namespace onmesh
