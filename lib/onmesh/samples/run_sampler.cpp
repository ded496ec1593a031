#include "onmesh/samples/run_sampler.h"

#include <algorithm>

#include "onmesh/samples/make_sample.h"

namespace onmesh {

SamplePlaces::SamplePlaces(const Overlay& overlay, const std::vector<Index>& counts,
                           Index node_faces, std::vector<Index>& face_offsets)
    : first_(overlay.pieces.size()), next_(overlay.pieces.size(), 0) {
  std::vector<Index> newest(node_faces, kNone);
  face_offsets.assign(node_faces + 1, 0);
  for (Index f = 0; f + 1 < overlay.face_offsets.size(); ++f) {
    const Index begin = overlay.face_offsets[f];
    for (Index p = begin; p < overlay.face_offsets[f + 1]; ++p) {
      const Index node_face = overlay.pieces[p].node_face;
      Index& known = newest[node_face];
      if (known == kNone || known < begin) {
        known = p;
        next_[p] = face_offsets[node_face + 1];
      }
      first_[p] = known;
      face_offsets[node_face + 1] += counts[p];
    }
  }
  for (Index f = 0; f < node_faces; ++f) face_offsets[f + 1] += face_offsets[f];
  for (Index p = 0; p < next_.size(); ++p) next_[p] += face_offsets[overlay.pieces[p].node_face];
}

void RunSampler::run(const LargeArray<Index>& piece_of, SamplePlaces& places,
                     Sample* samples) const {
  const Index end = map_.face_offsets[face_ + 1];
  for (Index begin = map_.face_offsets[face_], beyond; begin < end; begin = beyond) {
    const Index piece = piece_of[begin];
    const auto row = map_.claims[begin].y;
    beyond = begin + 1;
    while (beyond < end && piece_of[beyond] == piece && map_.claims[beyond].y == row) ++beyond;
    Sample* const out = samples + places.advance(piece, beyond - begin);
    // Barycentric coordinates are linear: if both ends lie in the face, all claims do.
    if (least(begin) >= 0 && least(beyond - 1) >= 0) {
      sample_inside(begin, beyond, overlay_.pieces[piece].to_node, out);
    } else {
      sample_clamped(begin, beyond, overlay_.pieces[piece].to_node, out);
    }
  }
}

/// Barycentric coordinates in the input face, not clamped.
Vec3 RunSampler::barycentric(Index claim) const {
  const TexelClaim& at = map_.claims[claim];
  return map_.to_barycentric(face_) * Vec3(at.x + 0.5, at.y + 0.5, 1);
}

void RunSampler::sample_clamped(Index begin, Index end, const Eigen::Matrix3d& to_node,
                                Sample* out) const {
  for (Index i = begin; i < end; ++i) {
    const Vec3 at = to_node * map_.barycentric(face_, map_.claims[i]);
    *out++ = make_sample(map_.tile_of(face_).texel(map_.claims[i]), at, map_.texel_area[face_]);
  }
}

/// The same a step at a time: coordinates grow by the same amount from texel to texel.
void RunSampler::sample_inside(Index begin, Index end, const Eigen::Matrix3d& to_node,
                               Sample* out) const {
  const TexelClaim* const claims = map_.claims.data() + begin;
  const TexelTile tile = map_.tile_of(face_);
  const Index count = end - begin;
  const int left = claims[0].x;
  const Vec3 start = to_node * barycentric(begin),
             slope = to_node * map_.to_barycentric(face_).col(0);
  const Index texel = tile.texel(claims[0]);
  const auto area = static_cast<float>(map_.texel_area[face_]);
  for (Index i = 0; i < count; ++i) {
    const int columns = claims[i].x - left;
    const double b0 = std::max(start[0] + slope[0] * columns, 0.0),
                 b1 = std::max(start[1] + slope[1] * columns, 0.0),
                 b2 = std::max(start[2] + slope[2] * columns, 0.0);
    const double scale = 1 / (b0 + b1 + b2);
    out[i] = {texel + static_cast<Index>(columns), static_cast<float>(b1 * scale),
              static_cast<float>(b2 * scale), area};
  }
  if (left >= 0 && claims[count - 1].x < tile.width) return;
  for (Index i = 0; i < count; ++i) out[i].texel = tile.texel(claims[i]);
}

}  // namespace onmesh
