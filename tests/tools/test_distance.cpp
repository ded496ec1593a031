// What distance computes and compares.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "onmesh/image/image_io.h"
#include "onmesh/mesh_io/read_mesh.h"
#include "tools/tool_checks.h"

using namespace onmesh;
using Catch::Contains;

TEST_CASE("distances on a plane are straight with every back end", "[tools][distance][slow]") {
  const Workspace space;
  space.must("make-mesh plane --segments 4 -o m.obj -t m.png --size 64");
  const TriangleMesh mesh = read_mesh(space / "m.obj");
  for (const std::string method : {"unfold", "exact", "heat", "cloud"}) {
    INFO(method);
    const bool by_heat = method == "heat" || method == "cloud";
    const double tolerance = by_heat ? 0.01 : 1e-5 /* a fifth of the spacing */;
    const auto json = space
                          .must("distance m.obj --uv 0.3,0.6 --spacing 5% -o d.ply --json" +
                                std::string(method == "exact" ? " --nodes-ply n.ply" : "") +
                                " --texture d.exr -t m.png --distance " + method)
                          .json();
    CHECK(json["backend"] == method);
    CHECK(json["vertices_reached"] == 25);
    const auto& p = json["source"]["position"];
    const Vec3 source(p[0], p[1], p[2]);
    auto columns = ply_columns(space / "d.ply");
    REQUIRE(columns["distance"].size() == 25);
    for (std::size_t i = 0; i < 25; ++i) {
      const Vec3 at(columns["x"][i], columns["y"][i], columns["z"][i]);
      CHECK(at == mesh.positions[i]);
      CHECK(std::abs(columns["distance"][i] - (at - source).norm()) < tolerance);
    }
    const Image image = read_image(space / "d.exr");
    CHECK(image.channels == 1);
    double worst = 0;
    for (Index i = 0; i < 64 * 64; ++i) {
      const double u = (i % 64 + 0.5) / 64 - 0.3, v = 1 - (i / 64 + 0.5) / 64 - 0.6;
      worst = std::max(worst, std::abs(image.texel(i)[0] - std::hypot(u, v)));
    }
    CHECK(worst < tolerance);
  }
}

TEST_CASE("a bridge leads distances over to the other component", "[tools][distance]") {
  const Workspace space;
  space.must("make-mesh chest --segments 2 --gap 0.05 -o m.obj -t m.png --size 32");
  const std::string base = "distance m.obj --vertex 0 --json --bridge ";
  const auto apart = space.must(base + "0").json(), narrow = space.must(base + "0.04").json();
  const auto joined = space.must(base + "0.06").json();
  CHECK(apart["vertices_reached"] == narrow["vertices_reached"]);
  CHECK(apart["refinement"] == "intrinsic");
  CHECK(narrow["bridges"] == 0);
  CHECK(joined["bridges"] > 0);
  CHECK(joined["vertices_reached"] == joined["vertices"]);
  for (const char* const method : {"heat", "cloud"}) {
    const auto other = space.must(base + "0.06 --distance " + method).json();
    CHECK(other["vertices_reached"] == joined["vertices_reached"]);
  }
  CHECK(space.run(base + "0.06 --distance exact").code == 2);
  CHECK(space.run(base + "0.06 --compare exact").code == 2);
  CHECK(space.run(base + "-1").code == 2);
  CHECK(space.run("filter m.obj -o o.png --bridge 0.06 --distance exact").code == 2);
  const auto report = space.must("filter m.obj -o o.png --bridge 0.06 --json --quiet").json();
  CHECK(report["counts"]["bridges"] > 0);
  CHECK(report["refinement"] == "bisection");
}

TEST_CASE("distances stop at the radius and never reach another component", "[tools][distance]") {
  const Workspace space;
  space.must("make-mesh chest --segments 2 -o m.obj -t m.png --size 32");
  const auto components = space.must("info m.obj --json").json();
  REQUIRE(components["components"] == 2);
  const auto all = space.must("distance m.obj --vertex 0 -o d.ply --json").json();
  const auto distance = ply_columns(space / "d.ply")["distance"];
  const auto missing =
      std::count_if(distance.begin(), distance.end(), [](double d) { return std::isnan(d); });
  CHECK(missing > 0);
  CHECK(missing < long(distance.size()));
  CHECK(all["vertices_reached"].get<long>() == long(distance.size()) - missing);
  const double radius = all["farthest"].get<double>() / 2;
  space.must("distance m.obj --vertex 0 -o r.ply --radius " + std::to_string(radius));
  const auto bounded = ply_columns(space / "r.ply")["distance"];
  for (std::size_t i = 0; i < distance.size(); ++i) {
    if (distance[i] < 0.999 * radius) CHECK(bounded[i] == Approx(distance[i]).margin(1e-3));
    if (!(distance[i] < 1.001 * radius)) CHECK(std::isnan(bounded[i]));
  }
}

TEST_CASE("the source vertex is the file's, also where the file is split at seams",
          "[tools][distance]") {
  const Workspace space;
  // Two triangles that share an edge by position only; vertex 4 repeats vertex 2.
  space.file("m.obj",
             "v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n"
             "f 2 3 4\nf 5 7 6\n");
  space.must("distance m.obj --vertex 4 -o d.ply --distance exact");
  auto columns = ply_columns(space / "d.ply");
  REQUIRE(columns["x"].size() == 4);
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 at(columns["x"][i], columns["y"][i], columns["z"][i]);
    CHECK(columns["distance"][i] == Approx((at - Vec3(1, 0, 0)).norm()).margin(1e-12));
  }
  const Run unused = space.run("distance m.obj --vertex 0");
  CHECK(unused.code == 2);
  CHECK_THAT(unused.err, Contains("--vertex: 0: no face"));
  // A point off the surface goes to the closest one.
  const auto json = space.must("distance m.obj --point 0.5,0.5,2 --json").json();
  CHECK(json["source"]["off_surface"].get<double>() == Approx(2));
  CHECK(json["source"]["position"][0].get<double>() == Approx(0.5));
}

TEST_CASE("the error against exact distances is small and shrinks with the spacing",
          "[tools][distance]") {
  const Workspace space;
  space.must("make-mesh blob --levels 3 -o m.obj");
  const std::string base = "distance m.obj --vertex 7 --radius 25% --compare exact --json ";
  const auto coarse = space.must(base + "--spacing 5%").json()["compare"];
  const auto fine = space.must(base + "--spacing 1%").json()["compare"];
  CHECK(keys(fine) == std::vector<std::string>{"max", "max_in_sigma", "mean", "mean_in_sigma",
                                               "missed", "p99", "p99_in_sigma", "points", "sigma",
                                               "wrong_weights"});
  CHECK(fine["points"].get<int>() > coarse["points"].get<int>());
  CHECK(fine["mean"].get<double>() < coarse["mean"].get<double>());
  CHECK(fine["mean_in_sigma"].get<double>() < 0.01);
  CHECK(fine["mean"] <= fine["p99"]);
  CHECK(fine["p99"] <= fine["max"]);
  const Run text = space.must(
      "distance m.obj --vertex 7 --radius 25% --spacing 5% --compare exact --distance heat");
  CHECK_THAT(text.out, Contains("error of heat against exact") && Contains("p99") &&
                           Contains("sigma = radius / 2.5"));
}

TEST_CASE("all back ends are compared side by side", "[tools][distance]") {
  const Workspace space;
  space.must("make-mesh blob --levels 3 -o m.obj");
  const std::string base = "distance m.obj --vertex 7 --radius 25% --spacing 5% ";
  const auto one = space.must(base + "--compare exact --distance heat --json").json();
  const auto all = space.must(base + "--compare all --json").json();
  CHECK(one["compare_all"].is_null());
  const auto& rows = all["compare_all"];
  double seconds = 0;
  for (const std::string name : {"unfold", "heat", "euclidean"}) {
    REQUIRE(rows.contains(name));
    CHECK(rows[name]["points"] == one["compare"]["points"]);
    CHECK(rows[name]["missed"] == 0);
    CHECK(rows[name]["wrong_weights"].get<double>() > 0);
    CHECK(rows[name]["wrong_weights"].get<double>() < (name == "euclidean" ? 0.05 : 0.003));
    CHECK(rows[name]["seconds"].get<double>() > 0);
    seconds += rows[name]["seconds"].get<double>();
  }
  CHECK(seconds <= all["seconds"]["compare"].get<double>());
  // The chosen back end's numbers are those it has alone; geodesic ones beat straight lines.
  CHECK(rows["heat"]["mean"] == one["compare"]["mean"]);
  CHECK(rows["unfold"]["mean"] == all["compare"]["mean"]);
  for (const char* measure : {"mean_in_sigma", "wrong_weights"}) {
    CHECK(rows["unfold"][measure] < rows["euclidean"][measure]);
    CHECK(rows["heat"][measure] < rows["euclidean"][measure]);
  }
  // A wider Gaussian makes the same errors matter less.
  const auto wide = space.must(base + "--compare all --sigma 50% --json").json()["compare_all"];
  CHECK(wide["heat"]["mean"] == rows["heat"]["mean"]);
  CHECK(wide["heat"]["wrong_weights"] < rows["heat"]["wrong_weights"]);
  const Run text = space.must(base + "--compare all --sigma 5% --distance exact");
  CHECK_THAT(text.out, Contains("in sigma = ") && Contains("wrong weights") &&
                           Contains("\n  unfold ") && Contains("\n  heat ") &&
                           Contains("\n  euclidean "));
  // Without a radius and a sigma there is no Gaussian.
  CHECK_THAT(space.must("distance m.obj --vertex 7 --spacing 5% --compare all").out,
             Contains("in mesh units") && !Contains("weights"));
  CHECK(space.run("distance m.obj --vertex 7 --sigma 5%").code == 2);
  CHECK(space.run("distance m.obj --vertex 7 --compare none").code == 2);
}
