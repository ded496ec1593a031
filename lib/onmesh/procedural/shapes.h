// Parametric textured meshes: the bundled meshes, the demo and the tests are made of these.
#pragma once

#include <cstdint>

#include "onmesh/mesh/triangle_mesh.h"
#include "onmesh/procedural/texture.h"

namespace onmesh {

// Every shape comes welded, wound counter-clockwise seen from outside (open sheets: from +z, the
// U-sheet from above its lower leaf), with an atlas whose charts keep at least 4 texels of distance
// from each other and, unless they fill [0,1]^2, from the image's border, at 256 x 256 texels. `n`,
// `nx`, `ny` are numbers of segments per side, [1, 8192] unless said otherwise; lengths are mesh
// units. Parameters outside the domain given with each throw UsageError.

/// Distance between charts, and between a chart and the border where it keeps one, in UVs.
inline constexpr double kChartMargin = 1.0 / 64;

// Sheets (sheets.cpp).

/// [0, width] x [0, height] in the xy plane, UVs fill [0,1]^2 (isometric on an image of that
/// aspect). A stretched plane is this with a width and height that are not the image's.
TriangleMesh make_plane(int nx, int ny, double width = 1, double height = 1);

/// The plane folded along lines x = const into an accordion of equal leaves; `angle_degrees` in
/// [0, 180) is how far each leaf turns from the one before (0 = flat). Isometric to
/// make_plane(leaves, ny, width, height) with the same UVs.
TriangleMesh make_folded_sheet(int leaves, double width, double height, double angle_degrees,
                               int ny = 1);

/// A sheet bent into a U: two parallel leaves `gap` apart, joined by half a prism of `segments`
/// facets inscribed in the cylinder of that diameter. UVs fill [0,1]^2; exactly isometric to
/// make_plane(..., u_sheet_width(leaf, gap, segments), height). n segments along each leaf and
/// across.
TriangleMesh make_u_sheet(double leaf, double height, double gap, int segments = 2, int n = 1);

/// Width of the U-sheet laid out flat, mesh units.
double u_sheet_width(double leaf, double gap, int segments);

/// z = amplitude sin(pi x) sin(pi y) over [0,1]^2, UVs (x, y): texel density varies by
/// sqrt(1 + (pi amplitude)^2) at most.
TriangleMesh make_gentle_sheet(int n, double amplitude = 0.08);

/// z = a (x^2 - y^2) over [-1,1]^2; UVs fill [0,1]^2.
TriangleMesh make_saddle(int n, double a = 0.5);

/// Not manifold: three pages of size 1 x 1.4 that share their spine (on the y axis), fanned out by
/// `angle_degrees` in (0, 180) from page to page. One rectangular chart per page.
TriangleMesh make_book(int n, double angle_degrees = 40);

/// Not manifold: two unit squares in the xy plane, [-1,0]^2 and [0,1]^2, that share the corner at
/// the origin and nothing else. One chart each, true to scale; n segments per side. The shortest
/// way from one to the other leads through the origin.
TriangleMesh make_bow_tie(int n);

// Boxes and surfaces of revolution (solids.cpp).

/// [-1,1]^3. Six square charts of side 7/32 in a cross of 4 columns and 3 rows with cells of side
/// 1/4 (bottom quarter of the image unused); corners lie on texel corners if the image's sides are
/// multiples of 64, and all grid points do if in addition 7 side / 32 is a multiple of n.
TriangleMesh make_cube(int n = 1);

/// Two components: a closed box of 2 x 1 x 1.4 and a closed lid of height 0.4 that floats `gap` > 0
/// above it. Six rectangular charts each, all of one scale.
TriangleMesh make_chest(int n = 1, double gap = 0.05);

/// A ring around the z axis. One rectangular chart, scaled alike in both directions (true to length
/// on the circle half-way between the outer and the inner one). nu, nv >= 3; minor < major.
TriangleMesh make_torus(int nu, int nv, double major_radius = 1, double minor_radius = 0.4);

/// Pyramid of `n` >= 3 facets over a sector of `sector_degrees` in (0, 360) (270 = a quarter
/// missing) with its apex at the origin, opening towards -z, ridges of length 1, cut into `rings`
/// rings. Exactly developable; its chart is the sector laid out flat.
TriangleMesh make_cone(double sector_degrees, int n, int rings);

/// Prism of n >= 3 facets inscribed in the cylinder around the z axis, without caps; its chart is
/// the wall laid out flat.
TriangleMesh make_cylinder(int n, int rings, double radius = 1, double height = 2);

/// Circumference of that prism, mesh units.
double cylinder_circumference(int n, double radius);

// Round ones (sphere.cpp).

/// Icosphere of radius 1, `levels` in [0, 8] subdivisions; its 20 base triangles are the charts,
/// equilateral and all of one size.
TriangleMesh make_sphere(int levels);

/// A smooth bumpy closed surface: the icosphere with its atlas, displaced along its rays by five
/// seeded low-frequency waves, at most by `amplitude` in [0, 0.9].
TriangleMesh make_blob(int levels, std::uint64_t seed, double amplitude = 0.45);

// One-sided (moebius.cpp).

/// One-sided: a strip folded along five creases into a closed band with a half twist. It is exactly
/// developable: laid out, it is the strip |y| <= width / 2 in which (x, y) and (x + length, -y) are
/// one point; its chart is one length of it, kMoebiusScale / length UVs per mesh unit, centred in
/// the image. n in [1, 1024] segments along each of the five facets and across;
/// width <= length / 8.
TriangleMesh make_moebius(int n, double length = 8, double width = 1);

/// Length of the strip's chart in UVs.
inline constexpr double kMoebiusScale = 0.75;

}  // namespace onmesh
