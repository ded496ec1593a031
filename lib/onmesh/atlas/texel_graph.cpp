#include "onmesh/atlas/texel_graph.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "onmesh/atlas/texel_places.h"
#include "onmesh/atlas/unfolded_walk.h"
#include "onmesh/base/parallel.h"

namespace onmesh {
namespace {

/// Weights below this share of a face's largest would make texels of thin faces independent.
constexpr double kLeastShare = 1e-3;

/// One of each two opposite directions, in columns and rows.
constexpr std::array<TexelClaim, 4> kDirections{{{1, 0}, {0, 1}, {1, 1}, {1, -1}}};

/// Per direction the weight of a link, see make_texel_graph().
using LinkWeights = std::array<float, 4>;

LinkWeights weights_of_face(const TriangleMesh& mesh, const TexelMap& map, Index face) {
  const auto corners = mesh.corners(face);
  const Eigen::Matrix3d& to_barycentric = map.to_barycentric(face);
  Vec3 a = Vec3::Zero(), b = Vec3::Zero();
  for (int k = 0; k < 3; ++k) {
    a += to_barycentric(k, 0) * corners[std::size_t(k)];
    b += to_barycentric(k, 1) * corners[std::size_t(k)];
  }
  const double area = a.cross(b).norm(), aa = a.squaredNorm(), bb = b.squaredNorm(), ab = a.dot(b);
  LinkWeights weights{1, 1, 0, 0};
  if (!(area > 0) || !std::isfinite((aa + bb) / area)) return weights;
  const double least = kLeastShare * std::max(aa, bb);
  weights[0] = float(std::max(bb - std::abs(ab), least) / area);
  weights[1] = float(std::max(aa - std::abs(ab), least) / area);
  // Rows go down: where a and b lie at an obtuse angle, the short diagonal is (1, 1).
  weights[ab < 0 ? 2 : 3] = float(std::abs(ab) / area);
  return weights;
}

/// What a texel is linked to, and how strongly.
struct Link {
  Index texel;
  float weight;
};

class LinkFinder {
 public:
  LinkFinder(const TriangleMesh& mesh, const TexelMap& map)
      : map_(map), places_(map), walk_(mesh, map), weights_(mesh.faces.size()) {
    parallel_over(mesh.faces.size(), [&](std::size_t f) {
      if (map.texel_area[f] > 0) weights_[f] = weights_of_face(mesh, map, Index(f));
    });
  }

  /// Add those within the chart; a texel may come twice.
  /// \param open receives the sides, in columns and rows, where it has no texel
  void within_chart(Index texel, std::vector<Link>& links, std::vector<TexelClaim>& open) const {
    const Index face = places_.face(texel);
    const TexelTile tile = map_.tile_of(face);
    const TexelClaim at = places_.claim(texel);
    for (std::size_t d = 0; d < kDirections.size(); ++d) {
      for (const int sign : {1, -1}) {
        const TexelClaim step{sign * kDirections[d].x, sign * kDirections[d].y};
        const Index other = places_.in_chart_of(face, tile, {at.x + step.x, at.y + step.y});
        if (other == texel) continue;
        if (other == kNone) {
          if (d < 2) open.push_back(step);
          continue;
        }
        const float weight = (weights_[face][d] + weights_[places_.face(other)][d]) / 2;
        if (weight > 0) links.push_back({other, weight});
      }
    }
  }

  /// Those to where the surface goes on beyond a side that is open.
  void over_seam(Index texel, const TexelClaim& step, std::vector<Link>& links) const {
    const Index face = places_.face(texel);
    const TexelClaim at = places_.claim(texel);
    const LaidFace laid = walk_.lay_out(face);
    const Eigen::Matrix3d& to_barycentric = map_.to_barycentric(face);
    const Vec2 from = laid.point(map_.barycentric(face, at));
    const Vec2 to = laid.point(to_barycentric * Vec3(at.x + step.x + 0.5, at.y + step.y + 0.5, 1));
    const WalkEnd end = walk_.over_surface(laid, from, to);
    if (!end.arrived || map_.chart_of_face[end.laid.face] == kNone) return;
    const Vec2 pixel = interpolate(walk_.pixel_corners(end.laid.face),
                                   barycentric_in(end.laid.corners, end.point));
    const float weight = weights_[face][step.x != 0 ? 0 : 1];
    if (!share(texel, end.laid.face, pixel, weight, links)) {
      // A narrow chart: whatever is near.
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x)
          if (share(texel, end.laid.face, pixel + Vec2(x, y), weight, links)) return;
    }
  }

 private:
  /// Share a link's weight among the chart's texels around a place, bilinearly.
  bool share(Index texel, Index face, const Vec2& pixel, float weight,
             std::vector<Link>& links) const {
    const TexelTile tile = map_.tile_of(face);
    const Vec2 at = pixel - Vec2(0.5, 0.5);
    const int x = int(std::floor(at.x())), y = int(std::floor(at.y()));
    std::array<Link, 4> found;
    std::size_t count = 0;
    double sum = 0;
    for (int corner = 0; corner < 4; ++corner) {
      const TexelClaim there{x + corner % 2, y + corner / 2};
      const double part = (1 - std::abs(at.x() - there.x)) * (1 - std::abs(at.y() - there.y));
      const Index other = places_.in_chart_of(face, tile, there);
      if (!(part > 1e-6) || other == kNone || other == texel) continue;
      found[count++] = {other, float(part)};
      sum += part;
    }
    for (const Link& link : std::span(found).first(count))
      links.push_back({link.texel, weight * link.weight / float(sum)});
    return count > 0;
  }

  const TexelMap& map_;
  const TexelPlaces places_;
  const UnfoldedWalk walk_;
  std::vector<LinkWeights> weights_;  ///< per face
};

/// Links over a seam of one row.
struct SeamLink {
  Index row;
  Link link;
};

constexpr std::size_t kBlock = 1024;

/// What a block of rows is linked to.
struct BlockLinks {
  std::vector<Link> within;   ///< charts, row by row
  std::vector<Index> counts;  ///< of those, per row
  std::vector<SeamLink> over_seams;
};

BlockLinks find_links(const LinkFinder& finder, const std::vector<Index>& unknown,
                      std::size_t begin, std::size_t end) {
  BlockLinks found;
  found.within.reserve(5 * (end - begin));
  std::vector<TexelClaim> open;
  std::vector<Link> over_seam;
  for (std::size_t i = begin; i < end; ++i) {
    const std::size_t before = found.within.size();
    open.clear();
    over_seam.clear();
    finder.within_chart(unknown[i], found.within, open);
    found.counts.push_back(Index(found.within.size() - before));
    for (const TexelClaim& step : open) finder.over_seam(unknown[i], step, over_seam);
    for (const Link& link : over_seam) found.over_seams.push_back({Index(i), link});
  }
  return found;
}

/// Over seams both sides have links of their own, each for half; what is known has none.
/// \return the links of both sides, by row
std::vector<SeamLink> both_ways(std::vector<BlockLinks>& blocks, const std::vector<Index>& unknown,
                                const LargeArray<Index>& row_of) {
  std::vector<SeamLink> links;
  for (BlockLinks& block : blocks) {
    for (SeamLink one : block.over_seams) {
      const Index other = row_of[one.link.texel];
      if (other != kNone) {
        one.link.weight /= 2;
        links.push_back({other, {unknown[one.row], one.link.weight}});
      }
      links.push_back(one);
    }
    block.over_seams = {};
  }
  std::stable_sort(links.begin(), links.end(),
                   [](const SeamLink& a, const SeamLink& b) { return a.row < b.row; });
  return links;
}

/// Goes through the rows of a block with all their links.
class RowLinks {
 public:
  RowLinks(const BlockLinks& block, const std::vector<SeamLink>& over_seams, std::size_t first_row)
      : within_(block.within.data()),
        seam_(std::lower_bound(over_seams.begin(), over_seams.end(), Index(first_row),
                               [](const SeamLink& a, Index row) { return a.row < row; })),
        end_(over_seams.end()) {}

  /// Calls visit(link) for all of the next row.
  /// \param count of those within its chart
  template <class Visit>
  void next(std::size_t row, Index count, const Visit& visit) {
    for (const Link* const end = within_ + count; within_ != end; ++within_) visit(*within_);
    for (; seam_ != end_ && seam_->row == row; ++seam_) visit(seam_->link);
  }

 private:
  const Link* within_;
  std::vector<SeamLink>::const_iterator seam_, end_;
};

}  // namespace

TexelGraph make_texel_graph(const TriangleMesh& mesh, const TexelMap& map,
                            const std::vector<Index>& unknown) {
  const LinkFinder finder(mesh, map);
  LargeArray<Index> row_of(map.coverage.size());
  over_blocks(row_of.size(), [&](std::size_t begin, std::size_t end) {
    std::fill(row_of.begin() + std::ptrdiff_t(begin), row_of.begin() + std::ptrdiff_t(end), kNone);
  });
  for (std::size_t i = 0; i < unknown.size(); ++i) row_of[unknown[i]] = Index(i);
  std::vector<BlockLinks> blocks((unknown.size() + kBlock - 1) / kBlock);
  parallel_over(blocks.size(), [&](std::size_t block) {
    const std::size_t begin = block * kBlock;
    blocks[block] = find_links(finder, unknown, begin, std::min(begin + kBlock, unknown.size()));
  });
  const std::vector<SeamLink> over_seams = both_ways(blocks, unknown, row_of);

  TexelGraph graph;
  GraphMatrix& matrix = graph.matrix;
  matrix.offsets.assign(unknown.size() + 1, 0);
  graph.known_offsets.assign(unknown.size() + 1, 0);
  matrix.diagonal.resize(unknown.size());
  parallel_over(blocks.size(), [&](std::size_t block) {
    std::size_t row = block * kBlock;
    RowLinks links(blocks[block], over_seams, row);
    for (const Index count : blocks[block].counts) {
      double sum = 0;
      links.next(row, count, [&](const Link& link) {
        sum += link.weight;
        ++(row_of[link.texel] != kNone ? matrix.offsets : graph.known_offsets)[row + 1];
      });
      matrix.diagonal[row++] = float(sum);
    }
  });
  for (std::size_t i = 0; i < unknown.size(); ++i) {
    matrix.offsets[i + 1] += matrix.offsets[i];
    graph.known_offsets[i + 1] += graph.known_offsets[i];
  }
  matrix.columns.resize(matrix.offsets.back());
  matrix.weights.resize(matrix.offsets.back());
  graph.known.resize(graph.known_offsets.back());
  graph.known_weights.resize(graph.known_offsets.back());
  parallel_over(blocks.size(), [&](std::size_t block) {
    std::size_t row = block * kBlock;
    RowLinks links(blocks[block], over_seams, row);
    Index k = matrix.offsets[row], known = graph.known_offsets[row];
    for (const Index count : blocks[block].counts) {
      links.next(row++, count, [&](const Link& link) {
        const Index column = row_of[link.texel];
        if (column != kNone) {
          matrix.columns[k] = column;
          matrix.weights[k++] = link.weight;
        } else {
          graph.known[known] = link.texel;
          graph.known_weights[known++] = link.weight;
        }
      });
    }
    blocks[block] = {};
  });
  return graph;
}

}  // namespace onmesh
