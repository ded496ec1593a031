#include "onmesh/kernel/near_samples.h"

#include <algorithm>
#include <cmath>

#include "onmesh/base/simd_targets.h"
#include "onmesh/base/triangle.h"

// This file is compiled once per instruction set (Highway); the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "onmesh/kernel/near_samples.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "onmesh/kernel/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace onmesh {
namespace HWY_NAMESPACE {
namespace {

/// Append the texels of those samples of a cell that are within the limit.
/// \param found with room for all and a vector more
/// \return how many they are
std::size_t append_near(const NearSamples::CellFloats& cell, const std::array<float, 3>& corners,
                        float limit, Index* found) {
  const D d;
  const hn::RebindToUnsigned<D> du;
  const std::size_t lanes = hn::Lanes(d);
  const V corner0 = hn::Set(d, corners[0]), to1 = hn::Set(d, corners[1] - corners[0]);
  const V to2 = hn::Set(d, corners[2] - corners[0]), farthest = hn::Set(d, limit);
  std::size_t count = 0;
  for (std::size_t k = 0; k < cell.count; k += lanes) {
    const V flat = hn::MulAdd(hn::LoadU(d, cell.b2 + k), to2,
                              hn::MulAdd(hn::LoadU(d, cell.b1 + k), to1, corner0));
    const V squared = hn::Sub(flat, hn::LoadU(d, cell.variance + k));
    const M is_near = hn::And(hn::Le(squared, farthest), hn::FirstN(d, cell.count - k));
    hn::StoreU(hn::Compress(hn::LoadU(du, cell.texels + k), hn::RebindMask(du, is_near)), du,
               found + count);
    count += hn::CountTrue(d, is_near);
  }
  return count;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace onmesh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace onmesh {
HWY_EXPORT(append_near);

namespace {

/// Cells of a face, along an edge, at most.
constexpr double kMostCells = 255;
/// How wide cells are at least, in distances between samples: looking at a cell costs as much as at
/// a sample.
constexpr double kCellWidth = 4;
/// So much farther, as a share, cells may be: on curved surface distances are interpolated.
constexpr double kCellSlack = 1.05;

Vec3 barycentric(double b1, double b2) { return {1 - b1 - b2, b1, b2}; }

/// The length of a step in a face.
double step_length(const std::array<double, 3>& l, double b1, double b2) {
  // lengths: corner 0 to 1, 1 to 2, 2 to 0
  const double g11 = l[0] * l[0], g22 = l[2] * l[2], g12 = (g11 + g22 - l[1] * l[1]) / 2;
  return std::sqrt(std::max(b1 * b1 * g11 + 2 * b1 * b2 * g12 + b2 * b2 * g22, 0.0));
}

}  // namespace

/// The face as one cell.
NearSamples::Cell NearSamples::whole_face(const std::array<double, 3>& lengths) {
  constexpr double kThird = 1.0 / 3;
  Cell cell{};
  cell.b1 = cell.b2 = float(kThird);
  cell.variance = float(barycentric_variance(lengths, barycentric(kThird, kThird)));
  // From the middle to the corners.
  cell.extent = float(
      std::max({step_length(lengths, -kThird, -kThird), step_length(lengths, 2 * kThird, -kThird),
                step_length(lengths, -kThird, 2 * kThird)}));
  return cell;
}

/// \param faces the first so many of the patch
void NearSamples::gather(const Patch& patch, const Samples& samples, Index faces, double radius,
                         Cells& cells) {
  cells.cells.clear();
  cells.face_cells.assign(1, 0);
  cells.b1.clear();
  cells.b2.clear();
  cells.variance.clear();
  cells.samples.clear();
  cells.texels.clear();
  for (Index f = 0; f < faces; ++f) {
    add_face(patch, samples, f, radius, cells);
    cells.face_cells.push_back(cells.cells.size());
  }
  // Vectors read beyond the last one.
  for (std::vector<float>* array : {&cells.b1, &cells.b2, &cells.variance})
    array->resize(array->size() + kLanes);
  cells.texels.resize(cells.texels.size() + kLanes);
}

void NearSamples::add_face(const Patch& patch, const Samples& samples, Index face, double radius,
                           Cells& cells) {
  const Index whole = patch.faces[face];
  const auto& l = patch.lengths[face];
  const double longest = std::max({l[0], l[1], l[2]});
  const double held = samples.face_offsets[whole + 1] - samples.face_offsets[whole];
  const double width = std::max(
      radius, kCellWidth * std::sqrt(triangle_area(l[0], l[1], l[2]) / std::max(held, 1.0)));
  const auto count = float(std::clamp(std::ceil(longest / width), 1.0, kMostCells));
  const auto number = [&](float b) { return std::uint32_t(std::clamp(b * count, 0.F, count - 1)); };
  keys_.clear();  // the first digit in base 256, for up to 255 cells
  for (Index k = samples.face_offsets[whole]; k < samples.face_offsets[whole + 1]; ++k) {
    const Sample& s = samples.samples[k];
    if (s.area > 0) keys_.emplace_back((number(s.b1) << 8) + number(s.b2), k);
  }
  sort_keys(std::uint32_t(count));
  for (std::size_t first = 0; first < keys_.size();) {
    std::size_t last = first;
    std::array<float, 2> low{2, 2}, high{-1, -1};
    for (; last < keys_.size() && keys_[last].first == keys_[first].first; ++last) {
      const Sample& s = samples.samples[keys_[last].second];
      low = {std::min(low[0], s.b1), std::min(low[1], s.b2)};
      high = {std::max(high[0], s.b1), std::max(high[1], s.b2)};
      cells.b1.push_back(s.b1);
      cells.b2.push_back(s.b2);
      cells.variance.push_back(float(barycentric_variance(l, barycentric(s.b1, s.b2))));
      cells.samples.push_back(keys_[last].second);
      cells.texels.push_back(s.texel);
    }
    Cell& cell = cells.cells.emplace_back();
    cell.face = face;
    cell.end = cells.samples.size();
    cell.begin = cell.end - (last - first);
    cell.b1 = (low[0] + high[0]) / 2;
    cell.b2 = (low[1] + high[1]) / 2;
    cell.variance = float(barycentric_variance(l, barycentric(cell.b1, cell.b2)));
    const double u = (high[0] - low[0]) / 2, v = (high[1] - low[1]) / 2;
    cell.extent = float(std::max(step_length(l, u, v), step_length(l, u, -v)));
    first = last;
  }
}

/// \param count of cells along an edge
void NearSamples::sort_keys(std::uint32_t count) {
  constexpr std::uint32_t kFew = 16;
  if (count < 2) return;
  if (count > kFew) return std::sort(keys_.begin(), keys_.end());
  // By counting.
  std::array<std::uint32_t, kFew * kFew + 1> starts{};
  const auto bucket = [&](std::uint32_t key) { return (key >> 8) * count + (key & 255); };
  for (const auto& [key, sample] : keys_) ++starts[bucket(key) + 1];
  for (std::uint32_t b = 0; b < count * count; ++b) starts[b + 1] += starts[b];
  sorted_.resize(keys_.size());
  for (const auto& one : keys_) sorted_[starts[bucket(one.first)]++] = one;
  keys_.swap(sorted_);
}

/// Those that may hold a sample within `largest` of a point of the core face: a pair lies in faces
/// whose corners are at most both longest edges farther apart.
void NearSamples::find_faces(const KernelInput& input, Index core_face, double largest) {
  const Patch& patch = *input.patch;
  const auto& core = patch.corners[core_face];
  const double reach = largest + longest_[core_face];
  const std::array<const float*, 3> rows{input.table->row(core[0]), input.table->row(core[1]),
                                         input.table->row(core[2])};
  near_faces_.clear();
  for (Index f = 0; f < patch.faces.size(); ++f) {
    if (sources_.face_cells[f] == sources_.face_cells[f + 1]) continue;
    float least = kUnreachable;
    for (const Index n : patch.corners[f])
      least = std::min({least, rows[0][n], rows[1][n], rows[2][n]});
    const double farthest = reach + longest_[f];
    if (double(least) <= farthest * farthest) near_faces_.push_back(f);
  }
}

/// Squared distances from a point of the core face to a face's corners, but for the variance that
/// points inside have.
/// \param at barycentric coordinates of the point
/// \param variance of the point
/// \return whether all are known
bool NearSamples::exponents_at(const KernelInput& input, Index core_face,
                               const std::array<float, 3>& at, float variance, Index face,
                               std::array<float, 3>& corners) const {
  const auto& core = input.patch->corners[core_face];
  const std::array<const float*, 3> rows{input.table->row(core[0]), input.table->row(core[1]),
                                         input.table->row(core[2])};
  for (std::size_t k = 0; k < 3; ++k) {
    const Index n = input.patch->corners[face][k];
    if (std::max({rows[0][n], rows[1][n], rows[2][n]}) >= kUnreachable) return false;
    corners[k] = at[0] * rows[0][n] + at[1] * rows[1][n] + at[2] * rows[2][n] - variance;
  }
  return true;
}

void NearSamples::find_cells(const KernelInput& input, const Cell& targets, double largest) {
  near_count_ = 0;
  std::array<float, 3> corners{};
  const std::array<float, 3> at{1 - targets.b1 - targets.b2, targets.b1, targets.b2};
  const auto is_near = [&](const Cell& cell) {
    const float squared = corners[0] + cell.b1 * (corners[1] - corners[0]) +
                          cell.b2 * (corners[2] - corners[0]) - cell.variance;
    const double reach = kCellSlack * (largest + targets.extent + cell.extent);
    return double(squared) <= reach * reach;
  };
  for (const Index f : near_faces_) {
    if (!exponents_at(input, targets.face, at, targets.variance, f, corners)) continue;
    if (!is_near(whole_faces_[f])) continue;
    if (near_.size() == near_count_) near_.emplace_back();
    NearFace& near = near_[near_count_];
    near.face = f;
    near.cells.clear();
    for (std::size_t c = sources_.face_cells[f]; c < sources_.face_cells[f + 1]; ++c) {
      if (is_near(sources_.cells[c])) near.cells.push_back(&sources_.cells[c]);
    }
    if (!near.cells.empty()) ++near_count_;
  }
}

void NearSamples::find_samples(const KernelInput& input, Index core_face, std::size_t target,
                               double radius) {
  const float b1 = targets_.b1[target], b2 = targets_.b2[target];
  const std::array<float, 3> at{std::max(1 - b1 - b2, 0.F), std::max(b1, 0.F), std::max(b2, 0.F)};
  const Index own = input.targets->samples[targets_.samples[target]].texel;
  const auto limit = float(radius * radius);
  std::array<float, 3> corners{};
  std::size_t count = 0;
  for (std::size_t k = 0; k < near_count_; ++k) {
    if (!exponents_at(input, core_face, at, targets_.variance[target], near_[k].face, corners))
      continue;
    for (const Cell* cell : near_[k].cells) {
      const CellFloats floats{&sources_.b1[cell->begin], &sources_.b2[cell->begin],
                              &sources_.variance[cell->begin], &sources_.texels[cell->begin],
                              cell->end - cell->begin};
      if (found_.size() < count + floats.count + kLanes)
        found_.resize(2 * (count + floats.count + kLanes));
      count += HWY_DYNAMIC_DISPATCH(append_near)(floats, corners, limit, &found_[count]);
    }
  }
  const auto end = std::remove(found_.begin(), found_.begin() + std::ptrdiff_t(count), own);
  found_count_ = std::size_t(end - found_.begin());
}

void NearSamples::run(const KernelInput& input, double largest, const RadiusOf& radius_of,
                      double slack, const Visit& visit) {
  const Patch& patch = *input.patch;
  longest_.clear();
  whole_faces_.clear();
  for (const auto& l : patch.lengths) {
    longest_.push_back(float(std::max({l[0], l[1], l[2]})));
    whole_faces_.push_back(whole_face(l));
  }
  gather(patch, *input.sources, Index(patch.faces.size()), largest, sources_);
  gather(patch, *input.targets, patch.core_faces, largest, targets_);
  for (Index f = 0; f < patch.core_faces; ++f) {
    if (targets_.face_cells[f] == targets_.face_cells[f + 1]) continue;
    find_faces(input, f, largest * slack);
    for (std::size_t c = targets_.face_cells[f]; c < targets_.face_cells[f + 1]; ++c) {
      const Cell& cell = targets_.cells[c];
      find_cells(input, cell, largest * slack);
      for (std::size_t k = cell.begin; k < cell.end; ++k) {
        const Sample& target = input.targets->samples[targets_.samples[k]];
        const double radius = radius_of(target);
        if (!(radius > 0)) continue;
        find_samples(input, f, k, radius * slack);
        visit(target, {found_.data(), found_count_});
      }
    }
  }
}

}  // namespace onmesh
#endif  // HWY_ONCE
