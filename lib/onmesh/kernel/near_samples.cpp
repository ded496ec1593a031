#include "onmesh/kernel/near_samples.h"

#include <algorithm>
#include <cmath>

namespace onmesh {
namespace {

Vec3 barycentric(const Sample& s) { return {1.0 - s.b1 - s.b2, s.b1, s.b2}; }

}  // namespace

void NearSamples::gather(const KernelInput& input) {
  const Patch& patch = *input.patch;
  const Samples& sources = *input.sources;
  faces_.clear();
  longest_.clear();
  b1_.clear();
  b2_.clear();
  variance_.clear();
  texels_.clear();
  for (std::size_t local = 0; local < patch.faces.size(); ++local) {
    const Index f = patch.faces[local];
    const std::size_t begin = texels_.size();
    for (Index k = sources.face_offsets[f]; k < sources.face_offsets[f + 1]; ++k) {
      const Sample& s = sources.samples[k];
      if (!(s.area > 0)) continue;
      b1_.push_back(s.b1);
      b2_.push_back(s.b2);
      variance_.push_back(float(barycentric_variance(patch.lengths[local], barycentric(s))));
      texels_.push_back(s.texel);
    }
    if (texels_.size() == begin) continue;
    const auto& l = patch.lengths[local];
    faces_.push_back({patch.corners[local], begin, texels_.size()});
    longest_.push_back(float(std::max({l[0], l[1], l[2]})));
  }
}

/// Those that may hold a sample within `largest` of a point of the core face: a pair lies in faces
/// whose corners are at most both longest edges farther apart.
void NearSamples::find_faces(const KernelInput& input, Index core_face, double largest) {
  const Patch& patch = *input.patch;
  const auto& core = patch.corners[core_face];
  const auto& l = patch.lengths[core_face];
  const double reach = largest + std::max({l[0], l[1], l[2]});
  const float* const rows[] = {input.table->row(core[0]), input.table->row(core[1]),
                               input.table->row(core[2])};
  near_.clear();
  for (Index f = 0; f < faces_.size(); ++f) {
    float least = kUnreachable;
    for (const Index n : faces_[f].corners)
      least = std::min({least, rows[0][n], rows[1][n], rows[2][n]});
    const double farthest = reach + longest_[f];
    if (double(least) <= farthest * farthest) near_.push_back(f);
  }
}

void NearSamples::find_samples(const DistanceTable& table, const std::array<Index, 3>& corners,
                               const Sample& target, double variance, double radius) {
  const Vec3 a = barycentric(target).cwiseMax(0);
  const float* const rows[] = {table.row(corners[0]), table.row(corners[1]), table.row(corners[2])};
  const auto limit = float(radius * radius);
  found_.clear();
  for (const Index f : near_) {
    const Face& face = faces_[f];
    float at[3];
    bool is_reachable = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const Index n = face.corners[k];
      is_reachable &= std::max({rows[0][n], rows[1][n], rows[2][n]}) < kUnreachable;
      at[k] = float(a[0] * rows[0][n] + a[1] * rows[1][n] + a[2] * rows[2][n] - variance);
    }
    if (!is_reachable) continue;
    const std::size_t count = face.end - face.begin;
    if (distance_.size() < count) distance_.resize(2 * count);
    const float *const b1 = &b1_[face.begin], *const b2 = &b2_[face.begin],
                       *const v = &variance_[face.begin];
    const float to1 = at[1] - at[0], to2 = at[2] - at[0];
    float* const distance = distance_.data();
    for (std::size_t k = 0; k < count; ++k) distance[k] = at[0] + b1[k] * to1 + b2[k] * to2 - v[k];
    for (std::size_t k = 0; k < count; ++k) {
      if (distance[k] <= limit && texels_[face.begin + k] != target.texel)
        found_.push_back(texels_[face.begin + k]);
    }
  }
}

void NearSamples::run(const KernelInput& input, double largest, const RadiusOf& radius_of,
                      double slack, const Visit& visit) {
  gather(input);
  const Patch& patch = *input.patch;
  const Samples& targets = *input.targets;
  for (Index f = 0; f < patch.core_faces; ++f) {
    const Index begin = targets.face_offsets[patch.faces[f]],
                end = targets.face_offsets[patch.faces[f] + 1];
    if (begin == end) continue;
    find_faces(input, f, largest * slack);
    for (Index k = begin; k < end; ++k) {
      const Sample& target = targets.samples[k];
      const double radius = radius_of(target);
      if (!(radius > 0)) continue;
      const double variance = barycentric_variance(patch.lengths[f], barycentric(target));
      find_samples(*input.table, patch.corners[f], target, variance, radius * slack);
      visit(target, found_);
    }
  }
}

}  // namespace onmesh
