// The loop over a patch's samples, compiled once per instruction set: sorted by the parts of their
// face, then a chunk at a time.
#if defined(ONMESH_KERNEL_CHUNK_LOOP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ONMESH_KERNEL_CHUNK_LOOP_INL_H_
#undef ONMESH_KERNEL_CHUNK_LOOP_INL_H_
#else
#define ONMESH_KERNEL_CHUNK_LOOP_INL_H_
#endif

#include <algorithm>
#include <array>
#include <vector>

#include "onmesh/kernel/prefetch-inl.h"
#include "onmesh/kernel/splat/chunk-inl.h"
#include "onmesh/kernel/splat/node_kernel_state.h"

HWY_BEFORE_NAMESPACE();
namespace onmesh {
namespace HWY_NAMESPACE {
namespace {

/// The numbers of a face's samples, from 0, by the quarter that holds them of a part of the face.
class Quarters {
 public:
  /// All `count` samples of a face.
  /// \param is_split else all are in quarter 0
  void sort_face(const Sample* samples, std::size_t count, bool is_split) {
    prepare(count);
    const D d;
    const hn::RebindToUnsigned<D> du;
    for (std::size_t first = 0; first < count; first += hn::Lanes(d)) {
      const std::size_t there = std::min(hn::Lanes(d), count - first);
      const auto number = hn::Iota(du, Index(first));
      if (!is_split) {
        put(0, number, hn::FirstN(d, there));
        continue;
      }
      V b1, b2;
      load(samples + first, there, b1, b2);
      put_by_quarter(number, b1, b2, there);
    }
  }

  /// The samples of a part of a face.
  /// \param numbers `count` of them, padded by a vector
  void sort_part(const Sample* samples, const FacePart& part, const Index* numbers,
                 std::size_t count) {
    prepare(count);
    const D d;
    const hn::RebindToUnsigned<D> du;
    std::array<Sample, kLanes> some{};
    for (std::size_t first = 0; first < count; first += hn::Lanes(d)) {
      const std::size_t there = std::min(hn::Lanes(d), count - first);
      for (std::size_t i = 0; i < there; ++i) some[i] = samples[numbers[first + i]];
      V b1, b2;
      load(some.data(), hn::Lanes(d), b1, b2);
      const V scale = hn::Set(d, part.scale);
      put_by_quarter(hn::LoadU(du, numbers + first),
                     hn::MulAdd(b1, scale, hn::Set(d, part.offset[1])),
                     hn::MulAdd(b2, scale, hn::Set(d, part.offset[2])), there);
    }
  }

  std::size_t count(int quarter) const { return counts_[std::size_t(quarter)]; }
  /// Padded by a vector.
  const Index* numbers(int quarter) const { return numbers_[std::size_t(quarter)].data(); }

 private:
  void prepare(std::size_t count) {
    for (std::vector<Index>& list : numbers_)
      if (list.size() < count + kLanes) list.resize(2 * (count + kLanes));
    counts_ = {};
  }

  /// b1, b2: barycentric coordinates in what is quartered; of the first `count` lanes.
  template <typename N>
  void put_by_quarter(N number, V b1, V b2, std::size_t count) {
    const D d;
    const V half = hn::Set(d, 0.5F);
    const auto there = hn::FirstN(d, count);
    const auto at1 = hn::Ge(b1, half), at2 = hn::AndNot(at1, hn::Ge(b2, half));
    const auto not0 = hn::Gt(hn::Add(b1, b2), half);
    put(0, number, hn::AndNot(not0, there));
    put(1, number, hn::And(hn::And(at1, not0), there));
    put(2, number, hn::And(hn::And(at2, not0), there));
    put(3, number, hn::AndNot(hn::Or(at1, at2), hn::And(not0, there)));
  }

  static void load(const Sample* samples, std::size_t count, V& b1, V& b2) {
    static_assert(sizeof(Sample) == 4 * sizeof(float));
    const D d;
    std::array<Sample, kLanes> padded{};
    if (count < hn::Lanes(d)) {
      std::copy_n(samples, count, padded.begin());
      samples = padded.data();
    }
    V texel, area;
    hn::LoadInterleaved4(d, reinterpret_cast<const float*>(samples), texel, b1, b2, area);
  }

  template <typename N, typename M>
  void put(std::size_t quarter, N number, M mask) {
    const hn::RebindToUnsigned<D> du;
    counts_[quarter] += hn::CompressStore(number, hn::RebindMask(du, mask), du,
                                          numbers_[quarter].data() + counts_[quarter]);
  }

  std::array<std::vector<Index>, 4> numbers_;
  std::array<std::size_t, 4> counts_{};
};

/// The samples of the patch's faces, chunk by chunk. Keeps its buffers from face to face.
class ChunkLoop {
 public:
  explicit ChunkLoop(const NodeKernelState& state) : s_(state) {}

  /// Call for every chunk of the samples of a face: call(chunk, part, samples, numbers) with the
  /// part of the face that all of them are in, the face's first sample, and their numbers from it.
  /// \param local_face of the patch, before it is halved
  /// \param is_wanted whether the samples of a part are, by its corners
  template <typename IsWanted, typename Call>
  void run(const Samples& samples, Index local_face, const IsWanted& is_wanted, const Call& call) {
    const Index f = s_.input.patch->faces[local_face];
    const Index begin = samples.face_offsets[f], count = samples.face_offsets[f + 1] - begin;
    if (count == 0) return;
    face_ = split_face(s_.patch(), s_.subnodes, s_.is_halved, local_face);
    bool any = false;
    for (int half = 0; half < face_.halves; ++half) {
      for (int quarter = 0; quarter < face_.quarters[half]; ++quarter) {
        wanted_[4 * half + quarter] = is_wanted(face_.corners[4 * half + quarter]);
        any |= wanted_[4 * half + quarter];
      }
    }
    if (!any) return;
    samples_ = samples.samples.data() + begin;
    prefetch_colours(s_.input.colours, samples, f);
    if (s_.is_halved) {
      run_halved(count, call);
    } else {
      quarters_.sort_face(samples_, count, face_.quarters[0] > 1);
      run_quarters(0, FacePart(), call);
    }
  }

 private:
  template <typename Call>
  void run_halved(std::size_t count, const Call& call) {
    halves_.sort_face(samples_, count, true);
    for (int half = 0; half < 4; ++half) {
      const FacePart part = quarter_of(FacePart(), half);
      if (face_.quarters[half] > 1) {
        quarters_.sort_part(samples_, part, halves_.numbers(half), halves_.count(half));
        run_quarters(half, part, call);
      } else if (wanted_[4 * half]) {
        run_part(part, 4 * half, halves_.numbers(half), halves_.count(half), call);
      }
    }
  }

  /// \param whole the half, or the face if the patch is not halved
  template <typename Call>
  void run_quarters(int half, const FacePart& whole, const Call& call) {
    const bool is_split = face_.quarters[half] > 1;
    for (int q = 0; q < face_.quarters[half]; ++q) {
      if (!wanted_[4 * half + q]) continue;
      run_part(is_split ? quarter_of(whole, q) : whole, 4 * half + q, quarters_.numbers(q),
               quarters_.count(q), call);
    }
  }

  /// \param at of SplitFace::corners
  template <typename Call>
  void run_part(FacePart part, int at, const Index* numbers, std::size_t count, const Call& call) {
    part.corners = face_.corners[at];
    while (count > 0) {
      const std::size_t size = std::min(count, Chunk::kSize);
      chunk_.load(s_.survey, s_.input.colours, part, samples_, numbers, size);
      call(chunk_, part, samples_, numbers);
      numbers += size;
      count -= size;
    }
  }

  const NodeKernelState& s_;
  const Sample* samples_ = nullptr;  ///< of the face
  SplitFace face_;
  std::array<bool, 16> wanted_{};  ///< per quarter, as SplitFace::corners
  Quarters halves_, quarters_;
  Chunk chunk_;
};

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace onmesh
HWY_AFTER_NAMESPACE();

#endif  // ONMESH_KERNEL_CHUNK_LOOP_INL_H_
