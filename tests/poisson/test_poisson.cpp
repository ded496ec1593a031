#include "onmesh/poisson/poisson.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <map>
#include <random>
#include <set>

#include "onmesh/base/error.h"
#include "onmesh/poisson/connected_ball.h"

using namespace onmesh;

namespace {

const double kPi = std::acos(-1.0);

// ---- meshes ----

// A grid of nx x ny squares, two faces each, its points placed by `place(u, v)`, u and v in [0,1].
template <typename Place>
TriangleMesh sheet(int nx, int ny, const Place& place) {
  TriangleMesh mesh;
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i) mesh.positions.push_back(place(double(i) / nx, double(j) / ny));
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const Index a = Index(j * (nx + 1) + i), b = a + 1, c = a + Index(nx) + 1, d = c + 1;
      mesh.faces.push_back({a, b, d});
      mesh.faces.push_back({a, d, c});
    }
  return mesh;
}

TriangleMesh plane(int nx, int ny, double width, double height) {
  return sheet(nx, ny, [=](double u, double v) { return Vec3(u * width, v * height, 0); });
}

TriangleMesh cube() {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.positions.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
  mesh.faces = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

// Octahedron subdivided; `radius(direction)` places the vertices.
template <typename Radius>
TriangleMesh blob(int levels, const Radius& radius) {
  TriangleMesh mesh;
  mesh.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.faces = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<Index, Index>, Index> middles;
    const auto middle = [&](Index a, Index b) {
      const auto [it, added] = middles.try_emplace(std::minmax(a, b), mesh.positions.size());
      if (added) mesh.positions.push_back((mesh.positions[a] + mesh.positions[b]).normalized());
      return it->second;
    };
    std::vector<std::array<Index, 3>> faces;
    for (const auto& [a, b, c] : mesh.faces) {
      const Index d = middle(a, b), e = middle(b, c), f = middle(c, a);
      faces.insert(faces.end(), {{a, d, f}, {d, b, e}, {f, e, c}, {d, e, f}});
    }
    mesh.faces = faces;
  }
  for (Vec3& p : mesh.positions) p *= radius(p);
  return mesh;
}

TriangleMesh sphere(int levels) {
  return blob(levels, [](const Vec3&) { return 1.0; });
}

// A point at arc length s along a U: two leaves of length `leaf`, joined by a half circle.
Vec3 on_u(double s, double y, double leaf, double gap) {
  const double bend = 0.5 * kPi * gap;
  if (s <= leaf) return {-s, y, -gap / 2};
  if (s >= leaf + bend) return {s - 2 * leaf - bend, y, gap / 2};
  const double a = (s - leaf) / bend * kPi;
  return {-leaf - gap / 2 * std::sin(a), y, -gap / 2 * std::cos(a)};
}

// The U with n squares along each leaf and 4 around the bend; their leaf (or 1 for the bend) is
// told by leaf_of_face.
TriangleMesh u_sheet(double leaf, double height, double gap, int n, int ny,
                     std::vector<int>* leaf_of_face = nullptr) {
  const int columns = 2 * n + 4;
  const double bend = 0.5 * kPi * gap;
  TriangleMesh mesh = sheet(columns, ny, [&](double u, double v) {
    const int i = int(std::lround(u * columns));
    const double s = i <= n       ? leaf * i / n
                     : i >= n + 4 ? leaf + bend + leaf * (i - n - 4) / n
                                  : leaf + bend * (i - n) / 4;
    return on_u(s, v * height, leaf, gap);
  });
  if (leaf_of_face)
    for (Index f = 0; f < Index(mesh.faces.size()); ++f) {
      const int column = int(f / 2) % columns;
      leaf_of_face->push_back(column < n ? 0 : column < n + 4 ? 1 : 2);
    }
  return mesh;
}

// Three pages joined at one spine, an edge of three faces in each row.
TriangleMesh book(double page, double height, int n, int ny) {
  TriangleMesh mesh;
  for (int p = 0; p < 3; ++p) {
    const double angle = 0.02 * p;
    const TriangleMesh one = sheet(n, ny, [&](double u, double v) {
      return Vec3(u * page * std::cos(angle), v * height, u * page * std::sin(angle));
    });
    const Index base = Index(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), one.positions.begin(), one.positions.end());
    for (auto f : one.faces) {
      for (Index& v : f)
        v = p > 0 && v % Index(n + 1) == 0 ? v : v + base;  // the first page's spine
      mesh.faces.push_back(f);
    }
  }
  return mesh;
}

// Triangles that share nothing but one vertex, in a cone.
TriangleMesh pinwheel(int n) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}};
  for (int i = 0; i < 2 * n; ++i)
    mesh.positions.emplace_back(std::cos(i * kPi / n), std::sin(i * kPi / n), 0.5);
  for (Index i = 0; i < Index(n); ++i) mesh.faces.push_back({0, 2 * i + 1, 2 * i + 2});
  return mesh;
}

TriangleMesh join(const TriangleMesh& a, const TriangleMesh& b) {
  TriangleMesh mesh = a;
  mesh.positions.insert(mesh.positions.end(), b.positions.begin(), b.positions.end());
  for (auto f : b.faces) {
    for (Index& v : f) v += Index(a.positions.size());
    mesh.faces.push_back(f);
  }
  return mesh;
}

// ---- measuring ----

double area(const TriangleMesh& mesh, Index f) {
  const auto t = mesh.corners(f);
  return 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).norm();
}

Vec3 position(const TriangleMesh& mesh, const SurfacePoint& p) {
  const auto t = mesh.corners(p.face);
  return p.barycentric[0] * t[0] + p.barycentric[1] * t[1] + p.barycentric[2] * t[2];
}

std::vector<SurfacePoint> sample(const TriangleMesh& mesh, double spacing, std::uint64_t seed = 1,
                                 std::vector<bool> faces = {}) {
  PoissonOptions options;
  options.spacing = spacing;
  options.seed = seed;
  options.faces = std::move(faces);
  return poisson_samples(mesh, options);
}

double edge_distance(const Vec3& p, const Vec3& a, const Vec3& b) {
  const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (a + t * (b - a) - p).norm();
}

// Faces joined to the point's face within the ball, by trying all pairs of faces until none is new.
std::set<Index> flood(const TriangleMesh& mesh, const SurfacePoint& from, double radius) {
  const Vec3 centre = position(mesh, from);
  std::set<Index> found{from.face};
  for (bool grew = true; grew;) {
    grew = false;
    for (const Index f : std::set<Index>(found))
      for (Index g = 0; g < Index(mesh.faces.size()); ++g) {
        if (found.count(g)) continue;
        std::vector<Vec3> shared;
        for (const Index v : mesh.faces[f])
          for (const Index w : mesh.faces[g])
            if (v == w) shared.push_back(mesh.positions[v]);
        bool joined = false;
        for (const Vec3& v : shared) joined |= (v - centre).norm() < radius;
        if (shared.size() == 2) joined |= edge_distance(centre, shared[0], shared[1]) < radius;
        if (joined) grew = found.insert(g).second;
      }
  }
  return found;
}

// The definition of a conflict, word by word.
bool conflict(const TriangleMesh& mesh, const SurfacePoint& a, const SurfacePoint& b,
              double spacing) {
  if ((position(mesh, a) - position(mesh, b)).norm() >= spacing) return false;
  if (a.face == b.face) return true;
  return flood(mesh, a, spacing).count(b.face) || flood(mesh, b, spacing).count(a.face);
}

// Smallest distance of two samples on the same piece (label) of the surface.
double min_distance(const TriangleMesh& mesh, const std::vector<SurfacePoint>& samples,
                    const std::vector<int>& label_of_face = {}) {
  double least = 1e300;
  std::vector<Vec3> positions;
  for (const auto& s : samples) positions.push_back(position(mesh, s));
  for (std::size_t i = 0; i < samples.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (label_of_face.empty() || label_of_face[samples[i].face] == label_of_face[samples[j].face])
        least = std::min(least, (positions[i] - positions[j]).squaredNorm());
  return std::sqrt(least);
}

std::vector<SurfacePoint> random_points(const TriangleMesh& mesh, int n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<double> areas;
  for (Index f = 0; f < Index(mesh.faces.size()); ++f) areas.push_back(area(mesh, f));
  std::discrete_distribution<Index> face(areas.begin(), areas.end());
  std::vector<SurfacePoint> points;
  for (int i = 0; i < n; ++i) {
    double u = uniform(random), v = uniform(random);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    points.push_back({face(random), {1 - u - v, u, v}});
  }
  return points;
}

// Largest distance from random surface points to their nearest sample.
double largest_gap(const TriangleMesh& mesh, const std::vector<SurfacePoint>& samples, int n) {
  std::vector<Vec3> positions;
  for (const auto& s : samples) positions.push_back(position(mesh, s));
  double largest = 0;
  for (const auto& p : random_points(mesh, n, 99)) {
    const Vec3 q = position(mesh, p);
    double nearest = 1e300;
    for (const Vec3& s : positions) nearest = std::min(nearest, (s - q).squaredNorm());
    largest = std::max(largest, nearest);
  }
  return std::sqrt(largest);
}

bool same(const std::vector<SurfacePoint>& a, const std::vector<SurfacePoint>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (a[i].face != b[i].face || a[i].barycentric != b[i].barycentric) return false;
  return true;
}

}  // namespace

TEST_CASE("samples keep their spacing and leave no gap", "[poisson]") {
  const auto bumps = [](const Vec3& d) {
    return 1 + 0.2 * std::sin(4 * d.x()) * std::cos(5 * d.y());
  };
  const std::vector<std::pair<TriangleMesh, double>> cases = {
      {plane(1, 1, 2, 1), 0.025},   // faces much larger than the spacing
      {plane(7, 300, 2, 1), 0.03},  // narrow faces
      {cube(), 0.09},
      {sphere(2), 0.06},
      {sphere(6), 0.11},  // faces much smaller than the spacing
      {blob(6, bumps), 0.09},
      {blob(4, bumps), 0.05},
  };
  for (const auto& [mesh, spacing] : cases) {
    const auto samples = sample(mesh, spacing);
    CAPTURE(mesh.faces.size(), spacing, samples.size());
    REQUIRE(samples.size() > 500);
    CHECK(min_distance(mesh, samples) >= spacing * (1 - 1e-12));
    CHECK(largest_gap(mesh, samples, 10000) <= spacing * (1 + 1e-3));
    for (const auto& s : samples) {
      REQUIRE(s.face < mesh.faces.size());
      REQUIRE(s.barycentric.minCoeff() >= 0);
      REQUIRE(std::abs(s.barycentric.sum() - 1) < 1e-12);
    }
  }
}

TEST_CASE("a plane gets the density of maximal random sets", "[poisson]") {
  // Random sequential addition of discs jams at a coverage of 0.547, that is 0.697 / spacing^2.
  // Samples near the border have part of their disc outside: half a spacing or so belongs to them.
  const double spacing = 0.01;
  for (const int n : {1, 30}) {
    const auto samples = sample(plane(n, n, 1, 1), spacing);
    const double density = double(samples.size()) * spacing * spacing;
    CHECK(density > 0.69);
    CHECK(density < 0.725);
    // No quadrant is favoured by the order in which cells are filled.
    std::array<int, 4> quadrants{};
    const TriangleMesh mesh = plane(n, n, 1, 1);
    for (const auto& s : samples) {
      const Vec3 p = position(mesh, s);
      ++quadrants[(p.x() > 0.5) + 2 * (p.y() > 0.5)];
    }
    for (const int count : quadrants)
      CHECK(4.0 * count / double(samples.size()) == Approx(1).margin(0.03));
  }
}

TEST_CASE("the cube of the paper gets about 90000 samples", "[poisson]") {
  const double mean_edge = (12 * 2 + 6 * std::sqrt(8.0)) / 18;
  const auto samples = sample(cube(), 0.006 * mean_edge);
  CHECK(samples.size() > 88500);
  CHECK(samples.size() < 91500);
}

TEST_CASE("no pair among many samples is closer than the spacing, however acute the faces",
          "[poisson]") {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(-0.004, 0.004);
  TriangleMesh ragged = plane(120, 120, 1, 1);
  for (Vec3& p : ragged.positions) p += Vec3(uniform(random), uniform(random), uniform(random));
  for (const std::uint64_t seed : {2, 4}) {  // rare: one seed in three
    const auto samples = sample(ragged, 0.004, seed);
    CHECK(least_sample_distance(ragged, samples, 0.004) >= 0.004 * (1 - 1e-12));
  }
}

TEST_CASE("equal seeds give equal samples, different seeds different ones", "[poisson]") {
  const TriangleMesh mesh = sphere(3);
  const auto first = sample(mesh, 0.1, 5);
  CHECK(same(first, sample(mesh, 0.1, 5)));
  const auto second = sample(mesh, 0.1, 6);
  CHECK(!same(first, second));
  CHECK(!same(first, sample(mesh, 0.1, 5 + (std::uint64_t(1) << 32))));
  std::set<std::pair<double, double>> seen;
  for (const auto& s : first) seen.insert({s.barycentric[0], s.barycentric[1]});
  for (const auto& s : second) CHECK(!seen.count({s.barycentric[0], s.barycentric[1]}));
}

TEST_CASE("the leaves of a U-sheet get what the flat sheet gets", "[poisson]") {
  const double leaf = 1.2, height = 1, spacing = 0.025, gap = spacing / 4;
  for (const int n :
       {1, 24, 120}) {  // faces larger than, as large as, and smaller than the spacing
    std::vector<int> leaf_of_face;
    const TriangleMesh folded = u_sheet(leaf, height, gap, n, n == 1 ? 1 : n, &leaf_of_face);
    const auto flat = sample(plane(n, n, 2 * leaf, height), spacing);
    const auto samples = sample(folded, spacing);
    std::array<int, 3> counts{};
    for (const auto& s : samples) ++counts[std::size_t(leaf_of_face[s.face])];
    CAPTURE(n, flat.size(), counts[0], counts[1], counts[2]);
    CHECK(counts[0] == Approx(0.5 * double(flat.size())).epsilon(0.05));
    CHECK(counts[2] == Approx(0.5 * double(flat.size())).epsilon(0.05));
    CHECK(min_distance(folded, samples, leaf_of_face) >= spacing * (1 - 1e-12));
    CHECK(min_distance(folded, samples) < spacing);  // the leaves do lie within each other's balls
  }
}

TEST_CASE("sheets that don't touch are sampled as if each were alone", "[poisson]") {
  const TriangleMesh one = plane(3, 2, 1.5, 1);
  TriangleMesh other = one;
  for (Vec3& p : other.positions) p.z() += 1e-4;
  const double spacing = 0.03;
  const double alone = double(sample(one, spacing).size());
  const TriangleMesh both = join(one, other);
  std::vector<int> sheet_of_face(both.faces.size(), 0);
  std::fill(sheet_of_face.begin() + std::ptrdiff_t(one.faces.size()), sheet_of_face.end(), 1);
  const auto samples = sample(both, spacing);
  double first = 0;
  for (const auto& s : samples) first += sheet_of_face[s.face] == 0;
  CHECK(first == Approx(alone).epsilon(0.05));
  CHECK(double(samples.size()) - first == Approx(alone).epsilon(0.05));
  CHECK(min_distance(both, samples, sheet_of_face) >= spacing * (1 - 1e-12));
}

TEST_CASE("conflicts follow their definition on folds, books and pinwheels", "[poisson]") {
  const double spacing = 0.1;
  for (const TriangleMesh& mesh : {u_sheet(0.4, 0.3, 0.03, 5, 4), u_sheet(0.4, 0.3, 0.08, 1, 1),
                                   book(0.5, 0.3, 5, 3), pinwheel(2), pinwheel(12)}) {
    const auto samples = sample(mesh, spacing);
    CAPTURE(mesh.faces.size(), samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        CHECK(!conflict(mesh, samples[i], samples[j], spacing * (1 - 1e-12)));
    int uncovered = 0;
    for (const auto& p : random_points(mesh, 400, 3)) {
      bool covered = false;
      for (std::size_t i = 0; i < samples.size() && !covered; ++i)
        covered = conflict(mesh, p, samples[i], spacing * (1 + 2e-3));
      uncovered += !covered;
    }
    CHECK(uncovered == 0);
  }
}

TEST_CASE("faces in a ball are those that a flood of all faces finds", "[poisson]") {
  for (const TriangleMesh& mesh :
       {u_sheet(0.4, 0.3, 0.03, 5, 4), book(0.5, 0.3, 5, 3), sphere(2), pinwheel(12)}) {
    ConnectedBall ball(mesh);
    for (const double radius : {0.01, 0.1, 0.4, 5.0})
      for (const auto& p : random_points(mesh, 20, 8)) {
        const auto& faces = ball.find(p.face, position(mesh, p), radius);
        CHECK(faces.front() == p.face);
        const std::set<Index> found(faces.begin(), faces.end());
        CHECK(found.size() == faces.size());
        CHECK(found == flood(mesh, p, radius));
        for (Index f = 0; f < Index(mesh.faces.size()); ++f)
          if (ball.found(f) != bool(found.count(f))) FAIL("marks and list differ");
      }
  }
}

TEST_CASE("a spacing larger than the mesh gives one sample per component", "[poisson]") {
  TriangleMesh shifted = cube();
  for (Vec3& p : shifted.positions) p.x() += 2.5;
  CHECK(sample(cube(), 10).size() == 1);
  CHECK(sample(sphere(4), 10).size() == 1);
  CHECK(sample(join(cube(), shifted), 10).size() == 2);
}

TEST_CASE("only the faces asked for are sampled, up to their edge", "[poisson]") {
  const TriangleMesh mesh = cube();
  std::vector<bool> faces(12, false);
  faces[2] = faces[3] = true;  // z = 1
  const double spacing = 0.08;
  const auto samples = sample(mesh, spacing, 1, faces);
  TriangleMesh side = mesh;
  side.faces = {mesh.faces[2], mesh.faces[3]};
  for (const auto& s : samples) REQUIRE((s.face == 2 || s.face == 3));
  std::vector<SurfacePoint> on_side = samples;
  for (auto& s : on_side) s.face -= 2;
  CHECK(min_distance(side, on_side) >= spacing * (1 - 1e-12));
  CHECK(largest_gap(side, on_side, 10000) <= spacing * (1 + 1e-3));
}

TEST_CASE("slivers are sampled along their length", "[poisson]") {
  // 400 slivers of 1 x 2.5e-7 side by side, and faces without area among them.
  TriangleMesh strip = plane(1, 200, 1, 1e-4);
  strip.faces.push_back({0, 0, 1});
  strip.faces.push_back({0, 2, 4});
  const double spacing = 0.001;
  const auto samples = sample(strip, spacing);
  CHECK(samples.size() >= 500);
  CHECK(samples.size() <= 1001);
  CHECK(min_distance(strip, samples) >= spacing * (1 - 1e-12));
  CHECK(largest_gap(strip, samples, 10000) <= spacing * (1 + 1e-3));
}

TEST_CASE("duplicate faces share their samples", "[poisson]") {
  TriangleMesh mesh = plane(2, 2, 1, 1);
  const double spacing = 0.05;
  const double alone = double(sample(mesh, spacing).size());
  const auto faces = mesh.faces;
  mesh.faces.insert(mesh.faces.end(), faces.begin(), faces.end());
  const auto samples = sample(mesh, spacing);
  // Both copies are joined at their edges, so samples within a spacing of an edge conflict.
  const std::vector<SurfacePoint> near_edge = [&] {
    std::vector<SurfacePoint> result;
    for (const auto& s : samples)
      for (int k = 0; k < 3; ++k) {
        const auto t = mesh.corners(s.face);
        if (edge_distance(position(mesh, s), t[std::size_t(k)], t[std::size_t(k + 1) % 3]) <
            spacing) {
          result.push_back(s);
          break;
        }
      }
    return result;
  }();
  CHECK(min_distance(mesh, near_edge) >= spacing * (1 - 1e-12));
  CHECK(double(samples.size()) < 2 * alone);
}

TEST_CASE("the least distance leaves out pairs that the surface does not join", "[poisson]") {
  const double spacing = 0.1;
  const TriangleMesh folded = u_sheet(0.6, 0.5, 0.02, 6, 6);
  auto samples = sample(folded, spacing);
  const double least = least_sample_distance(folded, samples, spacing);
  CHECK(least >= spacing * (1 - 1e-12));
  CHECK(least < 1.1 * spacing);
  CHECK(min_distance(folded, samples) < spacing);
  const SurfacePoint extra{samples[0].face, {0.3, 0.3, 0.4}};  // too close to someone
  double nearest = 1e300;
  for (const auto& s : samples)
    if (conflict(folded, s, extra, spacing))
      nearest = std::min(nearest, (position(folded, s) - position(folded, extra)).norm());
  samples.push_back(extra);
  CHECK(least_sample_distance(folded, samples, spacing) == Approx(nearest).epsilon(1e-12));
  for (const TriangleMesh& mesh : {sphere(3), cube()}) {
    const auto whole = sample(mesh, 0.2);
    CHECK(least_sample_distance(mesh, whole, 0.2) ==
          Approx(min_distance(mesh, whole)).epsilon(1e-12));
  }
  CHECK(std::isinf(least_sample_distance(folded, {extra}, spacing)));
}

TEST_CASE("bad spacings and endless sample sets are refused at once", "[poisson]") {
  const TriangleMesh mesh = cube();
  for (const double spacing : {0.0, -1.0, std::nan(""), 1.0 / 0.0, 1e-200, 1e200})
    CHECK_THROWS_AS(sample(mesh, spacing), UsageError);
  CHECK_THROWS_AS(sample(mesh, 1e-4), InputError);
  CHECK_THROWS_AS(sample(mesh, 1e-100), InputError);
  CHECK_THROWS_AS(sample(plane(1, 1, 1, 1e-12), 1e-9), InputError);  // thin, but too long
  CHECK_THROWS_AS(sample(mesh, 0.1, 1, std::vector<bool>(12, false)), InputError);
  TriangleMesh flat;
  flat.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  flat.faces = {{0, 1, 2}};
  CHECK_THROWS_AS(sample(flat, 0.1), InputError);
}

TEST_CASE("progress grows to one and can cancel", "[poisson]") {
  PoissonOptions options;
  options.spacing = 0.02;
  double last = 0;
  bool grows = true;
  poisson_samples(cube(), options, [&](std::string_view, double done) {
    grows &= done >= last;
    last = done;
  });
  CHECK(grows);
  CHECK(last == 1);
  CHECK_THROWS_AS(poisson_samples(cube(), options,
                                  [](std::string_view, double done) {
                                    if (done > 0.3) throw std::runtime_error("cancelled");
                                  }),
                  std::runtime_error);
}
