// Samples of texels that lie side by side (internal).
#pragma once

#include <vector>

#include "onmesh/samples/samples.h"

namespace onmesh {

/// Where the samples of each piece go, and the offsets of all node faces. Pieces of one input face
/// in one node face share a place, so that their samples stay in the order of the texels.
class SamplePlaces {
 public:
  /// \param counts samples per piece
  /// \param face_offsets receives the offsets: node_faces + 1
  SamplePlaces(const Overlay& overlay, const std::vector<Index>& counts, Index node_faces,
               std::vector<Index>& face_offsets);

  /// The place of the piece's next `count` samples. Input faces may be in use at the same time.
  Index advance(Index piece, Index count) { return (next_[first_[piece]] += count) - count; }

 private:
  std::vector<Index> first_;  // per piece: whose place it shares
  std::vector<Index> next_;
};

/// Makes the samples of one input face, in runs of claims of one row and piece.
class RunSampler {
 public:
  /// \pre map and overlay are of the same mesh and outlive this
  RunSampler(const TexelMap& map, const Overlay& overlay, Index face)
      : map_(map), overlay_(overlay), face_(face) {}

  /// \param piece_of one per claim of the map
  void run(const LargeArray<Index>& piece_of, SamplePlaces& places, Sample* samples) const;

 private:
  Vec3 barycentric(Index claim) const;
  double least(Index claim) const { return barycentric(claim).minCoeff(); }
  void sample_clamped(Index begin, Index end, const Eigen::Matrix3d& to_node, Sample* out) const;
  void sample_inside(Index begin, Index end, const Eigen::Matrix3d& to_node, Sample* out) const;

  const TexelMap& map_;
  const Overlay& overlay_;
  const Index face_;
};

}  // namespace onmesh
