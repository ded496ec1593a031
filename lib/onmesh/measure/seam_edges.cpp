#include "onmesh/measure/seam_edges.h"

#include <algorithm>
#include <cmath>

#include "onmesh/base/error.h"
#include "onmesh/base/parallel.h"

namespace onmesh {
namespace {

/// A side's image, and how UVs beyond it are read.
struct Side {
  const Image& image;
  WrapModes wrap;

  double pixels(const Vec2& from, const Vec2& to) const {
    return (to - from).cwiseProduct(Vec2(image.width, image.height)).norm();
  }
};

/// Fill in the seam's length and error.
void measure(const TriangleMesh& mesh, const Side& one_side, const Side& other_side,
             MeasuredSeam& seam) {
  const Index f = seam.face(), g = seam.other_face();
  const std::size_t a = seam.side % 3, b = (a + 1) % 3, c = seam.other_side % 3, d = (c + 1) % 3;
  const auto u = mesh.corner_uvs(f), v = mesh.corner_uvs(g);
  const Vec2 &u0 = u[a], &u1 = u[b], &v0 = v[seam.opposed ? d : c], &v1 = v[seam.opposed ? c : d];
  seam.length = (mesh.positions[mesh.faces[f][b]] - mesh.positions[mesh.faces[f][a]]).norm();
  const double pixels = std::max(one_side.pixels(u0, u1), other_side.pixels(v0, v1));
  const int points = int(std::ceil(std::min(2 * pixels, 1e6))) + 1;
  const auto channels = std::size_t(one_side.image.channels);
  std::vector<float> one(channels), two(channels);
  for (int p = 0; p < points; ++p) {
    const double t = points > 1 ? p / (points - 1.0) : 0.5;
    bilinear(one_side.image, one_side.wrap, (1 - t) * u0 + t * u1, one.data());
    bilinear(other_side.image, other_side.wrap, (1 - t) * v0 + t * v1, two.data());
    for (std::size_t ch = 0; ch < channels; ++ch) {
      if (one[ch] == two[ch] || !std::isfinite(one[ch]) || !std::isfinite(two[ch])) continue;
      const double e = std::abs(double(one[ch]) - double(two[ch]));
      seam.mean_square += e * e / (double(points) * double(channels));
      seam.max = std::max(seam.max, e);
    }
  }
}

}  // namespace

std::vector<MeasuredSeam> measure_seams(const TriangleMesh& mesh, const TexelMap& map,
                                        const std::vector<const Image*>& images) {
  for (std::size_t i = 0; i < map.tiles.size(); ++i) {
    if (map.tiles[i].width != images[i]->width || map.tiles[i].height != images[i]->height)
      throw InputError("the texel map is not of the image's size");
  }
  std::vector<MeasuredSeam> seams;
  for (const Seam& seam : find_seams(mesh, map)) seams.push_back({seam});
  parallel_over(seams.size(), [&](std::size_t i) {
    const auto side = [&](Index face) {
      return Side{*images[map.tile_number(face)], map.tile_of(face).wrap};
    };
    measure(mesh, side(seams[i].face()), side(seams[i].other_face()), seams[i]);
  });
  return seams;
}

}  // namespace onmesh
