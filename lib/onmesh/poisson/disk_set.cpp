#include "onmesh/poisson/disk_set.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <atomic>

namespace onmesh {

namespace {

// Rounding must not hide points from each other whose spacings differ by just that factor.
double factor(const SpacingField& field) {
  return field.graded() ? (1 + field.slope()) * (1 + 1e-9) : 1;
}

// Which of many darts are added: greedily by rank, as if one by one, though in parallel (Blelloch,
// Fineman and Shun, "Greedy sequential maximal independent set and matching are parallel on
// average", 2012; random ranks for darts on surfaces: Ying, Xin, Sun and He, "An intrinsic
// algorithm for parallel Poisson disk sampling on arbitrary surfaces", 2013).
class Settlement {
 public:
  Settlement(const std::vector<DartBlock>& blocks, const Vec3& origin, const SpacingField& field) {
    for (const DartBlock& block : blocks)
      for (const Dart& dart : block.darts) darts_.push_back({&dart, block.reach.data(), 0, 0});
    grid_ = PointGrid(origin, field.least(), field.largest(), factor(field), darts_.size());
    for (Index i = 0; i < Index(darts_.size()); ++i)
      grid_.insert(i, dart(i).point.face, dart(i).position, dart(i).spacing);
    states_.assign(darts_.size(), kOpen);
    rivals_.resize((darts_.size() + kBlock - 1) / kBlock);
  }

  // A dart is in when all its rivals (darts before it that it conflicts with) are out, and out when
  // one is in. Nothing is decided before that is known, so it does not matter which thread is
  // first.
  void run() {
    oneapi::tbb::parallel_for(std::size_t(0), rivals_.size(), [&](std::size_t block) {
      const std::size_t last = std::min(darts_.size(), (block + 1) * kBlock);
      for (std::size_t i = block * kBlock; i < last; ++i) {
        darts_[i].first_rival = Index(rivals_[block].size());
        find_rivals(Index(i), rivals_[block]);
        darts_[i].rivals = Index(rivals_[block].size()) - darts_[i].first_rival;
      }
    });
    std::vector<Index> open(darts_.size());
    for (Index i = 0; i < Index(open.size()); ++i) open[i] = i;
    while (!open.empty()) {
      oneapi::tbb::parallel_for(oneapi::tbb::blocked_range<std::size_t>(0, open.size(), 1024),
                                [&](const auto& range) {
                                  for (auto i = range.begin(); i < range.end(); ++i)
                                    decide(open[i]);
                                });
      open.erase(std::remove_if(open.begin(), open.end(), [&](Index i) { return states_[i]; }),
                 open.end());
    }
  }

  template <class Visit>
  void visit_added(const Visit& visit) const {
    for (std::size_t i = 0; i < darts_.size(); ++i)
      if (states_[i] == kIn) visit(*darts_[i].dart, darts_[i].reach);
  }

 private:
  struct Entry {
    const Dart* dart;
    const Index* reach;  // of its block
    Index first_rival = 0, rivals = 0;
  };
  static constexpr std::size_t kBlock = 256;
  static constexpr std::uint8_t kOpen = 0, kIn = 1, kOut = 2;

  const Dart& dart(Index i) const { return *darts_[i].dart; }
  bool reaches(Index i, Index face) const {
    const Index* const first = darts_[i].reach + dart(i).first_reach;
    return std::binary_search(first, first + dart(i).reach, face);
  }
  void find_rivals(Index i, std::vector<Index>& rivals) const {
    const Dart& own = dart(i);
    grid_.visit(own.position, own.spacing, own.spacing, own.spacing, [&](const auto& entry) {
      const double limit = std::min(own.spacing, entry.spacing);
      if (!((entry.position - own.position).squaredNorm() < limit * limit)) return false;
      const Index j = entry.number;
      const Dart& other = dart(j);
      if (own.rank != other.rank ? own.rank < other.rank : i <= j) return false;
      if (own.point.face == other.point.face || reaches(i, other.point.face) ||
          reaches(j, own.point.face))
        rivals.push_back(j);
      return false;
    });
  }
  void decide(Index i) {
    const Index* const rivals = rivals_[i / kBlock].data() + darts_[i].first_rival;
    std::uint8_t state = kIn;
    for (Index k = 0; k < darts_[i].rivals && state != kOut; ++k) {
      switch (std::atomic_ref<std::uint8_t>(states_[rivals[k]]).load(std::memory_order_relaxed)) {
        case kIn:
          state = kOut;
          break;
        case kOpen:
          state = kOpen;
          break;
        default:
          break;
      }
    }
    std::atomic_ref<std::uint8_t>(states_[i]).store(state, std::memory_order_relaxed);
  }

  std::vector<Entry> darts_;
  PointGrid grid_;
  std::vector<std::uint8_t> states_;
  std::vector<std::vector<Index>> rivals_;  // by blocks of darts
};

}  // namespace

void DartBlock::add(const SurfacePoint& point, const Vec3& position, double spacing,
                    std::uint64_t rank, const std::vector<Index>& reached) {
  Dart dart{point, position, spacing, rank, Index(reach.size()), 0};
  if (reached.size() > 1) {
    dart.reach = Index(reached.size());
    reach.insert(reach.end(), reached.begin(), reached.end());
    std::sort(reach.begin() + dart.first_reach, reach.end());
  }
  darts.push_back(dart);
}

DiskSet::DiskSet(const TriangleMesh& mesh, const SpacingField& field, const Vec3& origin,
                 std::size_t expected_samples)
    : mesh_(mesh),
      field_(field),
      origin_(origin),
      grid_(origin, field.least(), field.largest(), factor(field), expected_samples) {}

bool DiskSet::reaches(Index sample, Index own, Index face) const {
  if (own == face) return true;
  const auto first = reach_.begin() + std::ptrdiff_t(reach_offsets_[sample]);
  const auto last = reach_.begin() + std::ptrdiff_t(reach_offsets_[sample + 1]);
  return std::binary_search(first, last, face);
}

double DiskSet::room(const SurfacePoint& point, const Vec3& position, double spacing,
                     ConnectedBall& ball, bool any, Index skip) const {
  double nearest = spacing * spacing;
  bool unjoined = false;
  const auto squared_distance = [&](const PointGrid::Entry& entry) {
    const double squared = (entry.position - position).squaredNorm();
    return squared < entry.spacing * entry.spacing && entry.number != skip ? squared : nearest;
  };
  if (grid_.visit(position, spacing, spacing, spacing, [&](const PointGrid::Entry& entry) {
        const double squared = squared_distance(entry);
        if (!(squared < nearest)) return false;
        if (!reaches(entry.number, entry.label, point.face)) {
          unjoined = true;
          return false;
        }
        nearest = squared;
        return any;
      }))
    return std::sqrt(nearest);
  ball.find(point.face, position, spacing);
  if (unjoined) {
    grid_.visit(position, spacing, spacing, spacing, [&](const PointGrid::Entry& entry) {
      const double squared = squared_distance(entry);
      if (!(squared < nearest) || !ball.found(entry.label)) return false;
      nearest = squared;
      return any;
    });
  }
  return nearest < spacing * spacing ? std::sqrt(nearest) : spacing;
}

void DiskSet::settle(const std::vector<DartBlock>& blocks) {
  Settlement settlement(blocks, origin_, field_);
  settlement.run();
  settlement.visit_added([&](const Dart& dart, const Index* reach) { add(dart, reach); });
}

void DiskSet::append(const DartBlock& block) {
  for (const Dart& dart : block.darts) add(dart, block.reach.data());
}

void DiskSet::add(const Dart& dart, const Index* reach) {
  reach_.insert(reach_.end(), reach + dart.first_reach, reach + dart.first_reach + dart.reach);
  reach_offsets_.push_back(reach_.size());
  grid_.insert(Index(samples_.size()), dart.point.face, dart.position, dart.spacing);
  samples_.push_back(dart.point);
  spacings_.push_back(dart.spacing);
}

}  // namespace onmesh
