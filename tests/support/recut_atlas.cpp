#include "support/recut_atlas.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <utility>

#include "onmesh/base/disjoint_sets.h"
#include "onmesh/base/error.h"
#include "onmesh/base/plane.h"
#include "onmesh/base/random.h"

namespace onmesh {
namespace {

constexpr int kPadding = 4;        // texels between charts
constexpr double kCutShare = 0.4;  // of the edges that may be cut
constexpr double kSnap = 1e-9;     // texels; UVs this close to a texel corner are on it

using Corners = std::array<Vec2, 3>;

// UVs in pixel coordinates: x right, y down, texel centres at +.5.
Corners pixel_corners(const TriangleMesh& mesh, const Image& image, Index face) {
  Corners corners = mesh.corner_uvs(face);
  for (Vec2& p : corners) {
    p = Vec2(p.x() * image.width, (1 - p.y()) * image.height);
    for (int k = 0; k < 2; ++k) {
      if (std::abs(p[k] - std::round(p[k])) < kSnap) p[k] = std::round(p[k]);
    }
  }
  return corners;
}

bool between_texels(const Vec2& a, const Vec2& b) {
  for (int k = 0; k < 2; ++k) {
    if (a[k] == b[k] && a[k] == std::round(a[k])) return true;
  }
  return false;
}

// Chart number per face after random cuts.
NumberedSets random_charts(const TriangleMesh& mesh, const std::vector<Corners>& corners,
                           std::uint64_t seed) {
  // Faces that meet in an edge with equal UVs at both ends.
  using Edge = std::array<Index, 4>;
  std::map<Edge, std::vector<std::pair<Index, int>>> faces_of_edge;
  for (Index face = 0; face < mesh.faces.size(); ++face) {
    for (int k = 0; k < 3; ++k) {
      const auto from = std::pair(mesh.faces[face][k], mesh.face_uvs[face][k]);
      const auto to = std::pair(mesh.faces[face][(k + 1) % 3], mesh.face_uvs[face][(k + 1) % 3]);
      const auto [low, high] = std::minmax(from, to);
      faces_of_edge[{low.first, low.second, high.first, high.second}].emplace_back(face, k);
    }
  }
  DisjointSets groups(mesh.faces.size());
  std::uint64_t number = 0;
  for (const auto& [edge, faces] : faces_of_edge) {
    const auto [face, k] = faces.front();
    const bool may_cut = between_texels(corners[face][k], corners[face][(k + 1) % 3]);
    if (may_cut && random_unit_at(seed, number++) < kCutShare) continue;
    for (const auto& [other, unused] : faces) groups.join(face, other);
  }
  std::vector<Index> roots;
  for (Index face = 0; face < mesh.faces.size(); ++face) roots.push_back(groups.find(face));
  return number_sets(std::move(roots));
}

// A chart's box of texels, how often it is turned clockwise, and where the turned box goes.
struct Placement {
  int x0 = 0, y0 = 0, width = 0, height = 0;
  int turns = 0, to_x = 0, to_y = 0;

  int turned_width() const { return turns % 2 == 0 ? width : height; }
  int turned_height() const { return turns % 2 == 0 ? height : width; }
  // Only additions of integers and exact differences: corners on texel corners stay there.
  Vec2 operator()(const Vec2& p) const {
    const double x = p.x() - x0, y = p.y() - y0;
    switch (turns) {
      case 0:
        return {to_x + x, to_y + y};
      case 1:
        return {to_x + (height - y), to_y + x};
      case 2:
        return {to_x + (width - x), to_y + (height - y)};
      default:
        return {to_x + y, to_y + (width - x)};
    }
  }
};

struct Size {
  int width, height;
};

// Shelf packing, highest charts first. Returns the atlas's size.
Size pack(std::vector<Placement>& charts) {
  std::vector<Index> order(charts.size());
  std::iota(order.begin(), order.end(), Index(0));
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) {
    return charts[a].turned_height() > charts[b].turned_height();
  });
  double area = 0;
  int widest = 0;
  for (const Placement& chart : charts) {
    area += double(chart.width + kPadding) * (chart.height + kPadding);
    widest = std::max(widest, chart.turned_width());
  }
  const int width = std::max(widest, int(1.1 * std::sqrt(area))) + 2 * kPadding;
  int x = kPadding, y = kPadding, shelf = 0;
  for (const Index i : order) {
    Placement& chart = charts[i];
    if (x + chart.turned_width() + kPadding > width) {
      x = kPadding;
      y += shelf + kPadding;
      shelf = 0;
    }
    chart.to_x = x, chart.to_y = y;
    x += chart.turned_width() + kPadding;
    shelf = std::max(shelf, chart.turned_height());
  }
  return {width, y + shelf + kPadding};
}

// Calls visit(x, y) for the texels whose centre lies in or on the triangle.
template <typename Visit>
void for_centres(const Corners& p, const Visit& visit) {
  const Vec2 low = p[0].cwiseMin(p[1]).cwiseMin(p[2]), high = p[0].cwiseMax(p[1]).cwiseMax(p[2]);
  for (int y = int(std::floor(low.y())); y < high.y(); ++y) {
    for (int x = int(std::floor(low.x())); x < high.x(); ++x) {
      const Vec2 q(x + 0.5, y + 0.5);
      const double a = twice_area(p[0], p[1], q), b = twice_area(p[1], p[2], q),
                   c = twice_area(p[2], p[0], q);
      const double tolerance = 1e-9 * ((high - low).maxCoeff() + 1);
      if (std::min({a, b, c}) >= -tolerance || std::max({a, b, c}) <= tolerance) visit(x, y);
    }
  }
}

// Corners of all faces in pixels; refuses what cannot be cut.
std::vector<Corners> all_corners(const TriangleMesh& mesh, const Image& image) {
  std::vector<Corners> corners(mesh.faces.size());
  for (Index face = 0; face < mesh.faces.size(); ++face) {
    const std::string name = "recut_atlas: face " + std::to_string(face);
    if (!mesh.has_uvs(face)) throw InputError(name + " has no UVs");
    corners[face] = pixel_corners(mesh, image, face);
    for (const Vec2& p : corners[face]) {
      if (!(p.minCoeff() >= 0 && p.x() <= image.width && p.y() <= image.height))
        throw InputError(name + " reaches beyond [0,1] in UVs");
    }
  }
  return corners;
}

// Boxes in whole texels, turned at random.
std::vector<Placement> box_charts(const std::vector<Corners>& corners, const NumberedSets& charts,
                                  const Image& image, std::uint64_t seed) {
  std::vector<Placement> placements(charts.count);
  std::vector<std::array<int, 4>> boxes(charts.count, {image.width, image.height, 0, 0});
  for (Index face = 0; face < corners.size(); ++face) {
    auto& [x0, y0, x1, y1] = boxes[charts.numbers[face]];
    for (const Vec2& p : corners[face]) {
      x0 = std::min(x0, int(std::floor(p.x()))), y0 = std::min(y0, int(std::floor(p.y())));
      x1 = std::max(x1, int(std::ceil(p.x()))), y1 = std::max(y1, int(std::ceil(p.y())));
    }
  }
  for (Index i = 0; i < charts.count; ++i) {
    const auto [x0, y0, x1, y1] = boxes[i];
    placements[i] = {x0, y0, x1 - x0, y1 - y0, int(random_bits_at(seed, 2, i) % 4)};
  }
  return placements;
}

}  // namespace

RecutAtlas recut_atlas(const TriangleMesh& mesh, const Image& image, std::uint64_t seed) {
  const std::vector<Corners> corners = all_corners(mesh, image);
  if (mesh.faces.empty()) throw InputError("recut_atlas: the mesh has no faces");
  const NumberedSets charts = random_charts(mesh, corners, random_bits_at(seed, 1));
  std::vector<Placement> placements = box_charts(corners, charts, image, seed);
  const Size size = pack(placements);
  RecutAtlas result;
  result.mesh = mesh;
  result.charts = charts.count;

  // UVs: one per old UV and chart.
  result.mesh.uvs.clear();
  std::map<std::pair<Index, Index>, Index> new_uv;
  for (Index face = 0; face < mesh.faces.size(); ++face) {
    const Index chart = charts.numbers[face];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [entry, is_new] =
          new_uv.try_emplace({mesh.face_uvs[face][k], chart}, Index(result.mesh.uvs.size()));
      if (is_new) {
        const Vec2 p = placements[chart](corners[face][k]);
        result.mesh.uvs.emplace_back(p.x() / size.width, 1 - p.y() / size.height);
      }
      result.mesh.face_uvs[face][k] = entry->second;
    }
  }

  // Values, by texel centres. Whatever no chart holds is noise: reading it must show.
  result.image = make_image(size.width, size.height, image.channels);
  result.image.alpha_channel = image.alpha_channel;
  for (std::size_t i = 0; i < result.image.pixels.size(); ++i) {
    result.image.pixels[i] = float(random_unit_at(seed, 3, i));
  }
  result.new_texel.assign(std::size_t(image.width) * std::size_t(image.height), kNone);
  for (Index face = 0; face < mesh.faces.size(); ++face) {
    const Placement& placement = placements[charts.numbers[face]];
    for_centres(corners[face], [&](int x, int y) {
      const Vec2 q = placement(Vec2(x + 0.5, y + 0.5));
      const auto from = Index(y) * Index(image.width) + Index(x);
      const auto to = Index(q.y()) * Index(size.width) + Index(q.x());
      if (result.new_texel[from] != kNone) return;
      result.new_texel[from] = to;
      std::copy_n(image.texel(from), image.channels, result.image.texel(to));
    });
  }
  return result;
}

}  // namespace onmesh
