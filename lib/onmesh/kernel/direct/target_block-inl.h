// A vector of targets and their sums, compiled once per instruction set.
#if defined(ONMESH_KERNEL_TARGET_BLOCK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ONMESH_KERNEL_TARGET_BLOCK_INL_H_
#undef ONMESH_KERNEL_TARGET_BLOCK_INL_H_
#else
#define ONMESH_KERNEL_TARGET_BLOCK_INL_H_
#endif

#include <hwy/aligned_allocator.h>

#include <algorithm>

#include "onmesh/kernel/direct/neighbourhood-inl.h"
#include "onmesh/kernel/direct/sums-inl.h"

HWY_BEFORE_NAMESPACE();
namespace onmesh {
namespace HWY_NAMESPACE {
namespace {

/// Exponent of lanes that must not count: far beyond any radius, but no infinity arithmetic.
constexpr float kNever = -1e30F;

/// As many targets as a vector has lanes, with everything that is the same for all samples.
///
/// The exponent of target x and sample y, -d^2(x,y) in the records' scale, is
/// sum_ij a_i b_j D_ij - V(x) - V(y) (derived in lib/README.md). Its part of the targets alone,
/// E_j = sum_i a_i D_ij - V(x), is computed once for every node j around; over a face it is linear
/// in the samples' barycentrics b_j.
class TargetBlock {
 public:
  /// \param near must hold the faces around the targets when sum() is called
  TargetBlock(const KernelInput& input, const PatchRecords& records, const Neighbourhood& near)
      : table_(*input.table),
        records_(records),
        near_(near),
        lanes_(hn::Lanes(d_)),
        channels_(std::size_t(records.channels)),
        fields_(std::size_t(records.fields)),
        barycentric_(hwy::AllocateAligned<float>(3 * lanes_ * lanes_)),
        own_(hwy::AllocateAligned<float>(fields_ * lanes_)),
        node_exponents_(hwy::AllocateAligned<float>(table_.columns * lanes_)),
        most_(table_.columns),
        least_(table_.columns),
        unreachable_(table_.columns),
        face_exponents_(hwy::AllocateAligned<float>((records.faces.size() + 1) * 3 * lanes_)),
        sums_(hwy::AllocateAligned<float>((channels_ + 1) * lanes_)) {}

  /// Sum over all samples in the neighbourhood for the targets from `first` on.
  /// \return number of pairs within the radius
  template <class BlockSums>
  std::uint64_t sum(std::size_t first) {
    load_targets(first);
    compute_node_exponents();
    list_near_faces();
    list_hits();
    return sum_hits<BlockSums>();
  }

  /// Divide the sums by the weights.
  /// \param out as DirectKernel::run()
  /// \return number of targets that kept their values
  std::uint64_t write_means(const Colours& colours, std::vector<float>& out) const;

 private:
  /// A face's exponents at its corners, as the targets of all lanes have them, and the largest and
  /// the smallest of those.
  struct AtCorners {
    std::array<V, 3> exponents;
    std::array<float, 3> most, least;
  };

  // The steps of sum().

  /// Take over targets first, first + 1, ... with the corners around them.
  void load_targets(std::size_t first);
  /// Exponents of all targets at all nodes of the neighbourhood: sum_i a_i D_ij - V(x).
  void compute_node_exponents();
  /// List the faces that may have samples within the radius; lanes are faces.
  void list_near_faces();
  /// List the samples that targets may have within the radius, over all faces, so that they can be
  /// summed in long loops: short ones cost more in mispredicted branches than in sums.
  void list_hits();
  /// Sum over the samples listed.
  /// \return number of pairs within the radius
  template <class BlockSums>
  std::uint64_t sum_hits();

  // Their parts.

  void list_hits_of(const Neighbourhood::Face& face);
  /// \return whether any target may reach the whole face
  bool load_corners(const Neighbourhood::Face& face, AtCorners& at) const;
  /// Lanes whose face has a corner from which a corner of `face` is unreachable, and unused lanes.
  M unreachable_lanes(const Neighbourhood::Face& face) const;
  /// As list_hits_of() stored them for a record's face.
  FaceExponents<V> exponents_over(Index face) const {
    const float* const at = face_exponents_.get() + std::size_t(face) * 3 * hn::Lanes(D());
    return {hn::Load(d_, at), hn::Load(d_, at + hn::Lanes(D())),
            hn::Load(d_, at + 2 * hn::Lanes(D()))};
  }

  const D d_{};
  const DistanceTable& table_;
  const PatchRecords& records_;
  const Neighbourhood& near_;
  const std::size_t lanes_, channels_, fields_;

  // Of the targets.
  std::size_t used_ = 0;  ///< lanes
  const PatchRecords::Target* targets_ = nullptr;
  std::vector<Index> corners_;  ///< of their faces, each once
  /// Per corner, a vector: its scaled barycentric coordinate in each lane's target (0 where it is
  /// no corner).
  hwy::AlignedFreeUniquePtr<float[]> barycentric_;
  hwy::AlignedFreeUniquePtr<float[]> own_;  ///< scaled colours: a vector per field
  HWY_ALIGN float variance_[hn::MaxLanes(D())] = {};

  // Per node of the neighbourhood.
  std::vector<const float*> rows_;                     ///< of the corners in the table
  hwy::AlignedFreeUniquePtr<float[]> node_exponents_;  ///< a vector each
  std::vector<float> most_, least_;        ///< the largest and smallest exponent of any target
  std::vector<std::uint8_t> unreachable_;  ///< some target may not reach it

  // Per face.
  std::vector<std::int32_t> near_faces_;  ///< numbers of near_.faces
  std::size_t near_face_count_ = 0;
  /// By PatchRecords::faces: FaceExponents of the targets, three vectors each.
  hwy::AlignedFreeUniquePtr<float[]> face_exponents_;

  Hits hits_;
  hwy::AlignedFreeUniquePtr<float[]> sums_;  ///< of weights, then of each channel: a vector each
};

inline void TargetBlock::load_targets(std::size_t first) {
  used_ = std::min(lanes_, records_.targets.size() - first);
  targets_ = records_.targets.data() + first;
  corners_.clear();
  std::fill_n(barycentric_.get(), 3 * lanes_ * lanes_, 0.0F);
  std::fill_n(own_.get(), fields_ * lanes_, 0.0F);
  std::fill_n(sums_.get(), (channels_ + 1) * lanes_, 0.0F);
  std::fill_n(variance_, lanes_, kNever);
  for (std::size_t lane = 0; lane < used_; ++lane) {
    variance_[lane] = targets_[lane].variance;
    for (int i = 0; i < 3; ++i) {
      const auto at = std::find(corners_.begin(), corners_.end(), targets_[lane].corners[i]);
      const auto corner = std::size_t(at - corners_.begin());
      if (at == corners_.end()) corners_.push_back(targets_[lane].corners[i]);
      barycentric_[corner * lanes_ + lane] +=
          targets_[lane].barycentric[i] * records_.distance_scale;
    }
    for (std::size_t c = 0; c < fields_; ++c) {
      own_[c * lanes_ + lane] = records_.target_colours[(first + lane) * fields_ + c];
    }
  }
}

inline void TargetBlock::compute_node_exponents() {
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
    hn::Store(e, d_, node_exponents_.get() + k * lanes_);
    most_[k] = hn::GetLane(hn::MaxOfLanes(d_, e));
    least_[k] = hn::GetLane(hn::MinOfLanes(d_, e));
    unreachable_[k] = largest >= kUnreachable;
  }
}

inline void TargetBlock::list_near_faces() {
  const float limit = loose_limit(records_);
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

inline void TargetBlock::list_hits() {
  hits_.clear(near_.samples + lanes_);
  for (std::size_t i = 0; i < near_face_count_; ++i) list_hits_of(near_.faces[near_faces_[i]]);
}

HWY_INLINE void TargetBlock::list_hits_of(const Neighbourhood::Face& face) {
  AtCorners at;
  if (!load_corners(face, at)) return;
  float* const stored = face_exponents_.get() + face.number * 3 * lanes_;
  hn::Store(at.exponents[0], d_, stored);
  hn::Store(hn::Sub(at.exponents[1], at.exponents[0]), d_, stored + lanes_);
  hn::Store(hn::Sub(at.exponents[2], at.exponents[0]), d_, stored + 2 * lanes_);
  // Variances only add to the exponents inside the face.
  if (std::min({at.least[0], at.least[1], at.least[2]}) >= tight_limit(records_) &&
      std::max({at.most[0], at.most[1], at.most[2]}) + face.slack <= 0) {
    add_hits(d_, records_, face.begin, face.end, hits_.sure);
  } else {
    find_hits(d_, records_, face.begin, face.end, over_face(at.most), over_face(at.least), hits_);
  }
}

HWY_INLINE bool TargetBlock::load_corners(const Neighbourhood::Face& face, AtCorners& at) const {
  const auto& n = face.corners;
  for (std::size_t k = 0; k < 3; ++k) {
    at.exponents[k] = hn::Load(d_, node_exponents_.get() + n[k] * lanes_);
    at.most[k] = most_[n[k]];
    at.least[k] = least_[n[k]];
  }
  if ((unreachable_[n[0]] | unreachable_[n[1]] | unreachable_[n[2]]) == 0) return true;
  const M apart = unreachable_lanes(face);
  if (hn::AllTrue(d_, apart)) return false;
  for (std::size_t k = 0; k < 3; ++k) {
    at.exponents[k] = hn::IfThenElse(apart, hn::Set(d_, kNever), at.exponents[k]);
    at.most[k] = hn::GetLane(hn::MaxOfLanes(d_, at.exponents[k]));
    at.least[k] = kNever;
  }
  return true;
}

inline M TargetBlock::unreachable_lanes(const Neighbourhood::Face& face) const {
  HWY_ALIGN float is_apart[hn::MaxLanes(D()) + 1] = {};
  std::fill_n(is_apart, lanes_, 1.0F);
  for (std::size_t lane = 0; lane < used_; ++lane) {
    if (lane > 0 && targets_[lane].face == targets_[lane - 1].face) {
      is_apart[lane] = is_apart[lane - 1];
      continue;
    }
    bool apart = false;
    for (const Index corner : targets_[lane].corners) {
      for (const Index n : face.corners) {
        apart = apart || table_.row(corner)[near_.nodes[n]] >= kUnreachable;
      }
    }
    is_apart[lane] = apart ? 1.0F : 0.0F;
  }
  return hn::Gt(hn::Load(d_, is_apart), hn::Zero(d_));
}

template <class BlockSums>
HWY_INLINE std::uint64_t TargetBlock::sum_hits() {
  BlockSums sums(d_, records_, own_.get(), sums_.get());
  const float* const records = records_.records.data();
  std::uint64_t pairs = hits_.sure.count * lanes_;
  for (std::size_t k = 0; k < hits_.sure.count; ++k) {
    const float* const record = records + hits_.sure.records[k];
    sums.add_sure(d_, exponents_over(face_of(record)), record);
  }
  for (std::size_t k = 0; k < hits_.edge.count; ++k) {
    const float* const record = records + hits_.edge.records[k];
    pairs += sums.add_edge(d_, exponents_over(face_of(record)), record);
  }
  for (std::size_t k = 0; k < hits_.general.count; ++k) {
    const float* const record = records + hits_.general.records[k];
    pairs += sums.add(d_, exponents_over(face_of(record)), record);
  }
  sums.store(d_);
  return pairs;
}

inline std::uint64_t TargetBlock::write_means(const Colours& colours,
                                              std::vector<float>& out) const {
  std::uint64_t kept = 0;
  const bool differences =
      records_.range_term == RangeTerm::difference && records_.first_value == 0;
  const float* const reference = records_.reference.data() + records_.first_value;
  for (std::size_t lane = 0; lane < used_; ++lane) {
    const PatchRecords::Target& target = targets_[lane];
    const float* const own = colours.values_of(target.texel);
    float* const result = out.data() + std::size_t(target.slot) * channels_;
    const double weight = sums_[lane];
    const bool nothing = !(weight > kNothing);
    for (std::size_t c = 0; c < channels_; ++c) {
      const double mean = sums_[(c + 1) * lanes_ + lane] / (weight * records_.colour_scale);
      const double value = (differences ? own[c] : reference[c]) + mean;
      result[c] = nothing ? own[c] : static_cast<float>(value);
    }
    kept += nothing;
  }
  return kept;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace onmesh
HWY_AFTER_NAMESPACE();

#endif  // ONMESH_KERNEL_TARGET_BLOCK_INL_H_
