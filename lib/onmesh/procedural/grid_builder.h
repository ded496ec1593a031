// Meshes made of grids of quads, and the checks that all shapes share.
#pragma once

#include <functional>
#include <initializer_list>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// Adds charts that are grids of quads, each split into two triangles. Grid points of equal key are
/// one vertex, within a chart and between charts.
class GridBuilder {
 public:
  using Key = std::tuple<long, long, long>;
  struct Point {
    Key key;
    Vec3 position;
    Vec2 uv;
  };

  /// A chart of nx x ny quads, counter-clockwise in (i, j).
  /// \param point called for every i in [0, nx] and j in [0, ny], row by row
  void add_chart(int nx, int ny, const std::function<Point(int, int)>& point);

  /// The mesh so far, which goes to the caller.
  TriangleMesh take() { return std::move(mesh_); }

 private:
  void add_face(const std::vector<Index>& vertices, Index first_uv,
                const std::array<Index, 3>& grid);

  TriangleMesh mesh_;
  std::map<Key, Index> vertex_of_;
};

/// \throw UsageError with the message unless the condition holds
void require(bool condition, const char* message);

/// \throw UsageError naming the shape unless all numbers of segments are in [least, 8192]
void require_segments(const char* shape, std::initializer_list<int> counts, int least = 1);

/// Greater than zero and finite.
bool positive(double x);

}  // namespace onmesh
