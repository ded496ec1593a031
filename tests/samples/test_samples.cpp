#include <catch2/catch.hpp>
#include <map>
#include <set>

#include "onmesh/nodes/refine.h"
#include "onmesh/poisson/poisson.h"
#include "onmesh/procedural/shapes.h"
#include "onmesh/samples/samples.h"
#include "support/mesh_parts.h"

using namespace onmesh;

namespace {

NodeSurface refine_to(const TriangleMesh& mesh, double spacing) {
  RefineOptions options;
  options.spacing = spacing;
  return refine_manifold(mesh, options);
}

}  // namespace

TEST_CASE("every claim becomes one sample in the node face that holds it", "[samples]") {
  for (const TriangleMesh& mesh :
       {make_cube(2), make_torus(20, 12), make_sphere(2), make_plane(3, 2)}) {
    const TexelMap map = make_texel_map(mesh, 128, 128);
    const NodeSurface surface = refine_to(mesh, 0.13);
    const Samples samples = texel_samples(map, surface);
    REQUIRE(samples.samples.size() == map.claims.size());
    REQUIRE(samples.face_offsets.size() == surface.nodes.faces.size() + 1);
    // Each sample's node point is the located texel centre: compare against a search of all pieces.
    std::vector<std::pair<Index, Sample>> found;
    for (Index f = 0; f + 1 < samples.face_offsets.size(); ++f) {
      for (Index i = samples.face_offsets[f]; i < samples.face_offsets[f + 1]; ++i) {
        found.emplace_back(f, samples.samples[i]);
      }
    }
    std::vector<std::pair<Index, Sample>> of_texel(
        static_cast<std::size_t>(map.tiles[0].width * map.tiles[0].height), {kNone, {}});
    for (const auto& entry : found) of_texel[entry.second.texel] = entry;
    for (Index f = 0; f < mesh.faces.size(); ++f) {
      for (Index c = map.face_offsets[f]; c < map.face_offsets[f + 1]; ++c) {
        const NodePoint at = surface.overlay.locate({f, map.barycentric(f, map.claims[c])});
        const auto& [face, sample] = of_texel[map.tiles[0].texel(map.claims[c])];
        REQUIRE(face != kNone);
        CHECK(sample.area == Approx(map.texel_area[f]));
        if (face == at.face) {
          CHECK(sample.b1 == Approx(at.barycentric[1]).margin(1e-6));
          CHECK(sample.b2 == Approx(at.barycentric[2]).margin(1e-6));
        } else {  // on an edge of two node faces
          CHECK(at.barycentric.minCoeff() < 1e-6);
        }
      }
    }
  }
}

TEST_CASE("samples of a texel map stand for the surface's area", "[samples]") {
  const TriangleMesh mesh = make_torus(40, 20);
  double area = 0;
  for (Index f = 0; f < mesh.faces.size(); ++f) area += mesh.face_area(f);
  const Samples samples = texel_samples(make_texel_map(mesh, 512, 512), refine_to(mesh, 0.2));
  double sum = 0;
  for (const Sample& s : samples.samples) sum += static_cast<double>(s.area);
  // A chart of about 480 texels a side is sampled to half a texel along its border.
  CHECK(sum == Approx(area).epsilon(4 * 0.5 / 480));
}

TEST_CASE("surface points carry the texel whose square holds them", "[samples]") {
  const TriangleMesh mesh = make_plane(1, 1);
  const TexelMap map = make_texel_map(mesh, 10, 10);
  const NodeSurface surface = refine_to(mesh, 0.3);
  std::vector<SurfacePoint> points;
  for (Index f = 0; f < 2; ++f) points.push_back({f, Vec3(0.2, 0.35, 0.45)});
  const Samples samples = point_samples(mesh, map, surface, points, 0.5);
  REQUIRE(samples.samples.size() == 2);
  std::multiset<Index> expected, got;
  for (const SurfacePoint& p : points) {
    const Vec2 uv = mesh.uv(p);
    expected.insert(static_cast<Index>(int((1 - uv.y()) * 10) * 10 + int(uv.x() * 10)));
  }
  for (const Sample& s : samples.samples) {
    got.insert(s.texel);
    CHECK(s.area == 0.5F);
  }
  CHECK(got == expected);
}

TEST_CASE("samples that share their texels stand for the area of each texel", "[samples]") {
  for (const TriangleMesh& mesh : {make_torus(20, 12), make_cube(2), make_sphere(1)}) {
    const TexelMap map = make_texel_map(mesh, 70, 64);  // charts end within texels
    const NodeSurface surface = refine_to(mesh, 0.3);
    const GradedSamples drawn = texel_poisson_samples(mesh, map, {});
    const Samples samples = sharing_samples(mesh, map, surface, drawn.points);
    REQUIRE(samples.samples.size() <= drawn.points.size());
    std::map<Index, double> shared, own, any;
    for (const Sample& s : samples.samples) {
      shared[s.texel] += static_cast<double>(s.area);
      CHECK(any.try_emplace(s.texel, s.area).first->second == s.area);
    }
    for (Index f = 0; f < mesh.faces.size(); ++f) {
      for (Index c = map.face_offsets[f]; c < map.face_offsets[f + 1]; ++c) {
        own[map.tiles[0].texel(map.claims[c])] += map.texel_area[f];
      }
    }
    REQUIRE(shared.size() == own.size());
    for (const auto& [texel, area] : own) CHECK(shared[texel] == Approx(area).epsilon(1e-5));
  }
}

TEST_CASE("charts that claim the same texel share its area among their own samples", "[samples]") {
  // Two squares of different size in space on the same texels.
  const TriangleMesh mesh = side_by_side(make_plane(1, 1), make_plane(1, 1, 2, 2), {3, 0, 0});
  const TexelMap map = make_texel_map(mesh, 12, 12);
  const NodeSurface surface = refine_to(mesh, 0.5);
  const Samples samples =
      sharing_samples(mesh, map, surface, texel_poisson_samples(mesh, map, {}).points);
  std::array<std::map<Index, double>, 2> shared;
  for (Index f = 0; f + 1 < samples.face_offsets.size(); ++f) {
    const Index node = surface.nodes.faces[f][0];
    const bool large = mesh.position(surface.nodes.nodes[node]).x() > 2;
    for (Index i = samples.face_offsets[f]; i < samples.face_offsets[f + 1]; ++i) {
      shared[large][samples.samples[i].texel] += static_cast<double>(samples.samples[i].area);
    }
  }
  for (const bool large : {false, true}) {
    REQUIRE(shared[large].size() == 144);
    for (const auto& [texel, area] : shared[large])
      CHECK(area == Approx((large ? 4.0 : 1.0) / 144).epsilon(1e-5));
  }
}
