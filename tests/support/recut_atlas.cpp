#include "support/recut_atlas.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string>

#include "onmesh/base/error.h"
#include "onmesh/procedural/texture.h"

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

class UnionFind {
 public:
  explicit UnionFind(std::size_t size) : parent_(size) {
    std::iota(parent_.begin(), parent_.end(), Index(0));
  }
  Index find(Index i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(Index i, Index j) {
    i = find(i), j = find(j);
    parent_[std::max(i, j)] = std::min(i, j);
  }

 private:
  std::vector<Index> parent_;
};

// Chart number per face after random cuts.
std::vector<Index> random_charts(const TriangleMesh& mesh, const std::vector<Corners>& corners,
                                 std::uint64_t seed, Index& charts) {
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
  UnionFind groups(mesh.faces.size());
  std::uint64_t number = 0;
  for (const auto& [edge, faces] : faces_of_edge) {
    const auto [face, k] = faces.front();
    const bool may_cut = between_texels(corners[face][k], corners[face][(k + 1) % 3]);
    if (may_cut && hash_unit(seed, number++) < kCutShare) continue;
    for (const auto& [other, unused] : faces) groups.join(face, other);
  }
  std::vector<Index> chart(mesh.faces.size(), kNone);
  charts = 0;
  for (Index face = 0; face < chart.size(); ++face) {
    const Index root = groups.find(face);  // the lowest face of the group
    chart[face] = root == face ? charts++ : chart[root];
  }
  return chart;
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

// Shelf packing, highest charts first. Returns the atlas's size.
std::pair<int, int> pack(std::vector<Placement>& charts) {
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
  const auto side = [](const Vec2& a, const Vec2& b, const Vec2& q) {
    return (b - a).x() * (q - a).y() - (b - a).y() * (q - a).x();
  };
  for (int y = int(std::floor(low.y())); y < high.y(); ++y) {
    for (int x = int(std::floor(low.x())); x < high.x(); ++x) {
      const Vec2 q(x + 0.5, y + 0.5);
      const double a = side(p[0], p[1], q), b = side(p[1], p[2], q), c = side(p[2], p[0], q);
      const double tolerance = 1e-9 * ((high - low).maxCoeff() + 1);
      if (std::min({a, b, c}) >= -tolerance || std::max({a, b, c}) <= tolerance) visit(x, y);
    }
  }
}

}  // namespace

RecutAtlas recut_atlas(const TriangleMesh& mesh, const Image& image, std::uint64_t seed) {
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

  RecutAtlas result;
  result.mesh = mesh;
  const std::vector<Index> chart_of = random_charts(mesh, corners, hash(seed, 1), result.charts);
  if (mesh.faces.empty()) throw InputError("recut_atlas: the mesh has no faces");

  // Boxes in whole texels, turned at random, packed.
  std::vector<Placement> charts(result.charts);
  std::vector<std::array<int, 4>> boxes(result.charts, {image.width, image.height, 0, 0});
  for (Index face = 0; face < mesh.faces.size(); ++face) {
    auto& [x0, y0, x1, y1] = boxes[chart_of[face]];
    for (const Vec2& p : corners[face]) {
      x0 = std::min(x0, int(std::floor(p.x()))), y0 = std::min(y0, int(std::floor(p.y())));
      x1 = std::max(x1, int(std::ceil(p.x()))), y1 = std::max(y1, int(std::ceil(p.y())));
    }
  }
  for (Index i = 0; i < result.charts; ++i) {
    const auto [x0, y0, x1, y1] = boxes[i];
    charts[i] = {x0, y0, x1 - x0, y1 - y0, int(hash(seed, 2, i) % 4)};
  }
  const auto [width, height] = pack(charts);

  // UVs: one per old UV and chart.
  result.mesh.uvs.clear();
  std::map<std::pair<Index, Index>, Index> new_uv;
  for (Index face = 0; face < mesh.faces.size(); ++face) {
    for (int k = 0; k < 3; ++k) {
      const auto [entry, is_new] = new_uv.try_emplace({mesh.face_uvs[face][k], chart_of[face]},
                                                      Index(result.mesh.uvs.size()));
      if (is_new) {
        const Vec2 p = charts[chart_of[face]](corners[face][k]);
        result.mesh.uvs.emplace_back(p.x() / width, 1 - p.y() / height);
      }
      result.mesh.face_uvs[face][k] = entry->second;
    }
  }

  // Values, by texel centres. Whatever no chart holds is noise: reading it must show.
  result.image = make_image(width, height, image.channels);
  result.image.alpha_channel = image.alpha_channel;
  for (std::size_t i = 0; i < result.image.pixels.size(); ++i) {
    result.image.pixels[i] = float(hash_unit(seed, 3, i));
  }
  result.new_texel.assign(std::size_t(image.width) * std::size_t(image.height), kNone);
  for (Index face = 0; face < mesh.faces.size(); ++face) {
    const Placement& chart = charts[chart_of[face]];
    for_centres(corners[face], [&](int x, int y) {
      const Vec2 q = chart(Vec2(x + 0.5, y + 0.5));
      const auto from = Index(y) * Index(image.width) + Index(x);
      const auto to = Index(q.y()) * Index(width) + Index(q.x());
      if (result.new_texel[from] != kNone) return;
      result.new_texel[from] = to;
      std::copy_n(image.texel(from), image.channels, result.image.texel(to));
    });
  }
  return result;
}

}  // namespace onmesh
