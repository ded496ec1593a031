// What is near a texel within its own face.
#pragma once

#include <vector>

#include "onmesh/atlas/texel_places.h"
#include "onmesh/filter/prepare_mesh.h"
#include "onmesh/samples/samples.h"

namespace onmesh {

/// Texels that have one place on the surface, by the face that they lie on.
class FaceNeighbours {
 public:
  /// \param samples texels, of which those count that have an area
  /// \pre prepared outlives this
  FaceNeighbours(const PreparedMesh& prepared, const Samples& samples);

  /// Offsets of the texels within a radius on one face. One object per thread.
  struct Offsets {
    Index face = kNone;
    double radius = 0;
    Vec3 margins;  ///< least barycentric coordinates of texels that are the radius from all edges
    std::vector<TexelClaim> steps;  ///< columns and rows, without the texel itself
    int most_x = 0, most_y = 0;     ///< of those
  };

  /// The texels within a radius of one, if its face holds them all.
  /// \param offsets kept from call to call
  /// \return false if it does not: `near` is of no use then
  bool find(Index texel, double radius, Offsets& offsets, std::vector<Index>& near) const;

 private:
  void list_steps(Index face, double radius, Offsets& offsets) const;

  const PreparedMesh& prepared_;
  TexelPlaces places_;
  std::vector<unsigned char> counted_;  ///< per texel: how many samples with an area, up to 2
};

}  // namespace onmesh
