#include "onmesh/kernel/splat/node_kernel.h"

#include <algorithm>

#include "onmesh/base/simd_targets.h"
#include "onmesh/kernel/splat/node_kernel_state.h"

// This file is compiled once per instruction set (Highway); the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "onmesh/kernel/splat/node_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "onmesh/kernel/splat/slice-inl.h"
#include "onmesh/kernel/splat/splat-inl.h"

HWY_BEFORE_NAMESPACE();
namespace onmesh {
namespace HWY_NAMESPACE {
namespace {

/// kVectors at a time of each core subnode's row.
template <int kVectors>
HWY_INLINE void blur_columns(NodeKernelState& s, std::size_t at) {
  const D d;
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t i = 0; i < s.subnodes.core.size(); ++i) {
    V sum[kVectors];
    for (V& x : sum) x = hn::Zero(d);
    for (std::size_t k = s.blur.offsets[i]; k < s.blur.offsets[i + 1]; ++k) {
      const V weight = hn::Set(d, s.blur.weights[k]);
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
    for (std::size_t p = 0; p < s.survey.planes(); ++p) {
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

void evaluate(NodeKernelState& s, std::vector<float>& out, std::vector<float>& support) {
  Splat(s).run();
  blur(s);
  if (s.survey.range_channels > 0) solve(s);
  Slice(s).run(out, support);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace onmesh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace onmesh {
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
  s.is_read = subnodes_read(s.subnodes, s.blur);
  std::vector<unsigned char> is_read(input.patch->faces.size());
  for (Index f = 0; f < is_read.size(); ++f) is_read[f] = s.reads_face(f);
  survey_samples(input, options_, is_read, s.survey);
  s.palette = {};
  return true;
}

double NodeKernel::choose_palette(int colours) {
  NodeKernelState& s = *state_;
  if (s.survey.colours.empty()) return 0;
  const auto channels = std::size_t(s.survey.range_channels);
  s.palette = make_palette(s.survey.colours.data(), s.survey.colours.size() / channels, channels,
                           channels, std::size_t(colours));
  return s.palette.residual;
}

int NodeKernel::evaluate(std::vector<float>& out, std::vector<float>& support) {
  NodeKernelState& s = *state_;
  const std::size_t planes = s.survey.planes();
  s.row = s.survey.range_channels > 0 ? planes * s.palette.padded : padded_to_lanes(planes);
  const Index targets = first_slots(s.input).back();
  support.resize(targets);
  out.resize(targets * std::size_t(s.survey.channels));
  s.splatted.assign(s.subnodes.size() * s.row, 0);
  s.blurred.resize(s.splatted.size());
  HWY_DYNAMIC_DISPATCH(evaluate)(s, out, support);
  return int(s.palette.size);
}

}  // namespace onmesh
#endif  // HWY_ONCE
