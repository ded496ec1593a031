#include "onmesh/measure/seam_residual.h"

#include <cmath>

#include "onmesh/atlas/texel_lookup.h"
#include "onmesh/base/error.h"
#include "onmesh/base/triangle.h"
#include "onmesh/image/texel_values.h"
#include "onmesh/measure/seams.h"

namespace onmesh {
namespace {

class Residual {
 public:
  Residual(const TriangleMesh& mesh, const TexelMap& map, const std::vector<const Image*>& a,
           const std::vector<const Image*>& b, const std::vector<bool>& counted)
      : mesh_(mesh), map_(map), counted_(counted), lookup_(map), places_(map) {
    for (const Image* image : a) a_.add(*image);
    for (const Image* image : b) b_.add(*image);
  }

  void add_edge(const Seam& seam, double& squares, std::size_t& pairs) const {
    const Index f = seam.face(), g = seam.other_face();
    const double length = (corner(f, seam.side % 3 + 1) - corner(f, seam.side % 3)).norm();
    const double texel = std::sqrt(std::max(map_.texel_area[f], map_.texel_area[g]));
    const auto points = std::size_t(std::ceil(std::min(2 * length / texel, 1e6)));
    for (std::size_t p = 0; p < points; ++p) {
      const double t = (double(p) + 0.5) / double(points);
      const Place one = beside(seam.side, t);
      const Place two = beside(seam.other_side, seam.opposed ? 1 - t : t);
      for (int c = 0; c < a_.channels(); ++c) {
        const double error =
            (mean(a_, one, c) - mean(a_, two, c)) - (mean(b_, one, c) - mean(b_, two, c));
        if (!std::isfinite(error)) continue;
        squares += error * error;
        ++pairs;
      }
    }
  }

 private:
  Vec3 corner(Index face, Index k) const { return mesh_.positions[mesh_.faces[face][k % 3]]; }

  bool counts(Index texel) const { return counted_.empty() || counted_[texel]; }

  /// What is looked up on one side.
  struct Place {
    Index face;
    LookupTexels around;
  };

  /// Half a texel inside a face, beside a point of its edge.
  Place beside(Index side, double t) const {
    const Index face = side / 3, k = side % 3;
    const Vec3 a = corner(face, k), b = corner(face, k + 1), c = corner(face, k + 2);
    const Vec3 along = b - a;
    // Barycentric coordinates of the point on the edge, moved towards corner c at a right angle.
    const double foot = (c - a).dot(along) / along.squaredNorm();
    const double height = (c - a - foot * along).norm();
    const double inside = 0.5 * std::sqrt(map_.texel_area[face]) / height;
    std::array<double, 3> weights{};
    weights[(k + 2) % 3] = inside;
    weights[(k + 1) % 3] = t - inside * foot;
    weights[k] = 1 - inside - weights[(k + 1) % 3];
    const Vec2 uv = interpolate(mesh_.corner_uvs(face), Vec3(weights[0], weights[1], weights[2]));
    const TexelTile tile = map_.tile_of(face);
    return {face,
            lookup_.around(face, {uv.x() * tile.width - 0.5, (1 - uv.y()) * tile.height - 0.5})};
  }

  /// Not a number if none of the face's own texels counts there. Those of the next face are left
  /// out, as at a seam there are none: else means would be over fewer texels there.
  double mean(const ConstTexelValues& values, const Place& at, int channel) const {
    double sum = 0, weight = 0;
    for (std::size_t k = 0; k < std::size_t(at.around.count); ++k) {
      const Index texel = at.around.texels[k];
      if (places_.face(texel) != at.face || !counts(texel)) continue;
      sum += double(at.around.weights[k]) * values[texel][channel];
      weight += at.around.weights[k];
    }
    return sum / weight;
  }

  const TriangleMesh& mesh_;
  const TexelMap& map_;
  const std::vector<bool>& counted_;
  const TexelLookup lookup_;
  const TexelPlaces places_;
  ConstTexelValues a_, b_;
};

bool is_fold(const TriangleMesh& mesh, const Seam& seam) {
  const auto normal = [&](Index face) {
    const auto corner = mesh.corners(face);
    return (corner[1] - corner[0]).cross(corner[2] - corner[0]).stableNormalized();
  };
  const double cosine = normal(seam.face()).dot(normal(seam.other_face()));
  constexpr double kCosine = 0.8660254;  // of 30 degrees
  return (seam.opposed ? cosine : -cosine) < kCosine;
}

}  // namespace

SeamResidual seam_residual(const TriangleMesh& mesh, const TexelMap& map,
                           const std::vector<const Image*>& a, const std::vector<const Image*>& b,
                           const std::vector<bool>& counted) {
  for (std::size_t i = 0; i < map.tiles.size(); ++i) {
    for (const Image* image : {a[i], b[i]}) {
      if (map.tiles[i].width != image->width || map.tiles[i].height != image->height)
        throw InputError("the texel map is not of the image's size");
    }
  }
  const Residual residual(mesh, map, a, b, counted);
  SeamResidual result;
  double at_seams = 0, at_folds = 0, inside = 0;
  for (const Seam& seam : find_seams(mesh, map)) {
    if (is_fold(mesh, seam)) {
      residual.add_edge(seam, at_folds, result.at_folds);
    } else {
      residual.add_edge(seam, at_seams, result.at_seams);
    }
  }
  for (const Seam& edge : find_chart_edges(mesh, map))
    if (!is_fold(mesh, edge)) residual.add_edge(edge, inside, result.within);
  const auto root = [](double squares, std::size_t count) {
    return count > 0 ? std::sqrt(squares / double(count)) : 0;
  };
  result.seams = root(at_seams, result.at_seams);
  result.folds = root(at_folds, result.at_folds);
  result.inside = root(inside, result.within);
  return result;
}

}  // namespace onmesh
