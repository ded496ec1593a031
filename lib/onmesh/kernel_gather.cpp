#include "onmesh/kernel_gather.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace onmesh {
namespace {

Vec3 barycentric(const Sample& s) { return {1.0 - s.b1 - s.b2, s.b1, s.b2}; }

/// Which faces of the patch can hold a sample within reach of one of the work's targets.
std::vector<unsigned char> find_faces_near(const KernelInput& input, const KernelWork& work) {
  const DistanceTable& table = *input.table;
  std::vector<unsigned char> is_corner(table.rows, 0);
  for (const KernelWork::Target& target : work.targets)
    for (const Index corner : target.corners) is_corner[corner] = 1;
  std::vector<float> nearest(table.columns, kUnreachable);
  for (Index corner = 0; corner < table.rows; ++corner) {
    if (!is_corner[corner]) continue;
    const float* const row = table.row(corner);
    for (Index n = 0; n < table.columns; ++n) nearest[n] = std::min(nearest[n], row[n]);
  }
  std::vector<unsigned char> is_near(input.patch->corners.size());
  for (std::size_t f = 0; f < is_near.size(); ++f) {
    const auto& n = input.patch->corners[f];
    is_near[f] = std::max({nearest[n[0]], nearest[n[1]], nearest[n[2]]}) <= work.reach_squared;
  }
  return is_near;
}

/// \param is_needed per local face; empty: all are
void gather_samples(const KernelInput& input, double variance_scale,
                    const std::vector<unsigned char>& is_needed, KernelWork& work) {
  const Patch& patch = *input.patch;
  const Samples& sources = *input.sources;
  const Colours& colours = input.colours;

  float largest_area = 0;
  std::size_t count = 0;
  for (const Index f : patch.faces) {
    for (Index k = sources.face_offsets[f]; k < sources.face_offsets[f + 1]; ++k) {
      largest_area = std::max(largest_area, sources.samples[k].area);
    }
    count += sources.face_offsets[f + 1] - sources.face_offsets[f];
  }
  work.faces.clear();
  work.records.resize(count * work.stride());

  float* record = work.records.data();
  std::size_t used = 0;
  float last_share = 1, log_area = 0;  // most neighbours stand for the same area
  for (std::size_t local = 0; local < patch.faces.size(); ++local) {
    if (!is_needed.empty() && !is_needed[local]) continue;
    const Index f = patch.faces[local];
    KernelWork::Face face;
    face.corners = patch.corners[local];
    face.begin = used;
    for (Index k = sources.face_offsets[f]; k < sources.face_offsets[f + 1]; ++k) {
      const Sample& s = sources.samples[k];
      const float* const colour =
          colours.values + std::size_t(s.texel) * std::size_t(colours.stride);
      const float share = s.area / largest_area;
      if (!(share > 0) || !is_usable(colour, work.channels, work.colour_scale)) continue;
      if (share != last_share) {
        last_share = share;
        log_area = std::log2(share);
      }
      const auto variance = static_cast<float>(
          variance_scale * barycentric_variance(patch.lengths[local], barycentric(s)));
      record[0] = s.b1;
      record[1] = s.b2;
      record[2] = variance + log_area;
      record[3] = log_area;
      record[4] = work.limit + log_area;
      for (int c = 0; c < work.channels; ++c) {
        record[KernelWork::kFixed + std::size_t(c)] = colour[c] * work.colour_scale;
      }
      record += work.stride();
      ++used;
      face.slack = std::max(face.slack, variance);
    }
    face.end = used;
    if (face.end > face.begin) work.faces.push_back(face);
  }
}

/// The core faces that have targets, each next to its predecessor where possible, so that the
/// targets that share a vector lie close together and need the same samples.
std::vector<Index> neighbourly_order(const Patch& patch, const Samples& targets) {
  std::vector<std::vector<Index>> faces_of_node(patch.core_nodes);
  std::vector<bool> waiting(patch.core_faces, false);
  for (Index f = 0; f < patch.core_faces; ++f) {
    const Index global = patch.faces[f];
    if (targets.face_offsets[global] == targets.face_offsets[global + 1]) continue;
    waiting[f] = true;
    for (const Index n : patch.corners[f]) faces_of_node[n].push_back(f);
  }
  std::vector<Index> order;
  for (Index start = 0; start < patch.core_faces; ++start) {
    Index next = waiting[start] ? start : kNone;
    while (next != kNone) {
      order.push_back(next);
      waiting[next] = false;
      const auto corners = patch.corners[next];
      next = kNone;
      int most_shared = 0;
      for (const Index n : corners) {
        for (const Index candidate : faces_of_node[n]) {
          if (!waiting[candidate]) continue;
          int shared = 0;
          for (const Index a : patch.corners[candidate]) {
            shared += int(std::count(corners.begin(), corners.end(), a));
          }
          if (shared > most_shared || (shared == most_shared && candidate < next)) {
            most_shared = shared;
            next = candidate;
          }
        }
      }
    }
  }
  return order;
}

void gather_targets(const KernelInput& input, double variance_scale, KernelWork& work,
                    std::vector<float>& out) {
  const Patch& patch = *input.patch;
  const Samples& targets = *input.targets;
  const Colours& colours = input.colours;

  std::vector<Index> first_slot(patch.core_faces + 1, 0);
  for (Index f = 0; f < patch.core_faces; ++f) {
    const Index global = patch.faces[f];
    first_slot[f + 1] =
        first_slot[f] + targets.face_offsets[global + 1] - targets.face_offsets[global];
  }
  work.kept = 0;
  out.resize(first_slot.back() * std::size_t(work.channels));
  work.targets.clear();
  work.target_colours.clear();
  if (!input.only) {
    work.targets.reserve(first_slot.back());
    work.target_colours.reserve(out.size());
  }

  for (const Index f : neighbourly_order(patch, targets)) {
    const Index begin = targets.face_offsets[patch.faces[f]];
    for (Index slot = first_slot[f]; slot < first_slot[f + 1]; ++slot) {
      if (input.only && !(*input.only)[slot]) continue;
      const Sample& s = targets.samples[begin + slot - first_slot[f]];
      const float* colour = colours.values + std::size_t(s.texel) * std::size_t(colours.stride);
      if (!is_usable(colour, work.channels, work.colour_scale)) {
        std::copy_n(colour, work.channels, out.begin() + std::ptrdiff_t(slot) * work.channels);
        ++work.kept;
        continue;
      }
      const Vec3 a = barycentric(s);
      KernelWork::Target target;
      target.corners = patch.corners[f];
      for (int i = 0; i < 3; ++i) target.barycentric[i] = static_cast<float>(a[i]);
      target.variance =
          static_cast<float>(variance_scale * barycentric_variance(patch.lengths[f], a));
      target.face = f;
      target.slot = slot;
      target.texel = s.texel;
      work.targets.push_back(target);
      for (int c = 0; c < work.channels; ++c) {
        work.target_colours.push_back(colour[c] * work.colour_scale);
      }
    }
  }
}

}  // namespace

bool is_usable(const float* colour, int channels, float scale) {
  // Scaled colours beyond this would overflow when squared and summed.
  constexpr float kLargest = 1e15F;
  return std::all_of(colour, colour + channels,
                     [scale](float c) { return std::abs(c * scale) < kLargest; });
}

void gather(const KernelInput& input, const KernelOptions& options, KernelWork& work,
            std::vector<float>& out) {
  assert(options.sigma_spatial > 0 && options.radius > 0 && options.sigma_range >= 0);
  assert(input.table->rows >= input.patch->core_nodes);
  assert(input.table->columns == input.patch->nodes.size());

  work.channels = input.colours.channels;
  const double half_log2e = 0.5 * std::numbers::log2e;
  const double scale = half_log2e / (options.sigma_spatial * options.sigma_spatial);
  work.distance_scale = static_cast<float>(-scale);
  // On regular grids many pairs tie at the radius; rounding must not decide about them.
  work.limit = static_cast<float>(-scale * options.radius * options.radius * (1 + 1e-5));
  const double reach =
      options.radius * std::sqrt(1 + 1e-5) + 2 * input.patch->longest_edge * (1 + 1e-6);
  work.reach_squared = static_cast<float>(reach * reach);
  work.range_channels = 0;
  work.colour_scale = 1;
  if (options.sigma_range > 0) {
    work.range_channels = input.colours.range_channels;
    work.colour_scale = static_cast<float>(std::sqrt(half_log2e) / options.sigma_range);
  }
  gather_targets(input, scale, work, out);
  gather_samples(input, scale,
                 input.only ? find_faces_near(input, work) : std::vector<unsigned char>(), work);
}

}  // namespace onmesh
