// Meshes with faults that mean nothing or are awkward: the rest of the surface filters as without.
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <numbers>

#include "onmesh/filter/filter.h"
#include "onmesh/procedural/shapes.h"
#include "support/images.h"

namespace onmesh {
namespace {

/// A place on the mesh, and how it is spoilt there.
struct Fault {
  const char* name;
  /// \param v the place: a vertex, \param next one that shares an edge with it
  std::function<void(TriangleMesh& mesh, Index v, Index next)> spoil;
};

/// A face with UVs in a spot of the atlas that carries no texel centre.
void add_face(TriangleMesh& mesh, Index a, Index b, Index c) {
  const auto uv = static_cast<Index>(mesh.uvs.size());
  for (int k = 0; k < 3; ++k) mesh.uvs.emplace_back(0.5, 0.5);
  mesh.faces.push_back({a, b, c});
  mesh.face_uvs.push_back({uv, uv + 1, uv + 2});
  mesh.face_materials.push_back(mesh.face_materials[0]);
}

Index add_vertex(TriangleMesh& mesh, const Vec3& p) {
  mesh.positions.push_back(p);
  return static_cast<Index>(mesh.positions.size() - 1);
}

Index face_at(const TriangleMesh& mesh, Index v) {
  for (Index f = 0; f < mesh.faces.size(); ++f)
    for (const Index corner : mesh.faces[f])
      if (corner == v) return f;
  return kNone;
}

const std::vector<Fault>& all_faults() {
  static const std::vector<Fault> faults{
      {"spike of 1e3",
       [](TriangleMesh& mesh, Index v, Index) { mesh.positions[v] += Vec3(0, 0, 1e3); }},
      {"spike of 1e6",
       [](TriangleMesh& mesh, Index v, Index) { mesh.positions[v] += Vec3(0, 0, 1e6); }},
      {"needle",
       [](TriangleMesh& mesh, Index v, Index next) {
         add_face(mesh, v, next, add_vertex(mesh, mesh.positions[v] + Vec3(0, 0, 1e4)));
       }},
      {"face of 1e-12",
       [](TriangleMesh& mesh, Index v, Index) {
         const Vec3 p = mesh.positions[v];
         add_face(mesh, v, add_vertex(mesh, p + Vec3(1e-12, 0, 0)),
                  add_vertex(mesh, p + Vec3(0, 1e-12, 0)));
       }},
      {"no area",
       [](TriangleMesh& mesh, Index v, Index next) {
         add_face(mesh, v, next, add_vertex(mesh, (mesh.positions[v] + mesh.positions[next]) / 2));
       }},
      {"repeated corner",
       [](TriangleMesh& mesh, Index v, Index next) { add_face(mesh, v, v, next); }},
      {"repeated face",
       [](TriangleMesh& mesh, Index v, Index) {
         const Index f = face_at(mesh, v);
         const auto uvs = mesh.face_uvs[f];
         mesh.faces.push_back(mesh.faces[f]);
         mesh.face_uvs.push_back(uvs);
         mesh.face_materials.push_back(mesh.face_materials[0]);
       }},
      {"isolated vertices far away",
       [](TriangleMesh& mesh, Index, Index) {
         add_vertex(mesh, {1e30, 0, 0});
         add_vertex(mesh, {0, -1e-30, 0});
       }},
      {"UVs without area",
       [](TriangleMesh& mesh, Index v, Index) {
         auto& uvs = mesh.face_uvs[face_at(mesh, v)];
         uvs[1] = uvs[2] = uvs[0];
       }},
      {"no UVs",
       [](TriangleMesh& mesh, Index v, Index) {
         mesh.face_uvs[face_at(mesh, v)] = {kNone, kNone, kNone};
       }},
      {"vertices nearly on one another",
       [](TriangleMesh& mesh, Index v, Index next) {
         mesh.positions[v] =
             mesh.positions[next] + 1e-13 * (mesh.positions[v] - mesh.positions[next]);
       }},
      {"another sheet through the surface", [](TriangleMesh& mesh, Index v, Index) {
         const Vec3 p = mesh.positions[v];
         add_face(mesh, add_vertex(mesh, p + Vec3(-0.1, 0, -0.1)),
                  add_vertex(mesh, p + Vec3(0.1, 0, -0.1)), add_vertex(mesh, p + Vec3(0, 0, 0.1)));
       }}};
  return faults;
}

/// Of the texels farther than `away` from a point, dB.
double psnr_away(const TriangleMesh& mesh, const Image& a, const Image& b, const Vec3& from,
                 double away) {
  const TexelMap map = make_texel_map(mesh, a.width, a.height);
  double squared = 0;
  std::size_t values = 0;
  for (Index f = 0; f < mesh.faces.size(); ++f)
    for (Index i = map.face_offsets[f]; i < map.face_offsets[f + 1]; ++i) {
      const Vec3 p = mesh.position(SurfacePoint{f, map.barycentric(f, map.claims[i])});
      if ((p - from).norm() < away) continue;
      for (int c = 0; c < a.channels; ++c, ++values) {
        const Index texel = map.tiles[0].texel(map.claims[i]);
        const double d = double(a.texel(texel)[c]) - double(b.texel(texel)[c]);
        squared += d * d;
      }
    }
  REQUIRE(values > map.claims.size());  // at least a third of the texels
  return squared > 0 ? -10 * std::log10(squared / double(values)) : 999;
}

void check_faults(FilterOptions options, double least = 60) {
  // A closed surface that is curved, and a sheet.
  const Length sigma = options.sigma_spatial;
  const TriangleMesh sphere = make_sphere(2), sheet = make_gentle_sheet(12);
  for (const TriangleMesh* const clean : {&sphere, &sheet}) {
    const Image texture = noisy_checker(64, 64);
    // In mesh units: the median of the texels may change with the fault.
    options.sigma_spatial = sigma;
    options.sigma_spatial = {plan_filter(*clean, texture, options).sigma_spatial,
                             Length::Unit::mesh};
    const Image expected = filter(*clean, texture, options);
    const Index v = clean->faces[clean->faces.size() / 2][0];
    const Index next = clean->faces[clean->faces.size() / 2][1];
    // What the fault changes, and what reaches it.
    double ring = 0;
    for (const auto& face : clean->faces)
      if (face[0] == v || face[1] == v || face[2] == v)
        for (const Index n : face)
          ring = std::max(ring, (clean->positions[n] - clean->positions[v]).norm());
    const FilterPlan plan = plan_filter(*clean, texture, options);
    for (const Fault& fault : all_faults()) {
      TriangleMesh mesh = *clean;
      fault.spoil(mesh, v, next);
      const Image result = filter(mesh, texture, options);
      const double psnr = psnr_away(*clean, result, expected, clean->positions[v],
                                    ring + plan.radius + 3 * plan.texel_size);
      CAPTURE(fault.name, clean == &sphere, psnr);
      CHECK(psnr > least);
    }
  }
}

FilterOptions small_filter() {
  FilterOptions options;
  options.sigma_spatial = {2, Length::Unit::texel};
  options.sigma_range = 0.3;
  return options;
}

}  // namespace

TEST_CASE("faults leave the rest of the surface alone: unfold", "[faults][slow]") {
  check_faults(small_filter());
}

TEST_CASE("faults leave the rest of the surface alone: Gaussian", "[faults][slow]") {
  FilterOptions options = small_filter();
  options.kind = FilterKind::gaussian;
  check_faults(options);
}

TEST_CASE("faults leave the rest of the surface alone: nodes", "[faults][slow]") {
  FilterOptions options = small_filter();
  options.method = FilterMethod::nodes;
  check_faults(options, 54);  // what the tolerance allows
}

TEST_CASE("faults leave the rest of the surface alone: heat", "[faults][slow]") {
  FilterOptions options = small_filter();
  options.distance = DistanceMethod::heat;
  check_faults(options);
}

TEST_CASE("faults leave the rest of the surface alone: cloud", "[faults][slow]") {
  FilterOptions options = small_filter();
  options.distance = DistanceMethod::cloud;
  check_faults(options);
}

TEST_CASE("faults leave the rest of the surface alone: bridges", "[faults][slow]") {
  FilterOptions options = small_filter();
  options.bridge = Length{1, Length::Unit::texel};
  check_faults(options);
}

}  // namespace onmesh
