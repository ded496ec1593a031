#include "onmesh/kernel/splat/node_kernel.h"

#include <hwy/aligned_allocator.h>
#include <hwy/cache_control.h>

#include <algorithm>
#include <array>
#include <type_traits>

#include "onmesh/kernel/splat/survey.h"

// This file is compiled once per instruction set (Highway); the best one is chosen at run time.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "onmesh/kernel/splat/node_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "onmesh/base/exp2-inl.h"
#include "onmesh/kernel/splat/node_samples-inl.h"

HWY_BEFORE_NAMESPACE();
namespace onmesh {
namespace HWY_NAMESPACE {
namespace {

/// x := 2^x. \pre the vector's size is a multiple of kLanes
void raise(std::vector<float>& x) {
  const D d;
  for (std::size_t i = 0; i < x.size(); i += hn::Lanes(d))
    hn::StoreU(exp2(d, hn::LoadU(d, x.data() + i)), d, x.data() + i);
}

/// Planes are summed in groups of up to so many, for which the sums stay in registers.
constexpr std::size_t kGroup = 4;

/// Buffers for one chunk of samples.
struct Scratch {
  Quarters halves, quarters;
  Chunk chunk;
  std::vector<Chunk::Array> planes;  ///< per plane and corner: what a sample adds there
  /// Of samples to the palette's colours: lanes are colours for splatting, samples for slicing.
  hwy::AlignedFreeUniquePtr<float[]> likeness;
  std::vector<Chunk::Array> results;  ///< per plane
};

/// Call with the number of range channels as a constant: 0 stands for any number.
template <typename Call>
void with_range_channels(int channels, const Call& call) {
  switch (channels) {
    case 1:
      return call(std::integral_constant<int, 1>());
    case 3:
      return call(std::integral_constant<int, 3>());
    default:
      return call(std::integral_constant<int, 0>());
  }
}

/// Call for groups of planes with the first and, as a constant, their number.
template <typename Call>
void for_plane_groups(std::size_t planes, const Call& call) {
  std::size_t p = 0;
  for (; p + kGroup <= planes; p += kGroup) call(p, std::integral_constant<std::size_t, kGroup>());
  for (; p + 2 <= planes; p += 2) call(p, std::integral_constant<std::size_t, 2>());
  if (p < planes) call(p, std::integral_constant<std::size_t, 1>());
}

/// Call for every chunk of some samples of a face, all in one part of it.
template <typename Call>
void for_chunks_of_part(const NodeKernelState& s, const FacePart& part, const Sample* samples,
                        const Index* numbers, std::size_t count, Scratch& scratch,
                        const Call& call) {
  while (count > 0) {
    const std::size_t size = std::min(count, Chunk::kSize);
    scratch.chunk.load(s.work, s.input.colours, part, samples, numbers, size);
    call(part, samples, numbers);
    numbers += size;
    count -= size;
  }
}

/// Call for every chunk of the samples of a patch face with the part of the face that it is in.
template <typename IsWanted, typename Call>
void for_chunks(const NodeKernelState& s, const Samples& samples, Index local_face,
                Scratch& scratch, const IsWanted& is_wanted, const Call& call) {
  const Index f = s.input.patch->faces[local_face];
  const Index begin = samples.face_offsets[f], count = samples.face_offsets[f + 1] - begin;
  if (count == 0) return;
  // The faces that subnodes know: this one or its four halves, of which each may be split.
  const Patch& patch = s.patch();
  const Index halves = s.is_halved ? 4 : 1, first_half = halves * local_face;
  const auto parts = [&](Index half) { return s.subnodes.is_split[half] != 0 ? 4 : 1; };
  std::array<std::array<Index, 3>, 16> corners;
  std::array<bool, 16> wanted{};
  for (Index h = 0; h < halves; ++h) {
    for (int q = 0; q < parts(first_half + h); ++q) {
      corners[4 * h + q] = corners_of(patch, s.subnodes, first_half + h, q);
      wanted[4 * h + q] = is_wanted(corners[4 * h + q]);
    }
  }
  if (std::find(wanted.begin(), wanted.end(), true) == wanted.end()) return;
  const Sample* const first = samples.samples.data() + begin;
  // Colours are all over the texture; none should be waited for by itself.
  const Colours& texels = s.input.colours;
  for (const Sample* sample = first; sample != first + count; ++sample)
    hwy::Prefetch(texels.values + std::size_t(sample->texel) * std::size_t(texels.stride));
  const FacePart whole;
  Quarters& quarters = scratch.quarters;
  if (s.is_halved) {
    scratch.halves.sort_face(first, count, true);
  } else {
    quarters.sort_face(first, count, parts(first_half) > 1);
  }
  for (Index h = 0; h < halves; ++h) {
    FacePart half = s.is_halved ? quarter_of(whole, int(h)) : whole;
    const bool is_split = parts(first_half + h) > 1;
    if (s.is_halved && !is_split) {
      if (!wanted[4 * h]) continue;
      half.corners = corners[4 * h];
      for_chunks_of_part(s, half, first, scratch.halves.numbers(int(h)),
                         scratch.halves.count(int(h)), scratch, call);
      continue;
    }
    if (s.is_halved) {
      quarters.sort_part(first, half, scratch.halves.numbers(int(h)), scratch.halves.count(int(h)));
    }
    for (int q = 0; q < parts(first_half + h); ++q) {
      if (!wanted[4 * h + Index(q)]) continue;
      FacePart part = is_split ? quarter_of(half, q) : half;
      part.corners = corners[4 * h + Index(q)];
      for_chunks_of_part(s, part, first, quarters.numbers(q), quarters.count(q), scratch, call);
    }
  }
}

/// What the chunk's samples add at their corners: their weights, and their colours times those.
void weigh(const NodeKernelState& s, Scratch& scratch) {
  const D d;
  const Chunk& chunk = scratch.chunk;
  scratch.planes.resize(3 * s.work.planes());
  for (std::size_t i = 0; i < chunk.count; i += hn::Lanes(d)) {
    const V weight = hn::LoadU(d, &chunk.weights[i]);
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const V share = hn::Mul(hn::LoadU(d, &chunk.corners[corner][i]), weight);
      hn::StoreU(share, d, &scratch.planes[corner][i]);
      for (std::size_t c = 0; c < chunk.colours.size(); ++c) {
        hn::StoreU(hn::Mul(share, hn::LoadU(d, &chunk.colours[c][i])), d,
                   &scratch.planes[3 * (c + 1) + corner][i]);
      }
    }
  }
}

/// likeness[sample][lane] = f(|colour of the sample - c_k|) for k = first, ...
template <int kChannels>
void compare_to_colours(const NodeKernelState& s, std::size_t first, Scratch& scratch) {
  const D d;
  const auto channels = kChannels > 0 ? std::size_t(kChannels) : std::size_t(s.work.range_channels);
  const Chunk& chunk = scratch.chunk;
  for (std::size_t r = 0; r < chunk.count; ++r) {
    V x = hn::Zero(d);
    for (std::size_t c = 0; c < channels; ++c) {
      const float* const colours = s.palette.colours.data() + c * s.palette.padded + first;
      const V difference = hn::Sub(hn::Set(d, chunk.colours[c][r]), hn::LoadU(d, colours));
      x = hn::NegMulAdd(difference, difference, x);
    }
    hn::Store(exp2(d, x), d, scratch.likeness.get() + r * hn::Lanes(d));
  }
}

/// likeness[k][lane] = f(|colour of the sample - c_k|) for samples first, ...
template <int kChannels>
void compare_to_samples(const NodeKernelState& s, std::size_t first, Scratch& scratch) {
  const D d;
  const auto channels = kChannels > 0 ? std::size_t(kChannels) : std::size_t(s.work.range_channels);
  for (std::size_t k = 0; k < s.palette.size; ++k) {
    V x = hn::Zero(d);
    for (std::size_t c = 0; c < channels; ++c) {
      const V own = hn::LoadU(d, &scratch.chunk.colours[c][first]);
      const V difference = hn::Sub(own, hn::Set(d, s.palette.colours[c * s.palette.padded + k]));
      x = hn::NegMulAdd(difference, difference, x);
    }
    hn::Store(exp2(d, x), d, scratch.likeness.get() + k * hn::Lanes(d));
  }
}

/// Add kPlanes planes of the chunk to a vector of each of the corners' rows.
template <std::size_t kPlanes>
HWY_INLINE void add_planes(const Scratch& scratch, std::size_t plane,
                           const std::array<float*, 3>& rows, std::size_t padded) {
  const D d;
  V sums[3 * kPlanes];
  for (V& sum : sums) sum = hn::Zero(d);
  const Chunk::Array* const from = scratch.planes.data() + 3 * plane;
  const float* likeness = scratch.likeness.get();
  for (std::size_t r = 0; r < scratch.chunk.count; ++r, likeness += hn::Lanes(d)) {
    const V like = hn::Load(d, likeness);
    for (std::size_t j = 0; j < 3 * kPlanes; ++j)
      sums[j] = hn::MulAdd(hn::Set(d, from[j][r]), like, sums[j]);
  }
  for (std::size_t j = 0; j < 3 * kPlanes; ++j) {
    float* const to = rows[j % 3] + (plane + j / 3) * padded;
    hn::StoreU(hn::Add(hn::LoadU(d, to), sums[j]), d, to);
  }
}

void splat_chunk(NodeKernelState& s, const FacePart& part, Scratch& scratch) {
  const D d;
  weigh(s, scratch);
  std::array<float*, 3> rows;
  for (std::size_t k = 0; k < 3; ++k) rows[k] = s.splatted.data() + part.corners[k] * s.row;
  if (s.work.range_channels == 0) {
    for (std::size_t j = 0; j < scratch.planes.size(); ++j) {
      V sum = hn::Zero(d);
      for (std::size_t i = 0; i < scratch.chunk.count; i += hn::Lanes(d))
        sum = hn::Add(sum, hn::LoadU(d, &scratch.planes[j][i]));
      rows[j % 3][j / 3] += hn::GetLane(hn::SumOfLanes(d, sum));
    }
    return;
  }
  with_range_channels(s.work.range_channels, [&](auto channels) HWY_ATTR {
    for (std::size_t k = 0; k < s.palette.padded; k += hn::Lanes(d)) {
      compare_to_colours<channels.value>(s, k, scratch);
      const std::array<float*, 3> at{rows[0] + k, rows[1] + k, rows[2] + k};
      for_plane_groups(s.work.planes(), [&](std::size_t plane, auto count) HWY_ATTR {
        add_planes<count.value>(scratch, plane, at, s.palette.padded);
      });
    }
  });
}

void splat(NodeKernelState& s, Scratch& scratch) {
  const auto is_wanted = [&](const std::array<Index, 3>& corners) {
    return (s.work.used[corners[0]] | s.work.used[corners[1]] | s.work.used[corners[2]]) != 0;
  };
  for (Index f = 0; f < s.input.patch->faces.size(); ++f) {
    for_chunks(
        s, *s.input.sources, f, scratch, is_wanted,
        [&](const FacePart& part, const Sample*, const Index*) { splat_chunk(s, part, scratch); });
  }
}

/// What was added to midpoints that stand for their edge's ends goes there.
void share_out(NodeKernelState& s) {
  const D d;
  for (Index i = 0; i < s.subnodes.size(); ++i) {
    if (s.subnodes.is_real[i]) continue;
    for (const Index end : s.subnodes.ends[i]) {
      const float* const from = s.splatted.data() + i * s.row;
      float* const to = s.splatted.data() + end * s.row;
      for (std::size_t k = 0; k < s.row; k += hn::Lanes(d))
        hn::StoreU(hn::MulAdd(hn::Set(d, 0.5F), hn::LoadU(d, from + k), hn::LoadU(d, to + k)), d,
                   to + k);
    }
  }
}

/// kVectors at a time of each core subnode's row.
template <int kVectors>
HWY_INLINE void blur_columns(NodeKernelState& s, std::size_t at) {
  const D d;
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t i = 0; i < s.subnodes.core.size(); ++i) {
    V sum[kVectors];
    for (V& x : sum) x = hn::Zero(d);
    for (std::size_t k = s.blur.offsets[i]; k < s.blur.offsets[i + 1]; ++k) {
      const V weight = hn::Set(d, s.blur.exponents[k]);
      const float* const from = s.splatted.data() + s.blur.subnodes[k] * s.row + at;
      for (int v = 0; v < kVectors; ++v)
        sum[v] = hn::MulAdd(weight, hn::LoadU(d, from + std::size_t(v) * lanes), sum[v]);
    }
    float* const to = s.blurred.data() + s.subnodes.core[i] * s.row + at;
    for (int v = 0; v < kVectors; ++v) hn::StoreU(sum[v], d, to + std::size_t(v) * lanes);
  }
}

void blur(NodeKernelState& s) {
  const std::size_t lanes = hn::Lanes(D());
  std::size_t at = 0;
  for (; at + 8 * lanes <= s.row; at += 8 * lanes) blur_columns<8>(s, at);
  for (; at + 4 * lanes <= s.row; at += 4 * lanes) blur_columns<4>(s, at);
  for (; at < s.row; at += lanes) blur_columns<1>(s, at);
}

/// Multiply each plane of every core subnode by the palette's inverse.
void solve(NodeKernelState& s) {
  const D d;
  const std::size_t padded = s.palette.padded, lanes = hn::Lanes(d);
  std::vector<float> plane(padded);
  for (const Index i : s.subnodes.core) {
    for (std::size_t p = 0; p < s.work.planes(); ++p) {
      float* const at = s.blurred.data() + i * s.row + p * padded;
      std::copy_n(at, padded, plane.begin());
      for (std::size_t k = 0; k < padded; k += lanes) {
        V sum = hn::Zero(d);
        for (std::size_t l = 0; l < s.palette.size; ++l)
          sum = hn::MulAdd(hn::Set(d, plane[l]),
                           hn::LoadU(d, s.palette.inverse.data() + l * padded + k), sum);
        hn::StoreU(sum, d, at + k);
      }
    }
  }
}

/// Midpoints that stand for their edge's ends get the mean of them.
void fill_in(NodeKernelState& s) {
  const D d;
  for (Index i = 0; i < s.subnodes.size(); ++i) {
    if (s.subnodes.is_real[i]) continue;
    const float* const a = s.blurred.data() + s.subnodes.ends[i][0] * s.row;
    const float* const b = s.blurred.data() + s.subnodes.ends[i][1] * s.row;
    float* const to = s.blurred.data() + i * s.row;
    for (std::size_t k = 0; k < s.row; k += hn::Lanes(d)) {
      const V sum = hn::Add(hn::LoadU(d, a + k), hn::LoadU(d, b + k));
      hn::StoreU(hn::Mul(hn::Set(d, 0.5F), sum), d, to + k);
    }
  }
}

/// results[plane][first ...] for kPlanes planes: the rows' values interpolated at each sample,
/// summed by its likeness to the palette's colours.
template <std::size_t kPlanes>
HWY_INLINE void read_planes(const NodeKernelState& s, std::size_t plane,
                            const std::array<const float*, 3>& rows, std::size_t first,
                            Scratch& scratch) {
  const D d;
  const std::size_t padded = s.palette.padded;
  V sums[3 * kPlanes];
  for (V& sum : sums) sum = hn::Zero(d);
  for (std::size_t k = 0; k < s.palette.size; ++k) {
    const V like = hn::Load(d, scratch.likeness.get() + k * hn::Lanes(d));
    for (std::size_t j = 0; j < 3 * kPlanes; ++j) {
      const V value = hn::Set(d, rows[j % 3][(plane + j / 3) * padded + k]);
      sums[j] = hn::MulAdd(value, like, sums[j]);
    }
  }
  for (std::size_t p = 0; p < kPlanes; ++p) {
    V sum = hn::Zero(d);
    for (std::size_t k = 0; k < 3; ++k)
      sum = hn::MulAdd(hn::LoadU(d, &scratch.chunk.corners[k][first]), sums[3 * p + k], sum);
    hn::StoreU(sum, d, &scratch.results[plane + p][first]);
  }
}

/// The same for the Gaussian filter, all planes.
HWY_INLINE void interpolate(const std::array<const float*, 3>& rows, std::size_t first,
                            Scratch& scratch) {
  const D d;
  for (std::size_t p = 0; p < scratch.results.size(); ++p) {
    V sum = hn::Zero(d);
    for (std::size_t k = 0; k < 3; ++k)
      sum = hn::MulAdd(hn::LoadU(d, &scratch.chunk.corners[k][first]), hn::Set(d, rows[k][p]), sum);
    hn::StoreU(sum, d, &scratch.results[p][first]);
  }
}

/// Turn a vector of sums into supports (0 where the own value is kept) and means.
HWY_INLINE void divide(const NodeWork& work, std::size_t first, Scratch& scratch) {
  const D d;
  float* const sums = &scratch.results[0][first];
  const V sum = hn::LoadU(d, sums), own = hn::LoadU(d, &scratch.chunk.weights[first]);
  const V zero = hn::Zero(d);
  const auto is_usable = hn::And(hn::Gt(sum, zero), hn::Gt(own, zero));
  hn::StoreU(hn::IfThenElseZero(is_usable, hn::Div(sum, own)), d, sums);
  const V inverse = hn::Div(hn::Set(d, 1), hn::Mul(sum, hn::Set(d, work.colour_scale)));
  for (std::size_t c = 0; c + 1 < scratch.results.size(); ++c) {
    float* const at = &scratch.results[1 + c][first];
    hn::StoreU(hn::MulAdd(hn::LoadU(d, at), inverse, hn::Set(d, work.reference[c])), d, at);
  }
}

void slice_chunk(const NodeKernelState& s, const FacePart& part, Scratch& scratch) {
  scratch.results.resize(s.work.planes());
  std::array<const float*, 3> rows;
  for (std::size_t k = 0; k < 3; ++k) rows[k] = s.blurred.data() + part.corners[k] * s.row;
  with_range_channels(s.work.range_channels, [&](auto channels) HWY_ATTR {
    for (std::size_t i = 0; i < scratch.chunk.count; i += hn::Lanes(D())) {
      if (s.work.range_channels == 0) {
        interpolate(rows, i, scratch);
      } else {
        compare_to_samples<channels.value>(s, i, scratch);
        for_plane_groups(s.work.planes(), [&](std::size_t plane, auto count) HWY_ATTR {
          read_planes<count.value>(s, plane, rows, i, scratch);
        });
      }
      divide(s.work, i, scratch);
    }
  });
}

void slice(const NodeKernelState& s, Scratch& scratch, std::vector<float>& out,
           std::vector<float>& support) {
  const Patch& patch = *s.input.patch;
  const Samples& targets = *s.input.targets;
  const Colours& texels = s.input.colours;
  const auto channels = std::size_t(s.work.channels);
  Index slots = 0;
  for (Index f = 0; f < patch.core_faces; ++f) {
    const auto store = [&](const FacePart& part, const Sample* samples, const Index* numbers) {
      slice_chunk(s, part, scratch);
      for (std::size_t i = 0; i < scratch.chunk.count; ++i) {
        const Index slot = slots + numbers[i];
        float* const to = out.data() + slot * channels;
        support[slot] = scratch.results[0][i];
        if (support[slot] > 0) {
          for (std::size_t c = 0; c < channels; ++c) to[c] = scratch.results[1 + c][i];
        } else {
          const Index texel = samples[numbers[i]].texel;
          std::copy_n(texels.values + std::size_t(texel) * std::size_t(texels.stride), channels,
                      to);
        }
      }
    };
    for_chunks(
        s, targets, f, scratch, [](const std::array<Index, 3>&) { return true; }, store);
    slots += targets.face_offsets[patch.faces[f] + 1] - targets.face_offsets[patch.faces[f]];
  }
}

void evaluate(NodeKernelState& s, std::vector<float>& out, std::vector<float>& support) {
  Scratch scratch;
  const std::size_t compared = std::max(Chunk::kSize, s.palette.padded);
  scratch.likeness = hwy::AllocateAligned<float>(compared * hn::Lanes(D()));
  splat(s, scratch);
  share_out(s);
  blur(s);
  if (s.work.range_channels > 0) solve(s);
  fill_in(s);
  slice(s, scratch, out, support);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace onmesh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace onmesh {
HWY_EXPORT(raise);
HWY_EXPORT(evaluate);

namespace {

/// In sigmas: edges longer than kSplit are split; patches whose edges are longer than kHalved on
/// average are halved before. Subnodes so far apart are as good as the node table itself.
constexpr double kSplit = 0.5, kHalved = 2;

/// Entries of a halved patch's table: 256 MB a thread at most.
constexpr double kMostHalved = 64e6;

double mean_core_edge(const Patch& patch) {
  double sum = 0;
  for (Index f = 0; f < patch.core_faces; ++f)
    sum += patch.lengths[f][0] + patch.lengths[f][1] + patch.lengths[f][2];
  return sum / (3 * std::max<Index>(patch.core_faces, 1));
}

/// Targets of the patch's core.
Index count_targets(const KernelInput& input) {
  Index count = 0;
  for (Index f = 0; f < input.patch->core_faces; ++f) {
    const Index face = input.patch->faces[f];
    count += input.targets->face_offsets[face + 1] - input.targets->face_offsets[face];
  }
  return count;
}

}  // namespace

NodeKernel::NodeKernel(const KernelOptions& options)
    : options_(options), state_(std::make_unique<NodeKernelState>()) {}
NodeKernel::~NodeKernel() = default;
NodeKernel::NodeKernel(NodeKernel&&) noexcept = default;

bool NodeKernel::halves(double edge, double sigma) { return edge > kHalved * sigma; }

bool NodeKernel::load(const KernelInput& input) {
  NodeKernelState& s = *state_;
  const double sigma = options_.sigma_spatial;
  s.input = input;
  s.is_halved = halves(mean_core_edge(*input.patch), sigma);
  if (!s.is_halved) s.subnodes = make_subnodes(*input.patch, kSplit * sigma);
  // Interpolation must not blur as much as the filter.
  const auto is_too_coarse = [&] {
    return std::any_of(s.subnodes.variance.begin(), s.subnodes.variance.end(),
                       [sigma](float v) { return v > 0.5 * sigma * sigma; });
  };
  if (s.is_halved || is_too_coarse()) {
    const double entries = 16.0 * double(input.table->rows) * double(input.table->columns);
    if (input.patch->bridge_faces > 0 || entries > kMostHalved) return false;
    s.is_halved = true;
    halve(*input.patch, *input.table, s.halved);
    s.subnodes = make_subnodes(s.halved.patch, kSplit * sigma);
    if (is_too_coarse()) return false;
  }
  s.blur = make_blur(s.patch(), s.table(), s.subnodes, sigma, options_.radius);
  // Padded, so that vectors of any size fit.
  const std::size_t entries = s.blur.subnodes.size();
  s.blur.exponents.resize((entries + Palette::kLanes - 1) / Palette::kLanes * Palette::kLanes);
  HWY_DYNAMIC_DISPATCH(raise)(s.blur.exponents);
  survey(options_, s);
  s.palette = {};
  return true;
}

double NodeKernel::choose_palette(int colours) {
  NodeKernelState& s = *state_;
  if (s.work.colours.empty()) return 0;
  const auto channels = std::size_t(s.work.range_channels);
  s.palette = make_palette(s.work.colours.data(), s.work.colours.size() / channels, channels,
                           channels, std::size_t(colours));
  return s.palette.residual;
}

int NodeKernel::evaluate(std::vector<float>& out, std::vector<float>& support) {
  NodeKernelState& s = *state_;
  const std::size_t planes = s.work.planes();
  s.row = s.work.range_channels > 0
              ? planes * s.palette.padded
              : (planes + Palette::kLanes - 1) / Palette::kLanes * Palette::kLanes;
  const Index targets = count_targets(s.input);
  support.resize(targets);
  out.resize(targets * std::size_t(s.work.channels));
  s.splatted.assign(s.subnodes.size() * s.row, 0);
  s.blurred.resize(s.splatted.size());
  HWY_DYNAMIC_DISPATCH(evaluate)(s, out, support);
  return int(s.palette.size);
}

}  // namespace onmesh
#endif
