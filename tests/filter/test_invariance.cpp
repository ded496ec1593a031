// The result belongs to the surface and its texels: how the mesh is written down, where it lies,
// how large it is and which way its atlas faces must not matter.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "onmesh/filter/filter.h"
#include "onmesh/procedural/shapes.h"
#include "support/images.h"
#include "support/rewritten_meshes.h"

namespace onmesh {
namespace {

/// A way to give the same surface.
struct Change {
  const char* name;
  void (*rewrite)(TriangleMesh&);
  bool same_nodes = false;  ///< all that differs is rounding
  bool mirrors = false;     ///< the image must be mirrored, too
};

void scale(TriangleMesh& mesh, double factor) {
  for (Vec3& p : mesh.positions) p *= factor;
}

const Change kChanges[] = {
    {"renumbered vertices", [](TriangleMesh& mesh) { renumber_vertices(mesh, 1); }, true},
    {"moved by 10^6",
     [](TriangleMesh& mesh) {
       move_rigidly(mesh, {1e6, -1e6, 1e6});
     },
     true},
    {"scaled by 10^-6", [](TriangleMesh& mesh) { scale(mesh, 1e-6); }, true},
    {"scaled by 10^6", [](TriangleMesh& mesh) { scale(mesh, 1e6); }, true},
    {"permuted faces",
     [](TriangleMesh& mesh) {
       shuffle_faces(mesh, 2);
       turn_corners(mesh, 3);
     }},
    {"reversed winding", reverse_winding},
    {"split faces", split_at_barycentres},
    {"mirrored charts", mirror_atlas, true, true},
    {"loose triangles",
     [](TriangleMesh& mesh) {
       mesh = loosen(mesh);
       shuffle_faces(mesh, 4);
       turn_corners(mesh, 5);
       reverse_some(mesh, 6);
     }},
};

/// How far the results may be apart.
struct Bounds {
  double largest;   ///< difference of a value, at most
  double psnr = 0;  ///< dB, at least
};

/// A kind of filter and a way to do its sums, with what must hold for it.
struct Evaluation {
  std::string name;
  FilterKind kind;
  FilterMethod method;
  DistanceMethod distance;
  Bounds bounds;
  Bounds same_nodes;  ///< for changes after which nodes are where they were
};

/// The sums on nodes come within their tolerance of the direct ones, and patches that are cut
/// elsewhere may be summed on nodes halved otherwise or with other colours: nodes that stay do not
/// make results equal.
std::vector<Evaluation> direct_and_nodes(const Bounds& gaussian, const Bounds& bilateral,
                                         const Bounds& same_nodes, const Bounds& gaussian_on_nodes,
                                         const Bounds& bilateral_on_nodes) {
  constexpr auto kUnfold = DistanceMethod::unfold;
  return {
      {"Gaussian", FilterKind::gaussian, FilterMethod::direct, kUnfold, gaussian, same_nodes},
      {"bilateral", FilterKind::bilateral, FilterMethod::direct, kUnfold, bilateral, same_nodes},
      {"Gaussian on nodes", FilterKind::gaussian, FilterMethod::nodes, kUnfold, gaussian_on_nodes,
       gaussian_on_nodes},
      {"bilateral on nodes", FilterKind::bilateral, FilterMethod::nodes, kUnfold,
       bilateral_on_nodes, bilateral_on_nodes}};
}

std::vector<Evaluation> heat_and_cloud(const Bounds& gaussian_heat, const Bounds& bilateral_cloud) {
  return {{"Gaussian by heat", FilterKind::gaussian, FilterMethod::direct, DistanceMethod::heat,
           gaussian_heat, gaussian_heat},
          {"bilateral by cloud", FilterKind::bilateral, FilterMethod::direct, DistanceMethod::cloud,
           bilateral_cloud, bilateral_cloud}};
}

/// The filter on the surface given in every way, compared with that on the mesh as it is.
void check_changes(const TriangleMesh& mesh, double sigma, const std::vector<Evaluation>& cases) {
  const Image texture = noisy_checker(128, 128);
  for (const Evaluation& c : cases) {
    FilterOptions options;
    options.kind = c.kind;
    options.method = c.method;
    options.distance = c.distance;
    options.sigma_spatial = {sigma, Length::Unit::texel};
    options.sigma_range = 0.2;
    options.gutter = 0;
    const Image expected = filter(mesh, texture, options);
    for (const Change& change : kChanges) {
      TriangleMesh given = mesh;
      change.rewrite(given);
      const Image result = change.mirrors ? mirrored(filter(given, mirrored(texture), options))
                                          : filter(given, texture, options);
      const double largest = largest_difference(result, expected), db = psnr(result, expected);
      const Bounds& bounds = change.same_nodes ? c.same_nodes : c.bounds;
      INFO(c.name << ", " << change.name << ": " << largest << ", " << db << " dB");
      CHECK(largest <= bounds.largest);
      CHECK(db >= bounds.psnr);
    }
  }
}

/// Where nothing but rounding differs.
constexpr Bounds kRounding{2e-6, 135};

TEST_CASE("a bumpy surface filters the same however it is given", "[invariance][slow]") {
  check_changes(
      make_blob(2, 1), 6,
      direct_and_nodes({3.8e-3, 78}, {1.9e-3, 84}, kRounding, {1.4e-2, 59}, {1.4e-2, 62}));
}

TEST_CASE("a torus filters the same however it is given", "[invariance][slow]") {
  check_changes(
      make_torus(16, 8), 6,
      direct_and_nodes({6.2e-3, 64}, {4.1e-3, 72}, {2e-5, 139}, {1.1e-2, 61}, {1.9e-2, 63}));
}

TEST_CASE("a cube filters the same however it is given", "[invariance][slow]") {
  check_changes(
      make_cube(1), 6,
      direct_and_nodes({1.3e-2, 70}, {5.2e-3, 83}, {5.2e-5, 132}, {1.3e-2, 60}, {1.5e-2, 65}));
}

TEST_CASE("a folded sheet filters the same however it is given", "[invariance][slow]") {
  check_changes(make_folded_sheet(4, 1.6, 1.6, 90, 2), 6,
                direct_and_nodes(kRounding, kRounding, kRounding, {2.1e-2, 51}, {2.4e-2, 57}));
}

TEST_CASE("a patch of a saddle filters the same however it is given", "[invariance][slow]") {
  // On its regular grid rounding decides where nodes go.
  check_changes(
      make_saddle(8), 6,
      direct_and_nodes({4e-4, 91}, {5.8e-4, 89}, {3.5e-4, 93}, {1.9e-2, 52}, {2.5e-2, 56}));
}

TEST_CASE("a Moebius strip filters the same however it is given", "[invariance]") {
  const TriangleMesh strip = make_moebius(2);
  check_changes(strip, 3,
                direct_and_nodes(kRounding, kRounding, kRounding, {2.7e-2, 59}, {9.5e-3, 70}));
  check_changes(strip, 3, heat_and_cloud({4.4e-3, 75}, {2e-3, 87}));
}

TEST_CASE("a book filters the same however it is given", "[invariance][slow]") {
  const TriangleMesh book = make_book(3);
  check_changes(book, 6,
                direct_and_nodes(kRounding, kRounding, kRounding, {2.2e-2, 57}, {1.9e-2, 60}));
  check_changes(book, 6, heat_and_cloud({4.1e-3, 73}, {2e-3, 79}));
}

}  // namespace
}  // namespace onmesh
