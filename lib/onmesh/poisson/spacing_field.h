// How far apart Poisson samples are, point by point (internal).
#pragma once

#include <array>
#include <vector>

#include "onmesh/mesh/triangle_mesh.h"
#include "onmesh/poisson/face_frame.h"

namespace onmesh {

class TexelMap;

/// Samples per spacing^2 in a maximal random set on a plane: discs added at random jam at a
/// coverage of 0.547 (Feder, "Random sequential adsorption", 1980), which is that over the area pi
/// / 4 of a disc of diameter 1.
inline constexpr double kPoissonDensity = 0.6965;

/// A spacing r(x) in mesh units: constant, or graded by the size of the texels. Graded it is
///
///     r(x) = min over faces g with texels of  disc(g) + slope * |x - g|
///
/// with distances in space; disc(g) is the radius of the disc inscribed in a texel on face g. A
/// maximal set puts a sample into every disc of that radius, so into every such texel. Texels more
/// than 16 times as long as wide count as 16 times as long as wide, else their number of samples
/// would grow with that. The field is Lipschitz continuous, also over seams where the size of the
/// texels jumps, and no coarser than the texels near by, whichever side of a sheet they are on.
class SpacingField {
 public:
  static constexpr double kSlope = 0.4;

  /// The same everywhere.
  /// \param spacing mesh units, > 0
  explicit SpacingField(double spacing);
  /// Graded.
  /// \pre mesh and map belong together; the mesh outlives this
  /// \throw InputError if no texel lies on the surface
  SpacingField(const TriangleMesh& mesh, const TexelMap& map);

  /// Whether it may differ from place to place.
  bool graded() const { return least_ < largest_; }
  double least() const { return least_; }
  double largest() const { return largest_; }
  double slope() const { return graded() ? kSlope : 0; }
  /// No spacing on the face is larger.
  double most(Index face) const { return discs_.empty() ? largest_ : discs_[face]; }
  /// At a point of the face.
  double at(Index face, const Vec3& position) const;
  /// What a source (a face with texels) limits the spacing to at a point.
  double limit(Index source, const Vec3& position) const;

  /// Sources other than the face itself that may limit the spacing below most(face) somewhere in a
  /// cell of it.
  std::vector<Index> sources_near(const FaceFrame& frame, const Cell& cell) const;

  /// Number of samples of a maximal set, about.
  /// \param faces to sample, each with area
  double expected_samples(const TriangleMesh& mesh, const std::vector<Index>& faces) const;

 private:
  // A box around sources_[first, last), with the least disc among them. An inner node's children
  // follow it: the first at once, the second at `second`.
  struct Node {
    Vec3 low, high;
    double least;
    Index first, last, second;  // second == 0: a leaf
  };
  void build(Index first, Index last);
  template <class Within, class Visit>
  void visit(const Within& within, const Visit& visit) const;

  const TriangleMesh* mesh_ = nullptr;
  double least_, largest_;
  std::vector<double> discs_;  // per face; the largest on faces without texels
  std::vector<Index> sources_;
  std::vector<Node> nodes_;
};

/// The spacing over a cell of a face: bounds, and the sources that matter in it.
class CellSpacing {
 public:
  double centre = 0, low = 0, high = 0;

  /// Looks at the cell and adds to `kept` those of `count` sources that matter in it.
  /// \return whether any is left: else the spacing is most(face) all over the cell
  bool bound(const SpacingField& field, const FaceFrame& frame, const Cell& cell,
             const Index* sources, std::size_t count, std::vector<Index>* kept = nullptr);

 private:
  std::vector<double> limits_;
};

}  // namespace onmesh
