#include "onmesh/poisson/poisson.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "onmesh/base/error.h"
#include "onmesh/poisson/candidates.h"
#include "onmesh/poisson/gap_filling.h"
#include "onmesh/poisson/spacing_field.h"
#include "onmesh/poisson/texel_coverage.h"

namespace onmesh {

namespace {

constexpr double kMaxSamples = 1 << 28;
constexpr std::uint64_t kCandidateTurns = 3;  // more of them leave less to the filling, which is
                                              // less random
constexpr double kCandidateShare = 0.25;      // of the time, for progress

// Work is done in these portions whatever the number of threads, since darts of one portion meet
// when all of them are thrown.
constexpr std::size_t kDartsAtOnce = 1 << 14;
constexpr std::size_t kBlock = 256;
constexpr double kCellsAtOnce = 1 << 15;  // cells in memory, about

/// body(i, block) for all i < count in parallel, with blocks of kBlock consecutive numbers each.
template <class Block, class Body>
std::vector<Block> in_blocks(std::size_t count, const Body& body) {
  std::vector<Block> blocks((count + kBlock - 1) / kBlock);
  oneapi::tbb::parallel_for(std::size_t(0), blocks.size(), [&](std::size_t b) {
    const std::size_t last = std::min(count, (b + 1) * kBlock);
    for (std::size_t i = b * kBlock; i < last; ++i) body(i, blocks[b]);
  });
  return blocks;
}

struct SampledFaces {
  std::vector<Index> faces;
  double longest_edge = 0;
  Vec3 origin = Vec3::Constant(std::numeric_limits<double>::infinity());  // lower bounds
};

SampledFaces choose_faces(const TriangleMesh& mesh, const std::vector<bool>& wanted) {
  SampledFaces chosen;
  for (Index f = 0; f < Index(mesh.faces.size()); ++f) {
    if (!wanted.empty() && !wanted[f]) continue;
    if (mesh.is_degenerate(f)) continue;
    chosen.faces.push_back(f);
    const auto t = mesh.corners(f);
    for (std::size_t k = 0; k < 3; ++k) {
      chosen.longest_edge = std::max(chosen.longest_edge, (t[(k + 1) % 3] - t[k]).norm());
      chosen.origin = chosen.origin.cwiseMin(t[k]);
    }
  }
  if (chosen.faces.empty()) throw InputError("no face to sample has area");
  return chosen;
}

std::size_t expect_samples(const TriangleMesh& mesh, const SpacingField& field,
                           const SampledFaces& chosen) {
  double expected = 0;
  for (const Index f : chosen.faces)
    expected += kPoissonDensity * mesh.face_area(f) / (field.most(f) * field.most(f));
  // However thin the surface beside an edge, a sample covers at most two spacings of its length.
  expected = std::max(expected, chosen.longest_edge / (2 * field.largest()));
  // Only now, since it takes the longer the more there are.
  if (field.graded() && expected <= kMaxSamples)
    expected = std::max(expected, field.expected_samples(mesh, chosen.faces));
  if (expected <= kMaxSamples) return std::size_t(expected);
  std::ostringstream message;
  message << "Poisson samples ";
  if (field.graded()) {
    message << "in every texel";
  } else {
    message << field.largest() << " apart";
  }
  message << " would be about " << expected << ", more than 2^28: choose a larger spacing";
  throw InputError(message.str());
}

class Sampler {
 public:
  Sampler(const TriangleMesh& mesh, const SpacingField& field, const PoissonOptions& options,
          const Progress& progress)
      : mesh_(mesh),
        field_(field),
        progress_(progress),
        seed_(SplitMix(options.seed).next()),
        chosen_(choose_faces(mesh, options.faces)),
        disks_(mesh, field, chosen_.origin, expect_samples(mesh, field, chosen_)),
        ball_(mesh) {}

  /// Makes the set maximal.
  void run() {
    throw_candidates();
    fill();
  }
  void hit(const TexelMap& map) { hit_all_texels(map, ball_, disks_); }
  DiskSet& finish() {
    report(1);
    return disks_;
  }

 private:
  void throw_candidates();
  void fill();
  CellList make_cells(const FaceCell* first, std::size_t count) const;
  void fill(const CellList& list, double share);
  double turn(const FaceCell& cell, std::uint64_t round) const;
  void report(double done) const {
    if (progress_) progress_("samples", done);
  }

  const TriangleMesh& mesh_;
  const SpacingField& field_;
  const Progress& progress_;
  const std::uint64_t seed_;
  const SampledFaces chosen_;
  DiskSet disks_;
  const ConnectedBall ball_;  // copied for each thread
  double filled_ = 0;         // share of the filling that is done
  std::uint64_t number_ = 0;  // of the next cell
};

// Points uniform over each face, each time as many as samples are expected on it.
void Sampler::throw_candidates() {
  const std::vector<CandidatePart> parts = candidate_parts(mesh_, field_, chosen_.faces);
  oneapi::tbb::enumerable_thread_specific<ConnectedBall> balls(ball_);
  std::size_t first = 0, last = 0;
  for (; first < parts.size(); first = last) {
    for (double count = 0; last < parts.size() && count < double(kDartsAtOnce); ++last)
      count += parts[last].count;
    for (std::uint64_t turn = 0; turn < kCandidateTurns; ++turn) {
      disks_.settle(in_blocks<DartBlock>(last - first, [&](std::size_t i, DartBlock& block) {
        SplitMix random(seed_ ^ turn, first + i);
        throw_candidates_at(parts[first + i], random, disks_, balls.local(), block);
      }));
    }
    report(kCandidateShare * double(last) / double(parts.size()));
  }
}

void Sampler::fill() {
  const std::vector<FaceCell> parts = make_parts(mesh_, field_, chosen_.faces);
  double total = 0;
  const auto weight = [&](const FaceCell& part) {
    return part.cell.area() / (field_.most(part.face) * field_.most(part.face)) + 1;
  };
  for (const FaceCell& part : parts) total += weight(part);
  std::size_t first = 0, last = 0;
  for (; first < parts.size(); first = last) {
    double cells = 0;
    for (; last < parts.size() && cells < kCellsAtOnce; ++last) cells += weight(parts[last]);
    fill(make_cells(&parts[first], last - first), cells / total);
    filled_ += cells / total;
  }
}

// Probability that it is a cell's turn. Where faces are much smaller than the spacing, only a few
// of their cells throw darts at first, since each dart looks at all faces around it.
double Sampler::turn(const FaceCell& cell, std::uint64_t round) const {
  constexpr std::uint64_t kAllTakePart = 20;
  const double spacing = field_.most(cell.face);
  const double share = 2 * cell.cell.area() / (spacing * spacing);
  return round < kAllTakePart ? std::ldexp(share, 2 * int(round)) : 1;
}

CellList Sampler::make_cells(const FaceCell* first, std::size_t count) const {
  CellList all;
  const auto lists = in_blocks<CellList>(
      count, [&](std::size_t i, CellList& list) { divide(mesh_, field_, first[i], list); });
  for (const CellList& list : lists) {
    for (FaceCell cell : list.cells) {
      cell.first_source += Index(all.sources.size());
      all.cells.push_back(cell);
    }
    all.sources.insert(all.sources.end(), list.sources.begin(), list.sources.end());
  }
  return all;
}

// Makes the set maximal on the cells, round by round: every cell whose turn it is and that is not
// covered throws a dart.
void Sampler::fill(const CellList& list, double share) {
  oneapi::tbb::enumerable_thread_specific<GapFilling> fillings(GapFilling(disks_, ball_));
  std::vector<Index> open(list.cells.size()), still_open;
  for (Index i = 0; i < Index(open.size()); ++i) open[i] = i;
  std::vector<std::uint8_t> covered(list.cells.size(), 0);
  for (std::uint64_t round = 0; !open.empty(); ++round) {
    still_open.clear();
    for (std::size_t first = 0; first < open.size(); first += kDartsAtOnce) {
      const std::size_t last = std::min(open.size(), first + kDartsAtOnce);
      disks_.settle(in_blocks<DartBlock>(last - first, [&](std::size_t i, DartBlock& block) {
        const Index at = open[first + i];
        const FaceCell& cell = list.cells[at];
        SplitMix random(seed_ + 1 + round, number_ + at);
        if (random.uniform() > turn(cell, round)) return;
        covered[at] =
            fillings.local().cover(cell, list.sources.data() + cell.first_source, random, block);
      }));
      for (std::size_t i = first; i < last; ++i)
        if (!covered[open[i]]) still_open.push_back(open[i]);
      const std::size_t left = still_open.size() + open.size() - last;
      const double done = filled_ + share * (1 - double(left) / double(list.cells.size()));
      report(kCandidateShare + (1 - kCandidateShare) * std::min(done, 1.0));
    }
    open.swap(still_open);
  }
  number_ += list.cells.size();
}

}  // namespace

std::vector<SurfacePoint> poisson_samples(const TriangleMesh& mesh, const PoissonOptions& options,
                                          const Progress& progress) {
  const double squared = options.spacing * options.spacing;
  if (!(options.spacing > 0) || !(squared > 0) || !std::isfinite(squared))
    throw UsageError("the spacing of Poisson samples must be a positive number");
  const SpacingField field(options.spacing);
  Sampler sampler(mesh, field, options, progress);
  sampler.run();
  return sampler.finish().take_samples();
}

GradedSamples texel_poisson_samples(const TriangleMesh& mesh, const TexelMap& map,
                                    const PoissonOptions& options, const Progress& progress) {
  const SpacingField field(mesh, map);
  Sampler sampler(mesh, field, options, progress);
  sampler.run();
  sampler.hit(map);
  DiskSet& disks = sampler.finish();
  return {disks.take_samples(), disks.take_spacings()};
}

double least_sample_distance(const TriangleMesh& mesh, const GradedSamples& samples) {
  const std::size_t count = samples.points.size();
  std::vector<Vec3> positions(count);
  Vec3 origin = Vec3::Constant(std::numeric_limits<double>::infinity());
  double unit = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < count; ++i) {
    positions[i] = mesh.position(samples.points[i]);
    origin = origin.cwiseMin(positions[i]);
    if (samples.spacings[i] > 0) unit = std::min(unit, samples.spacings[i]);
  }
  PointGrid grid(origin, unit, unit, 1, count);
  for (std::size_t i = 0; i < count; ++i)
    grid.insert(Index(i), samples.points[i].face, positions[i], samples.spacings[i]);
  // All samples are looked at from both sides, so a pair is seen if the surface joins it in either
  // one's ball.
  oneapi::tbb::enumerable_thread_specific<ConnectedBall> balls(ConnectedBall{mesh});
  const double none = 4 * unit * unit;
  const auto range = oneapi::tbb::blocked_range<std::size_t>(0, count, 1024);
  const double least = oneapi::tbb::parallel_reduce(
      range, none,
      [&](const auto& part, double shortest) {
        ConnectedBall& ball = balls.local();
        for (std::size_t i = part.begin(); i < part.end(); ++i) {
          bool searched = false;  // the ball around this sample
          const double own = samples.spacings[i];
          grid.visit(positions[i], unit, unit, std::sqrt(shortest), [&](const auto& entry) {
            const double squared = (positions[i] - entry.position).squaredNorm();
            if (entry.number == i || !(squared < shortest)) return false;
            const double limit = std::min(own, entry.spacing);
            if (squared < limit * limit) {
              if (!searched) ball.find(samples.points[i].face, positions[i], own);
              searched = true;
              if (!ball.found(entry.label)) return false;
            }
            shortest = squared;
            return false;
          });
        }
        return shortest;
      },
      [](double a, double b) { return std::min(a, b); });
  return least < none ? std::sqrt(least) : std::numeric_limits<double>::infinity();
}

double least_sample_distance(const TriangleMesh& mesh, const std::vector<SurfacePoint>& samples,
                             double spacing) {
  return least_sample_distance(mesh, {samples, std::vector<double>(samples.size(), spacing)});
}

}  // namespace onmesh
