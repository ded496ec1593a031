#include "onmesh/kernel/direct/direct_kernel.h"

#include <hwy/aligned_allocator.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "onmesh/kernel/direct/records.h"

// This file is compiled once per instruction set (Highway); the best one is chosen at run time.
// Vectors live in arrays here, which vectors of unknown size cannot.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "onmesh/kernel/direct/direct_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "onmesh/kernel/direct/sums-inl.h"

HWY_BEFORE_NAMESPACE();
namespace onmesh {
namespace HWY_NAMESPACE {
namespace {

/// Exponent of lanes that must not count: far beyond any radius, but no infinity arithmetic.
constexpr float kNever = -1e30F;

/// The faces near some consecutive targets, with their corners renumbered. Which faces can hold a
/// sample within the radius is decided once for several vectors of targets: a patch may be large.
class Neighbourhood {
 public:
  struct Face {
    std::array<Index, 3> corners;  ///< into nodes
    float slack;
    std::size_t begin, end;  ///< records
    Index number;            ///< in KernelWork::faces
  };
  std::vector<Index> nodes;  ///< local nodes of the patch
  std::vector<Face> faces;
  /// The faces' corners and slacks once more, padded by a vector.
  std::array<std::vector<std::int32_t>, 3> corners;
  std::vector<float> slacks;
  std::size_t samples = 0;  ///< in all faces

  Neighbourhood(const KernelInput& input, const KernelWork& work)
      : table_(*input.table),
        work_(work),
        nearest_(table_.columns),
        index_(table_.columns),
        is_listed_(table_.columns) {}

  void find(std::size_t first, std::size_t count) {
    corners_.clear();
    for (std::size_t k = first; k < first + count; ++k) {
      for (const Index corner : work_.targets[k].corners) {
        if (std::exchange(is_listed_[corner], 1) == 0) corners_.push_back(corner);
      }
    }
    for (const Index corner : corners_) is_listed_[corner] = 0;
    std::fill(nearest_.begin(), nearest_.end(), kUnreachable);
    for (const Index corner : corners_) {
      const float* const row = table_.row(corner);
      float* const nearest = nearest_.data();
      const std::size_t columns = nearest_.size();
      for (std::size_t n = 0; n < columns; ++n) {
        nearest[n] = row[n] < nearest[n] ? row[n] : nearest[n];
      }
    }
    nodes.clear();
    faces.clear();
    samples = 0;
    for (auto& corner : corners) corner.clear();
    slacks.clear();
    std::fill(index_.begin(), index_.end(), kNone);
    for (Index f = 0; f < work_.faces.size(); ++f) {
      const KernelWork::Face& face = work_.faces[f];
      const auto& n = face.corners;
      const float farthest = std::max({nearest_[n[0]], nearest_[n[1]], nearest_[n[2]]});
      if (farthest > face.reach_squared) continue;
      Face& near = faces.emplace_back(Face{{}, face.slack, face.begin, face.end, f});
      for (int i = 0; i < 3; ++i) {
        if (index_[n[i]] == kNone) {
          index_[n[i]] = Index(nodes.size());
          nodes.push_back(n[i]);
        }
        near.corners[i] = index_[n[i]];
        corners[i].push_back(std::int32_t(index_[n[i]]));
      }
      slacks.push_back(face.slack);
      samples += face.end - face.begin;
    }
    for (auto& corner : corners) corner.resize(faces.size() + hn::Lanes(D()), 0);
    slacks.resize(faces.size() + hn::Lanes(D()), 0);
  }

 private:
  const DistanceTable& table_;
  const KernelWork& work_;
  std::vector<Index> corners_;
  std::vector<float> nearest_;  ///< smallest squared distance of a node to the targets' corners
  std::vector<Index> index_;
  std::vector<unsigned char> is_listed_;  ///< in corners_
};

/// As many targets as a vector has lanes, with everything that is the same for all samples.
class Block {
 public:
  Block(const KernelInput& input, const KernelWork& work, const Neighbourhood& near)
      : table_(*input.table),
        work_(work),
        near_(near),
        lanes_(hn::Lanes(d_)),
        channels_(std::size_t(work.channels)),
        barycentric_(hwy::AllocateAligned<float>(3 * lanes_ * lanes_)),
        exponents_(hwy::AllocateAligned<float>(table_.columns * lanes_)),
        own_(hwy::AllocateAligned<float>(channels_ * lanes_)),
        sums_(hwy::AllocateAligned<float>((channels_ + 1) * lanes_)),
        most_(table_.columns),
        least_(table_.columns),
        corner_exponents_(hwy::AllocateAligned<float>((work.faces.size() + 1) * 3 * lanes_)),
        unreachable_(table_.columns) {}

  /// Sum over all samples in the neighbourhood for the targets from `first` on.
  /// \return number of pairs within the radius
  template <int kChannels, RangeTerm kRange>
  std::uint64_t run(std::size_t first) {
    load(first);
    compute_exponents();
    Sums<kChannels, kRange> sums;
    if constexpr (kChannels > 0) {
      sums.clear(d_, own_.get());
    } else {
      sums = {&work_, own_.get(), sums_.get()};
    }
    find_hits();
    std::uint64_t pairs = 0;
    const float* const records = work_.records.data();
    const float* const corner_exponents = corner_exponents_.get();
    const auto exponents_of = [&](const float* record) HWY_ATTR {
      const float* const at =
          corner_exponents + std::size_t(std::bit_cast<Index>(record[4])) * 3 * hn::Lanes(D());
      return FaceExponents<V>{hn::Load(d_, at), hn::Load(d_, at + hn::Lanes(D())),
                              hn::Load(d_, at + 2 * hn::Lanes(D()))};
    };
    for (std::size_t k = 0; k < hits_.sure.count; ++k) {
      const float* const record = records + hits_.sure.records[k];
      sums.add_sure(d_, exponents_of(record), record);
    }
    for (std::size_t k = 0; k < hits_.edge.count; ++k) {
      const float* const record = records + hits_.edge.records[k];
      pairs += sums.add_edge(d_, exponents_of(record), record);
    }
    const V limit = hn::Set(d_, work_.limit);
    for (std::size_t k = 0; k < hits_.general.count; ++k) {
      const float* const record = records + hits_.general.records[k];
      pairs += sums.add(d_, limit, exponents_of(record), record);
    }
    pairs += hits_.sure.count * lanes_;
    if constexpr (kChannels > 0) sums.store(d_, sums_.get());
    return pairs;
  }

  /// Divide the sums by the weights. \return number of targets that kept their values
  std::uint64_t store(const Colours& colours, std::vector<float>& out) const {
    std::uint64_t kept = 0;
    const bool differences = work_.range_term == RangeTerm::difference;
    for (std::size_t lane = 0; lane < used_; ++lane) {
      const KernelWork::Target& target = targets_[lane];
      const float* const own =
          colours.values + std::size_t(target.texel) * std::size_t(colours.stride);
      float* const result = out.data() + std::size_t(target.slot) * channels_;
      const double weight = sums_[lane];
      const bool nothing = !(weight > kNothing);
      for (std::size_t c = 0; c < channels_; ++c) {
        const double mean = sums_[(c + 1) * lanes_ + lane] / (weight * work_.colour_scale);
        const double value = (differences ? own[c] : work_.reference[c]) + mean;
        result[c] = nothing ? own[c] : static_cast<float>(value);
      }
      kept += nothing;
    }
    return kept;
  }

 private:
  /// Lists the samples that targets may have within the radius, over all faces, so that they can be
  /// summed in long loops: short ones cost more in mispredicted branches than in sums.
  void find_hits() {
    const float limit = loose_limit(work_), sure_limit = tight_limit(work_);
    list_near_faces(limit);
    hits_.clear(near_.samples + lanes_);
    for (std::size_t i = 0; i < near_face_count_; ++i) {
      const Neighbourhood::Face& face = near_.faces[near_faces_[i]];
      const auto& n = face.corners;
      V e0 = hn::Load(d_, exponents_.get() + n[0] * lanes_);
      V e1 = hn::Load(d_, exponents_.get() + n[1] * lanes_);
      V e2 = hn::Load(d_, exponents_.get() + n[2] * lanes_);
      FaceExponents<float> most{most_[n[0]], most_[n[1]], most_[n[2]]};
      FaceExponents<float> least{least_[n[0]], least_[n[1]], least_[n[2]]};
      if (unreachable_[n[0]] | unreachable_[n[1]] | unreachable_[n[2]]) {
        const M apart = unreachable_lanes(face);
        if (hn::AllTrue(d_, apart)) continue;
        const V never = hn::Set(d_, kNever);
        e0 = hn::IfThenElse(apart, never, e0);
        e1 = hn::IfThenElse(apart, never, e1);
        e2 = hn::IfThenElse(apart, never, e2);
        most = {largest_lane(e0), largest_lane(e1), largest_lane(e2)};
        least = {kNever, kNever, kNever};
      }
      float* const at = corner_exponents_.get() + face.number * 3 * lanes_;
      hn::Store(e0, d_, at);
      hn::Store(hn::Sub(e1, e0), d_, at + lanes_);
      hn::Store(hn::Sub(e2, e0), d_, at + 2 * lanes_);
      // Variances only add to the exponents inside the face.
      if (std::min({least.corner0, least.to_corner1, least.to_corner2}) >= sure_limit &&
          std::max({most.corner0, most.to_corner1, most.to_corner2}) + face.slack <= 0) {
        add_hits(d_, work_, face.begin, face.end, hits_.sure);
        continue;
      }
      for (FaceExponents<float>* x : {&most, &least}) {
        x->to_corner1 -= x->corner0;
        x->to_corner2 -= x->corner0;
      }
      HWY_NAMESPACE::find_hits(d_, work_, face.begin, face.end, most, least, hits_);
    }
  }

  /// List the faces that may have samples beyond the limit; lanes are faces.
  void list_near_faces(float limit) {
    const hn::RebindToSigned<D> di;
    const std::size_t faces = near_.faces.size();
    if (near_faces_.size() < faces + lanes_) near_faces_.resize(2 * (faces + lanes_));
    near_face_count_ = 0;
    auto number = hn::Iota(di, 0);
    for (std::size_t f = 0; f < faces; f += lanes_) {
      const auto most_at = [&](int corner) HWY_ATTR {
        return hn::GatherIndex(d_, most_.data(), hn::LoadU(di, near_.corners[corner].data() + f));
      };
      // d^2 at a sample is at least the smallest of the corners' less the sample's variance.
      const V most = hn::Max(most_at(0), hn::Max(most_at(1), most_at(2)));
      const M is_near =
          hn::And(hn::Ge(hn::Add(most, hn::LoadU(d_, near_.slacks.data() + f)), hn::Set(d_, limit)),
                  hn::FirstN(d_, faces - f));
      hn::StoreU(hn::Compress(number, hn::RebindMask(di, is_near)), di,
                 near_faces_.data() + near_face_count_);
      near_face_count_ += hn::CountTrue(d_, is_near);
      number = hn::Add(number, hn::Set(di, std::int32_t(lanes_)));
    }
  }

  float largest_lane(V x) const { return hn::GetLane(hn::MaxOfLanes(d_, x)); }

  /// Take over targets first, first + 1, ... and list the nodes around them: barycentric_ holds,
  /// for every node of corners_, its scaled barycentric coordinate in each lane's target (0 where
  /// it is no corner).
  void load(std::size_t first) {
    used_ = std::min(lanes_, work_.targets.size() - first);
    targets_ = work_.targets.data() + first;
    corners_.clear();
    std::fill_n(barycentric_.get(), 3 * lanes_ * lanes_, 0.0F);
    std::fill_n(own_.get(), channels_ * lanes_, 0.0F);
    std::fill_n(sums_.get(), (channels_ + 1) * lanes_, 0.0F);
    std::fill_n(variance_, lanes_, kNever);
    for (std::size_t lane = 0; lane < used_; ++lane) {
      variance_[lane] = targets_[lane].variance;
      for (int i = 0; i < 3; ++i) {
        const auto at = std::find(corners_.begin(), corners_.end(), targets_[lane].corners[i]);
        const auto corner = std::size_t(at - corners_.begin());
        if (at == corners_.end()) corners_.push_back(targets_[lane].corners[i]);
        barycentric_[corner * lanes_ + lane] +=
            targets_[lane].barycentric[i] * work_.distance_scale;
      }
      for (std::size_t c = 0; c < channels_; ++c) {
        own_[c * lanes_ + lane] = work_.target_colours[(first + lane) * channels_ + c];
      }
    }
  }

  /// Exponents of all targets at all nodes around: sum_i a_i D_ij - V(x), scaled.
  void compute_exponents() {
    const std::size_t count = corners_.size();
    rows_.resize(count);
    for (std::size_t i = 0; i < count; ++i) rows_[i] = table_.row(corners_[i]);
    const V variance = hn::Load(d_, variance_);
    for (std::size_t k = 0; k < near_.nodes.size(); ++k) {
      const Index n = near_.nodes[k];
      V e = variance;
      float largest = 0;
      for (std::size_t i = 0; i < count; ++i) {
        const float squared = rows_[i][n];
        largest = std::max(largest, squared);
        e = hn::MulAdd(hn::Load(d_, barycentric_.get() + i * lanes_), hn::Set(d_, squared), e);
      }
      hn::Store(e, d_, exponents_.get() + k * lanes_);
      most_[k] = largest_lane(e);
      least_[k] = hn::GetLane(hn::MinOfLanes(d_, e));
      unreachable_[k] = largest >= kUnreachable;
    }
  }

  /// Lanes whose face has a corner from which a corner of `face` is unreachable, and unused lanes.
  M unreachable_lanes(const Neighbourhood::Face& face) {
    std::fill_n(apart_, lanes_, 1.0F);
    for (std::size_t lane = 0; lane < used_; ++lane) {
      if (lane > 0 && targets_[lane].face == targets_[lane - 1].face) {
        apart_[lane] = apart_[lane - 1];
        continue;
      }
      bool apart = false;
      for (const Index corner : targets_[lane].corners) {
        for (const Index n : face.corners) {
          apart = apart || table_.row(corner)[near_.nodes[n]] >= kUnreachable;
        }
      }
      apart_[lane] = apart ? 1.0F : 0.0F;
    }
    return hn::Gt(hn::Load(d_, apart_), hn::Zero(d_));
  }

  const D d_{};
  const DistanceTable& table_;
  const KernelWork& work_;
  const Neighbourhood& near_;
  const std::size_t lanes_, channels_;
  std::size_t used_ = 0;
  const KernelWork::Target* targets_ = nullptr;
  std::vector<Index> corners_;
  std::vector<const float*> rows_;
  hwy::AlignedFreeUniquePtr<float[]> barycentric_, exponents_, own_, sums_;
  std::vector<float> most_, least_;  ///< by node: the largest and smallest exponent of any target
  std::vector<std::int32_t> near_faces_;
  std::size_t near_face_count_ = 0;
  /// Per face: the targets' exponents at corner 0, and the differences to it at the others.
  hwy::AlignedFreeUniquePtr<float[]> corner_exponents_;
  Hits hits_;
  std::vector<std::uint8_t> unreachable_;  ///< by node: some target may not reach it
  HWY_ALIGN float variance_[hn::MaxLanes(D())] = {};
  HWY_ALIGN float apart_[hn::MaxLanes(D()) + 1] = {};
};

/// Vectors of targets that share a neighbourhood.
constexpr std::size_t kBlocksTogether = 16;

template <int kChannels, RangeTerm kRange>
KernelCounts run_blocks(const KernelInput& input, const KernelWork& work, std::vector<float>& out) {
  KernelCounts counts;
  Neighbourhood near(input, work);
  Block block(input, work, near);
  const std::size_t lanes = hn::Lanes(D()), targets = work.targets.size();
  for (std::size_t begin = 0; begin < targets; begin += kBlocksTogether * lanes) {
    const std::size_t end = std::min(begin + kBlocksTogether * lanes, targets);
    near.find(begin, end - begin);
    for (std::size_t first = begin; first < end; first += lanes) {
      counts.pairs += block.run<kChannels, kRange>(first);
      counts.without_sample += block.store(input.colours, out);
    }
  }
  return counts;
}

template <int kChannels>
KernelCounts run_term(const KernelInput& input, const KernelWork& work, std::vector<float>& out) {
  switch (work.range_term) {
    case RangeTerm::none:
      return run_blocks<kChannels, RangeTerm::none>(input, work, out);
    case RangeTerm::product:
      return run_blocks<kChannels, RangeTerm::product>(input, work, out);
    default:
      return run_blocks<kChannels, RangeTerm::difference>(input, work, out);
  }
}

KernelCounts run_patch(const KernelInput& input, const KernelWork& work, std::vector<float>& out) {
  if (work.range_channels == 0 || work.range_channels == work.channels) {
    switch (work.channels) {
      case 1:
        return run_term<1>(input, work, out);
      case 2:
        return run_term<2>(input, work, out);
      case 3:
        return run_term<3>(input, work, out);
      case 4:
        return run_term<4>(input, work, out);
      default:
        break;
    }
  }
  return run_blocks<0, RangeTerm::difference>(input, work, out);
}

const char* target_name() { return hwy::TargetName(HWY_TARGET); }

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace onmesh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace onmesh {
HWY_EXPORT(run_patch);
HWY_EXPORT(target_name);

DirectKernel::DirectKernel(const KernelOptions& options)
    : options_(options), work_(std::make_unique<KernelWork>()) {}
DirectKernel::~DirectKernel() = default;
DirectKernel::DirectKernel(DirectKernel&&) noexcept = default;

KernelCounts DirectKernel::run(const KernelInput& input, std::vector<float>& out) {
  gather(input, options_, *work_, out);
  KernelCounts counts;
  if (!work_->targets.empty()) counts = HWY_DYNAMIC_DISPATCH(run_patch)(input, *work_, out);
  counts.without_sample += work_->kept;
  return counts;
}

KernelCounts filter_patch(const KernelInput& input, const KernelOptions& options,
                          std::vector<float>& out) {
  return DirectKernel(options).run(input, out);
}

const char* kernel_target() { return HWY_DYNAMIC_DISPATCH(target_name)(); }

}  // namespace onmesh
#endif
