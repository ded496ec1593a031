// Parametric textured meshes: the bundled meshes, the demo and the tests are made of these.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "onmesh/image.h"
#include "onmesh/triangle_mesh.h"

namespace onmesh {

// Every shape comes welded, wound outward, with an atlas. `n` is the number of segments per side.

/// [0, width] x [0, height] in the xy plane, UVs [0,1]^2.
TriangleMesh make_plane(int nx, int ny, double width = 1, double height = 1);
/// The plane folded along lines x = const into an accordion (fold angle in degrees between leaves);
/// isometric to make_plane with the same UVs.
TriangleMesh make_folded_sheet(int leaves, double width, double height, double angle_degrees, int ny = 1);
/// A sheet bent into a U: two parallel leaves `gap` apart, joined by a half cylinder of that diameter;
/// isometric (to the chord error of `segments` facets) to a plane of its developed width.
TriangleMesh make_u_sheet(double leaf, double height, double gap, int segments = 2);
/// [-1,1]^3, six charts in a 4 x 3 cross layout with padding.
TriangleMesh make_cube(int n = 1);
/// Icosphere of radius 1 with an octahedral-map atlas cut into charts; `levels` subdivisions.
TriangleMesh make_sphere(int levels);
TriangleMesh make_torus(int nu, int nv, double major_radius = 1, double minor_radius = 0.4);
/// Cone over a sector of `sector_degrees` (270 = a quarter missing), slant length 1, exactly
/// developable: apex plus `n` triangles, subdivided `rings` times radially.
TriangleMesh make_cone(double sector_degrees, int n, int rings);
/// Cylinder of the given radius and height without caps; n facets.
TriangleMesh make_cylinder(int n, int rings, double radius = 1, double height = 2);
/// z = a (x^2 - y^2) over [-1,1]^2.
TriangleMesh make_saddle(int n, double a = 0.5);
/// A smooth bumpy closed surface (sphere displaced by seeded low-frequency waves).
TriangleMesh make_blob(int levels, std::uint64_t seed, double amplitude = 0.25);

/// The mesh cut into charts along random edges, each chart moved by whole texels and rotated by
/// multiples of 90 degrees within a W x H atlas; `image` is rearranged to match.
// (declared where it is needed by tests)

enum class Pattern { checker, stripes, noise, gradient, dots };

/// A textured test image; the pattern with seeded uniform noise of amplitude `noise` added, clamped.
Image make_texture(int width, int height, Pattern pattern, double noise, std::uint64_t seed, int channels = 3);

}  // namespace onmesh
