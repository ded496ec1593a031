#include "onmesh/mesh/coarse_coordinates.h"

#include <algorithm>
#include <cstdio>

#include "onmesh/base/text.h"

namespace onmesh {
namespace {

std::string coordinate_text(double value) {
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%.7g", value);
  return text.data();
}

std::string rounded_text(double value) {
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%.2g", value);
  return text.data();
}

}  // namespace

CoarseCoordinates find_coarse_coordinates(const TriangleMesh& as_read, const TriangleMesh& welded) {
  CoarseCoordinates found;
  for (Index f = 0; f < welded.faces.size(); ++f) {
    found.collapsed +=
        has_repeated_vertex(welded.faces[f]) && !has_repeated_vertex(as_read.faces[f]);
  }
  double largest = 0;
  for (const Vec3& p : welded.positions) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  const double step = welded.precision.step(largest), edge = welded.mean_edge_length();
  // Poles and the like collapse because they are meant to: then edges are long beside the steps.
  constexpr double kShort = 8, kTooShort = 2;  // steps
  constexpr std::size_t kFew = 50;             // one face in so many
  const bool collapses = found.collapsed > welded.faces.size() / kFew && edge < kShort * step;
  if (!collapses && !(welded.precision.single && edge < kTooShort * step)) return found;
  found.problem = "coordinates are stored too coarsely: " + welded.precision.name() + " near " +
                  coordinate_text(largest) + " has steps of " + coordinate_text(step) +
                  ", edges are about " + rounded_text(edge) + " long";
  if (found.collapsed > 0)
    found.problem += ", and " + count_text(found.collapsed, "face", "faces") + " collapsed";
  found.problem += "; move the mesh to the origin before it is stored, or store it more finely";
  return found;
}

}  // namespace onmesh
