#include "onmesh/distance/cloud/tufted_cover.h"

#include <algorithm>
#include <tuple>

#include "onmesh/base/triangle.h"
#include "onmesh/nodes/half_edges.h"

namespace onmesh::cloud {
namespace {

// A side of an edge in the cover: the half-edges of the two copies of one face that lie on it.
struct Side {
  Index low, high;          // nodes
  Index forward, backward;  // half-edges from low to high and from high to low
  Index face;
};

// Sorted by edge.
std::vector<Side> find_sides(const Patch& complex) {
  std::vector<Side> sides;
  sides.reserve(3 * complex.corners.size());
  for (Index f = 0; f < complex.corners.size(); ++f)
    for (Index k = 0; k < 3; ++k) {
      // The back's corners are the front's 0, 2, 1, so its half-edge 2 - k is the reverse of k.
      const Index a = complex.corners[f][k], b = complex.corners[f][(k + 1) % 3];
      const Index front = 6 * f + k, back = 6 * f + 3 + (2 - k);
      sides.push_back(a <= b ? Side{a, b, front, back, f} : Side{b, a, back, front, f});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.forward) < std::tie(b.low, b.high, b.forward);
  });
  return sides;
}

HalfEdges make_cover(const Patch& complex, const std::vector<Side>& sides) {
  const std::size_t count = 6 * complex.corners.size();
  HalfEdges cover{std::vector<Index>(count), std::vector<Index>(count, kNone),
                  std::vector<double>(count)};
  for (Index f = 0; f < complex.corners.size(); ++f) {
    const auto& c = complex.corners[f];
    const auto& l = complex.lengths[f];
    for (Index k = 0; k < 3; ++k) {
      cover.tail[6 * f + k] = c[k];
      cover.length[6 * f + k] = l[k];
      cover.tail[6 * f + 3 + k] = c[(3 - k) % 3];
      cover.length[6 * f + 3 + k] = l[2 - k];
    }
  }
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].low == sides[begin].low &&
           sides[end].high == sides[begin].high)
      ++end;
    for (std::size_t i = begin; i < end; ++i) {
      const Index a = sides[i].forward, b = sides[i + 1 < end ? i + 1 : begin].backward;
      cover.twin[a] = b;
      cover.twin[b] = a;
    }
  }
  return cover;
}

// Whether any two faces of one edge, or one with its own back, make an edge that is not Delaunay.
bool is_delaunay(const Patch& complex, const std::vector<Side>& sides) {
  const auto cotangent = [&](const Side& s) {
    const auto& l = complex.lengths[s.face];
    const Index k = s.forward < 6 * s.face + 3 ? s.forward % 3 : s.backward % 3;
    const double a = l[(k + 1) % 3], b = l[(k + 2) % 3];
    return (a * a + b * b - l[k] * l[k]) / (4 * triangle_area(l[0], l[1], l[2]));
  };
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    double least = cotangent(sides[begin]), second = least;
    for (end = begin + 1; end < sides.size() && sides[end].low == sides[begin].low &&
                          sides[end].high == sides[begin].high;
         ++end) {
      const double c = cotangent(sides[end]);
      second = end == begin + 1 ? std::max(least, c) : std::clamp(c, least, second);
      least = std::min(least, c);
    }
    if (least + second < -1e-9) return false;
  }
  return true;
}

}  // namespace

std::vector<float> flip_tufted_cover(Patch& complex) {
  const std::vector<Side> sides = find_sides(complex);
  if (is_delaunay(complex, sides)) return {};
  HalfEdges cover = make_cover(complex, sides);
  std::vector<Index> all(cover.tail.size());
  for (Index h = 0; h < all.size(); ++h) all[h] = h;
  std::vector<bool> flipped(complex.corners.size(), false);
  cover.flip_to_delaunay(all, [&](Index h) {
    if (!cover.flip(h)) return false;
    flipped[h / 6] = flipped[cover.twin[h] / 6] = true;
    return true;
  });

  std::vector<float> weights(complex.corners.size(), 1);
  for (Index f = 0; f < flipped.size(); ++f) {
    if (!flipped[f]) continue;
    const auto copy = [&](Index h, std::array<Index, 3>& corner, std::array<double, 3>& lengths) {
      corner = {cover.tail[h], cover.tail[h + 1], cover.tail[h + 2]};
      lengths = {cover.length[h], cover.length[h + 1], cover.length[h + 2]};
    };
    copy(6 * f, complex.corners[f], complex.lengths[f]);
    copy(6 * f + 3, complex.corners.emplace_back(), complex.lengths.emplace_back());
    weights[f] = 0.5;
    weights.push_back(0.5);
  }
  return weights;
}

}  // namespace onmesh::cloud
