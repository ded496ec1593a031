#include "onmesh/atlas/running_back.h"

#include <algorithm>
#include <span>

namespace onmesh {
namespace {

Vec2 extent(const TriangleMesh& mesh, Index face) {
  const auto c = mesh.corner_uvs(face);
  return c[0].cwiseMax(c[1]).cwiseMax(c[2]) - c[0].cwiseMin(c[1]).cwiseMin(c[2]);
}

/// \param faces of one chart
Index count_in_chart(const TriangleMesh& mesh, std::span<const Index> faces) {
  constexpr std::size_t kLeastFaces = 6;  // fewer are no wrap
  if (faces.size() < kLeastFaces) return 0;
  int sense = 0;  // of more faces than not
  Vec2 low = mesh.corner_uvs(faces[0])[0], high = low;
  std::array<std::vector<double>, 2> extents;
  for (const Index f : faces) {
    sense += mesh.uv_area(f) > 0 ? 1 : -1;
    for (const Vec2& uv : mesh.corner_uvs(f)) {
      low = low.cwiseMin(uv);
      high = high.cwiseMax(uv);
    }
    const Vec2 size = extent(mesh, f);
    for (int k = 0; k < 2; ++k) extents[static_cast<std::size_t>(k)].push_back(size[k]);
  }
  Vec2 usual;
  for (std::size_t k = 0; k < 2; ++k) {
    const auto middle = extents[k].begin() + static_cast<std::ptrdiff_t>(extents[k].size() / 2);
    std::nth_element(extents[k].begin(), middle, extents[k].end());
    usual[static_cast<Eigen::Index>(k)] = *middle;
  }
  constexpr double kMuchOfChart = 0.5, kMuchLarger = 4;
  const Vec2 least = (kMuchOfChart * (high - low)).cwiseMax(kMuchLarger * usual);
  return static_cast<Index>(std::count_if(faces.begin(), faces.end(), [&](Index f) {
    const bool mirrored = mesh.uv_area(f) * sense < 0;
    return mirrored && (extent(mesh, f).array() >= least.array()).any();
  }));
}

}  // namespace

Index count_running_back(const TriangleMesh& mesh, const std::vector<Index>& chart_of_face) {
  std::vector<Index> faces;
  for (Index f = 0; f < chart_of_face.size(); ++f) {
    if (chart_of_face[f] != kNone) faces.push_back(f);
  }
  std::stable_sort(faces.begin(), faces.end(),
                   [&](Index a, Index b) { return chart_of_face[a] < chart_of_face[b]; });
  Index count = 0;
  for (std::size_t begin = 0, end = 0; begin < faces.size(); begin = end) {
    while (end < faces.size() && chart_of_face[faces[end]] == chart_of_face[faces[begin]]) ++end;
    count += count_in_chart(mesh, {faces.data() + begin, end - begin});
  }
  return count;
}

}  // namespace onmesh
