// Local Delaunay triangulation of the neighbourhood of one point of the cloud.
#pragma once

#include <vector>

#include "onmesh/distance/cloud/point_cloud.h"

namespace onmesh::cloud {

/// A triangle of points, counter-clockwise around the first point's normal. turn: whether the other
/// points' normals agree with it.
struct LocalTriangle {
  std::array<Index, 3> point;
  std::array<int, 3> turn{1, 1, 1};
};

/// Finds the triangles around points, keeping its buffers. One object per thread.
///
/// The neighbourhood is flattened into the tangent plane by walking from neighbour to neighbour,
/// each step in the tangent plane of the point it starts from (the discrete exponential map;
/// Schmidt, Grimm & Wyvill, Interactive Decal Compositing with Discrete Exponential Maps, 2006). So
/// what is near in space but not over the surface is not found. The walk stays on one sheet: it
/// ends at borders, and no neighbour is accepted behind one.
///
/// Of the Delaunay triangulation of what is found, the triangles around the point are kept (Sharp &
/// Crane 2020, section 5.7). Whether an edge is Delaunay is decided from the six distances between
/// the four points around it, symmetrically, so that all four decide alike.
class LocalTriangulation {
 public:
  /// \param order per local node, all different: decides between equal choices alike in all patches
  /// \pre points and order outlive this
  LocalTriangulation(const PointCloud& points, const std::vector<Index>& order);

  /// Append the triangles around a node. Where the neighbourhood cannot be flattened (the normals
  /// cancel, or the neighbours come out of order), these are the faces around it.
  void triangulate(Index centre, std::vector<LocalTriangle>& triangles);

 private:
  struct Neighbour {
    Index point = 0;
    int turn = 1;
    Vec2 at;    // in the centre's tangent plane, which is at the origin
    Vec3 u, v;  // rows: offsets in this point's plane to the centre's
    double angle = 0, distance = 0;
  };

  bool place_ring(Index centre);
  void walk(Index centre, double radius);
  bool behind_border(const Neighbour& q) const;
  void sort_neighbours(Index centre);
  void select(Index centre);
  bool keep(Index centre, const Neighbour& a, const Neighbour& b, const Neighbour& c) const;
  double distance(const Neighbour& a, const Neighbour& b) const;
  void add_faces(Index centre, std::vector<LocalTriangle>& triangles) const;
  Neighbour see(const Neighbour& from, const Spoke& spoke, bool& valid) const;

  const PointCloud& points_;
  const std::vector<Index>& order_;
  std::vector<Neighbour> found_;  // the ring first, then in the order of the walk
  std::size_t ring_ = 0;
  std::vector<Index> seen_;  // per point: the last centre that found it
  std::vector<std::array<Vec2, 2>> borders_;
  std::vector<Neighbour> sorted_, star_;
};

}  // namespace onmesh::cloud
