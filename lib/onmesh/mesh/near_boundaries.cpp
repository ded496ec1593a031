#include "onmesh/mesh/near_boundaries.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "onmesh/base/text.h"
#include "onmesh/mesh/gap_search.h"
#include "onmesh/mesh/join_boundaries.h"

namespace onmesh {
namespace {

/// Number of edges at gaps, and the widest gap.
NearBoundaries count_near(const TriangleMesh& mesh, const std::vector<double>& reach) {
  NearBoundaries found;
  const GapSearch search(mesh);
  const std::vector<BoundaryEdge>& edges = search.edges();
  std::vector<double> gaps(edges.size());
  oneapi::tbb::parallel_for(std::size_t{0}, edges.size(), [&](std::size_t e) {
    const double r = reach[edges[e].face];
    gaps[e] = r > 0 ? search.gap_at(static_cast<Index>(e), r) : -1;
  });
  for (const double gap : gaps) {
    found.edges += gap >= 0;
    found.width = std::max(found.width, gap);
  }
  // What touches needs a length as well.
  constexpr double kLeast = 1e-6;  // of the diagonal
  if (found.edges > 0) found.width = std::max(found.width, kLeast * mesh.diagonal());
  return found;
}

/// The least number of two digits that is larger.
double two_digits_up(double value) {
  if (!(value > 0)) return 0;
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1);
  return std::ceil(value * 1.01 / unit) * unit;
}

}  // namespace

std::string NearBoundaries::text() const {
  std::array<char, 32> length;
  std::snprintf(length.data(), length.size(), "%.2g", two_digits_up(width));
  return count_text(edges, "boundary edge lies", "boundary edges lie") +
         " within a texel of others but " + (edges == 1 ? "stays" : "stay") + " apart; " +
         (weldable ? "weld=" : "bridge=") + length.data() + " would join them";
}

NearBoundaries find_near_boundaries(const TriangleMesh& mesh, const std::vector<double>& reach) {
  NearBoundaries found = count_near(mesh, reach);
  if (found.edges == 0) return found;
  JoinReport report;
  const TriangleMesh joined = join_boundaries(mesh, two_digits_up(found.width), &report);
  if (report.nothing_done()) return found;
  std::vector<double> left_reach;
  for (const Index f : report.face) left_reach.push_back(reach[f]);
  constexpr Index kNearlyAll = 10;  // one in so many may be left
  found.weldable = count_near(joined, left_reach).edges <= found.edges / kNearlyAll;
  return found;
}

}  // namespace onmesh
