// The heat method on a point cloud: its distances where the surface is no manifold, or none at all.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "onmesh/distance/cloud/cloud.h"
#include "onmesh/distance/unfold.h"
#include "onmesh/filter/patch_loop.h"
#include "onmesh/nodes/bisection.h"
#include "onmesh/procedural/shapes.h"
#include "onmesh/procedural/texture.h"
#include "support/distance_errors.h"
#include "support/filter_error.h"
#include "support/mesh_parts.h"
#include "support/simple_shapes.h"

namespace onmesh {
namespace {

using namespace simple;

DistanceTable cloud_table(const TriangleMesh& mesh, double reach) {
  const NodeMesh nodes = make_node_mesh(mesh);
  return fill(*make_cloud(mesh, nodes), whole(nodes), reach);
}

// Every vertex of a page's grid on the book's other pages and its own, by unfolding at the spine.
double on_book(const Vec3& p, const Vec3& q) {
  const double a = std::hypot(p.x(), p.z()), b = std::hypot(q.x(), q.z());
  const bool same_page = p.x() * q.x() + p.z() * q.z() > (1 - 1e-9) * a * b;
  return std::hypot(same_page ? a - b : a + b, p.y() - q.y());
}

// The shortest paths along edges, from every vertex to every other (Floyd & Warshall): no distance
// on the surface is longer.
std::vector<std::vector<double>> distances_along_edges(const TriangleMesh& mesh) {
  const std::size_t n = mesh.positions.size();
  std::vector<std::vector<double>> d(n, std::vector<double>(n, 1e300));
  for (std::size_t i = 0; i < n; ++i) d[i][i] = 0;
  for (const auto& face : mesh.faces)
    for (const Index a : face)
      for (const Index b : face) d[a][b] = (mesh.positions[a] - mesh.positions[b]).norm();
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) d[i][j] = std::min(d[i][j], d[i][k] + d[k][j]);
  return d;
}

}  // namespace

TEST_CASE("a book's distances unfold at the spine, by cloud", "[cloud]") {
  for (const double angle : {20.0, 90.0, 120.0}) {
    const TriangleMesh mesh = make_book(10, angle);
    const double h = mean_edge(make_node_mesh(mesh));
    const auto truth = [&](Index a, Index b) {
      return on_book(mesh.positions[a], mesh.positions[b]);
    };
    const Errors errors = compare(cloud_table(mesh, 2.5 * h), 2.5 * h, truth);
    CAPTURE(angle, errors.mean / h, errors.max / h);
    CHECK(errors.mean < 0.012 * h);
    CHECK(errors.max < 0.3 * h);
  }
}

TEST_CASE("cloud filters a book close to the definition", "[cloud][accuracy]") {
  const double angle = 40;
  const TriangleMesh mesh = make_book(8, angle);
  const Image texture = make_texture(192, 192, Pattern::checker, 0.3, 7);
  // The mesh's own faces are the node faces.
  NodeSurface surface;
  surface.nodes = make_node_mesh(mesh);
  surface.overlay.face_offsets.push_back(0);
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    surface.overlay.pieces.push_back({f, Eigen::Matrix3d::Identity()});
    surface.overlay.face_offsets.push_back(f + 1);
  }
  const TexelMap map = make_texel_map(mesh, texture.width, texture.height);
  const Samples samples = texel_samples(map, surface);
  const double sigma = 8 * map.median_texel_size();
  const Distances truth = [&](const SurfacePoint& source,
                              const std::vector<SurfacePoint>& targets) {
    std::vector<double> d;
    for (const SurfacePoint& t : targets)
      d.push_back(on_book(mesh.position(source), mesh.position(t)));
    return d;
  };
  const auto backend = make_cloud(mesh, surface.nodes);
  for (const FilterKind kind : {FilterKind::gaussian, FilterKind::bilateral}) {
    const bool bilateral = kind == FilterKind::bilateral;
    const double radius = (bilateral ? 2.5 : 3) * sigma;
    PatchWork work;
    work.nodes = &surface.nodes;
    work.backend = backend.get();
    work.sources = work.targets = &samples;
    const int channels = texture.channels;
    work.colours = {texture.pixels.data(), channels, channels, channels};
    work.kernel = {sigma, radius, bilateral ? 0.2 : 0};
    Image result = texture;
    filter_patches(
        work,
        [&](Index begin, Index end, const float* values) {
          for (Index target = begin; target < end; ++target, values += channels)
            std::copy_n(values, channels, result.texel(samples.samples[target].texel));
        },
        [](double) {});
    const DefinitionError error =
        against_definition(mesh, texture, result, {sigma, radius, bilateral ? 0.2 : 0}, 200, truth);
    CAPTURE(bilateral, error.psnr);
    CHECK(error.psnr > (bilateral ? 76 : 67));
  }
}

TEST_CASE("the paths of a bow tie lead through its knot", "[cloud]") {
  // Two grids in different planes that share one corner, the origin.
  const int n = 8;
  TriangleMesh mesh = plane(n, n, 1, 1);
  const Index half = Index(mesh.positions.size()), faces = Index(mesh.faces.size());
  for (Index i = 1; i < half; ++i) {
    const Vec3 p = mesh.positions[i];
    mesh.positions.emplace_back(-p.x(), 0.3 * p.y(), p.y());
  }
  const auto moved = [&](Index i) { return i == 0 ? 0 : i + half - 1; };
  for (Index f = 0; f < faces; ++f) {
    const auto c = mesh.faces[f];
    mesh.faces.push_back({moved(c[0]), moved(c[1]), moved(c[2])});
  }
  const auto truth = [&](Index a, Index b) {
    const Vec3 &p = mesh.positions[a], &q = mesh.positions[b];
    return (a < half) == (b < half) || a == 0 || b == 0 ? (p - q).norm() : p.norm() + q.norm();
  };
  const double h = mean_edge(make_node_mesh(mesh));
  const Errors errors = compare(cloud_table(mesh, 2.5 * h), 2.5 * h, truth);
  CAPTURE(errors.mean / h, errors.max / h);
  CHECK(errors.mean < 0.012 * h);
  CHECK(errors.max < 0.3 * h);
}

TEST_CASE("a Moebius strip has the distances of its unrolled double cover, by cloud", "[cloud]") {
  const double length = 8, h = 0.2;
  const TriangleMesh mesh = make_moebius(4, length, 1);
  RefineOptions options;
  options.spacing = h;
  const NodeMesh nodes = refine_by_bisection(mesh, options).nodes;
  const auto flat = [&](Index i) {
    return Vec2((mesh.uv(nodes.nodes[i]) - Vec2(0.5, 0.5)) * length / kMoebiusScale);
  };
  const auto truth = [&](Index a, Index b) {
    const Vec2 x = flat(a), y = flat(b), turned(y.x(), -y.y());
    return std::min({(x - y).norm(), (x - turned - Vec2(length, 0)).norm(),
                     (x - turned + Vec2(length, 0)).norm()});
  };
  const Errors errors =
      compare(fill(*make_cloud(mesh, nodes), whole(nodes), 2.5 * h), 2.5 * h, truth);
  CAPTURE(errors.mean / h, errors.max / h);
  CHECK(errors.mean < 0.012 * h);
  CHECK(errors.max < 0.3 * h);
}

TEST_CASE("cloud does not care how faces are wound", "[cloud]") {
  const TriangleMesh mesh = blob(3);
  TriangleMesh mixed = mesh;
  std::mt19937 random(3);
  for (auto& f : mixed.faces)
    if (random() % 2) std::swap(f[0], f[1]);
  const DistanceTable a = cloud_table(mesh, 0.4), b = cloud_table(mixed, 0.4);
  std::size_t compared = 0;
  for (std::size_t i = 0; i < a.squared.size(); ++i) {
    if (a.squared[i] >= 0.15F) continue;
    REQUIRE(std::abs(a.squared[i] - b.squared[i]) < 1e-4);
    ++compared;
  }
  CHECK(compared > 10 * mesh.positions.size());
}

TEST_CASE("parallel sheets closer than the spacing exchange nothing", "[cloud]") {
  const int n = 10;
  const TriangleMesh sheet = plane(n, n, 1, 1, 0.3);
  const TriangleMesh mesh = side_by_side(sheet, sheet, {0, 0, 0.5 / n});
  const auto half = Index(sheet.positions.size());
  const DistanceTable table = cloud_table(mesh, 2);
  for (Index i = 0; i < table.rows; ++i)
    for (Index j = 0; j < table.columns; ++j)
      REQUIRE((table.row(i)[j] == kUnreachable) == ((i < half) != (j < half)));
}

TEST_CASE("a sheet folded to half the spacing has the distances of the flat one", "[cloud]") {
  const int n = 12;
  const double gap = 0.5 / n;
  for (const int segments : {1, 2, 4}) {
    const TriangleMesh folded = make_u_sheet(1, 1, gap, segments, n);
    // Flat: UVs fill [0,1]^2.
    const NodeMesh nodes = make_node_mesh(folded);
    const double width = u_sheet_width(1, gap, segments);
    const auto flat = [&](Index i) {
      const SurfacePoint& p = nodes.nodes[i];
      const Vec2 uv = folded.uv(p);
      return Vec2(uv.x() * width, uv.y());
    };
    const auto truth = [&](Index a, Index b) { return (flat(a) - flat(b)).norm(); };
    const double h = mean_edge(nodes);
    const Errors errors = compare(cloud_table(folded, 2.5 * h), 2.5 * h, truth);
    CAPTURE(segments, errors.mean / h, errors.max / h);
    CHECK(errors.mean < 0.012 * h);
    CHECK(errors.max < 0.3 * h);
  }
}

TEST_CASE("cloud leaves out what has no surface, and never makes NaN", "[cloud]") {
  TriangleMesh mesh = plane(6, 6, 1, 1, 0.2);
  const Index count = Index(mesh.positions.size());
  // A triangle without area, one on a point, a point alone, a triangle with its own back side.
  mesh.positions.insert(mesh.positions.end(), {{2, 0, 0}, {3, 0, 0}, {4, 0, 0}});
  mesh.faces.push_back({count, count + 1, count + 2});
  mesh.positions.insert(mesh.positions.end(), {{5, 0, 0}, {5, 0, 0}, {5, 0, 0}});
  mesh.faces.push_back({count + 3, count + 4, count + 5});
  mesh.positions.emplace_back(6, 0, 0);
  mesh.positions.insert(mesh.positions.end(), {{7, 0, 0}, {7.1, 0, 0}, {7, 0.1, 0}});
  mesh.faces.push_back({count + 7, count + 8, count + 9});
  mesh.faces.push_back({count + 7, count + 9, count + 8});
  const NodeMesh nodes = make_node_mesh(mesh);
  const auto backend = make_cloud(mesh, nodes);
  CHECK(backend->skipped_nodes() == 7);
  CHECK(make_unfold()->skipped_nodes() == 0);
  const DistanceTable table = fill(*backend, whole(nodes), 0.8);
  for (Index i = 0; i < table.rows; ++i)
    for (Index j = 0; j < table.columns; ++j) {
      const float d = table.row(i)[j];
      REQUIRE(d >= 0);
      const bool back_to_back = i >= count + 7 && j >= count + 7;
      if (i == j || back_to_back)
        REQUIRE(d < 0.1F);
      else if (i >= count || j >= count)
        REQUIRE(d == kUnreachable);
      else if ((mesh.positions[i] - mesh.positions[j]).norm() < 0.75)
        REQUIRE(d != kUnreachable);
    }
  // Nothing but such faces.
  TriangleMesh empty;
  empty.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  empty.faces = {{0, 1, 2}};
  const DistanceTable nothing = cloud_table(empty, 9);
  CHECK(nothing.row(0)[0] == 0);
  CHECK(nothing.row(0)[1] == kUnreachable);
}

TEST_CASE("what faces join is reached over any set of faces", "[cloud]") {
  // A closed noisy surface with random faces between near vertices: every kind of bad edge.
  TriangleMesh mesh = icosphere(2);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> shift(-0.1, 0.1);
  for (Vec3& p : mesh.positions) p += Vec3(shift(random), shift(random), shift(random));
  for (int i = 0; i < 200; ++i) {
    const Index a = Index(random() % mesh.positions.size()),
                b = Index(random() % mesh.positions.size());
    const auto c = mesh.faces[random() % 320];
    if (a != b && a != c[0] && b != c[0]) mesh.faces.push_back({a, b, c[0]});
  }
  const DistanceTable table = cloud_table(mesh, 9);
  const std::vector<std::vector<double>> along_edges = distances_along_edges(mesh);
  double longest = 0, shortest = 1e300;  // shares of the way along edges, and of the straight line
  for (Index i = 0; i < table.rows; ++i)
    for (Index j = 0; j < table.columns; ++j) {
      REQUIRE(table.row(i)[j] != kUnreachable);
      if (i == j) continue;
      const double d = std::sqrt(double(table.row(i)[j]));
      longest = std::max(longest, d / along_edges[i][j]);
      shortest = std::min(shortest, d / (mesh.positions[i] - mesh.positions[j]).norm());
    }
  CHECK(longest < 2.5);  // such faces are a rough ground
  CHECK(shortest > 0.7);
}

}  // namespace onmesh
