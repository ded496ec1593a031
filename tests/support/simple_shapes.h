// Small meshes for the tests and benchmarks of patches and distances: connectivity only, no UVs.
#pragma once

#include <numbers>

#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh::simple {

inline constexpr double kPi = std::numbers::pi;

/// nx x ny quads over [0, width] x [0, height] with alternating diagonals; interior vertices are
/// moved by up to `jitter` of a cell.
TriangleMesh plane(int nx, int ny, double width, double height, double jitter = 0);

/// Radius 1, inscribed.
TriangleMesh icosphere(int levels);

/// A sphere displaced by smooth waves.
TriangleMesh blob(int levels, double amplitude = 0.25);

/// Rows shifted by half a cell, so that faces are near equilateral for suitable nu : nv; nu even.
TriangleMesh torus(int nu, int nv, double major = 1, double minor = 0.4);

/// Slant length 1, apex first, then `rings` rings of n vertices: the facets unroll to a sector
/// whose angle is 2 n asin(chord / 2), exactly `degrees` in all. Distances have a closed form.
TriangleMesh cone(double degrees, int n, int rings);

/// n facets of total width `around`, no caps.
TriangleMesh cylinder(int n, int rings, double around, double height);

/// [-1, 1]^3 with n x n quads a side.
TriangleMesh cube(int n);

/// z = a (x^2 - y^2) over [-1, 1]^2.
TriangleMesh saddle(int n, double a = 0.5);

}  // namespace onmesh::simple
