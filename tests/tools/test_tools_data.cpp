// What info, map, compare and distance say and write.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "onmesh/image/image_io.h"
#include "onmesh/mesh_io/read_mesh.h"
#include "support/paths.h"
#include "support/run_program.h"

using namespace onmesh;
using Catch::Contains;

namespace {

std::vector<std::string> keys(const nlohmann::json& json) {
  std::vector<std::string> names;
  for (const auto& [name, value] : json.items()) names.push_back(name);
  return names;
}

int channel(const Image& image, const std::string& name) {
  const auto& names = image.channel_names;
  const auto at = std::find(names.begin(), names.end(), name);
  REQUIRE(at != names.end());
  return int(at - names.begin());
}

}  // namespace

TEST_CASE("info reports a sound mesh as such, under fixed names", "[tools][info]") {
  const Workspace space;
  space.must("make-mesh plane --segments 3 --width 2 --height 2 -o m.obj -t m.png --size 32");
  const auto json = space.must("info m.obj --json --strict").json();
  CHECK(keys(json) == std::vector<std::string>{"advice",
                                               "boundary_edges",
                                               "boundary_loops",
                                               "charts",
                                               "cleaning",
                                               "command",
                                               "components",
                                               "degenerate_faces",
                                               "degenerate_uvs",
                                               "density_max",
                                               "density_min",
                                               "diagonal",
                                               "duplicate_faces",
                                               "faces",
                                               "faces_without_uvs",
                                               "filterable",
                                               "inconsistent_edges",
                                               "manifold",
                                               "materials",
                                               "max_overlap",
                                               "mean_edge",
                                               "mesh",
                                               "mirrored_faces",
                                               "nonmanifold_edges",
                                               "nonmanifold_vertices",
                                               "onmesh",
                                               "orientable",
                                               "overlap_share",
                                               "peak_memory_bytes",
                                               "problems",
                                               "refusal",
                                               "surface_area",
                                               "textures",
                                               "uv_max",
                                               "uv_min",
                                               "vertices",
                                               "vertices_in_file",
                                               "warnings"});
  CHECK(json["faces"] == 18);
  CHECK(json["boundary_edges"] == 12);
  CHECK(json["boundary_loops"] == 1);
  CHECK(json["charts"] == 1);
  CHECK(json["surface_area"].get<double>() == Approx(4));
  CHECK(json["filterable"] == true);
  CHECK(json["problems"].empty());
  REQUIRE(json["textures"].size() == 1);
  const auto& texture = json["textures"][0];
  CHECK(texture["covered"] == 32 * 32);
  CHECK(texture["overlapped"] == 0);
  CHECK(texture["texel_size"].get<double>() == Approx(2.0 / 32));
  CHECK(texture["seams"]["edges"] == 0);
  CHECK_THAT(space.must("info m.obj").out, Contains("filter will take it"));
}

TEST_CASE("info --strict exits with 1 and says what to repair", "[tools][info]") {
  const Workspace space;
  space.must("make-mesh book -o book.obj -t book.png --size 16");
  const Run book = space.run("info book.obj --strict");
  CHECK(book.code == 1);
  CHECK_THAT(book.err, Contains("nonmanifold_edges"));
  CHECK_THAT(book.out, Contains("three or more faces") && Contains("filter will take it"));
  CHECK(space.run("info book.obj").code == 0);

  space.file("bare.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const Run bare = space.run("info bare.obj --strict --json");
  CHECK(bare.code == 1);
  CHECK(bare.json()["filterable"] == false);
  CHECK_THAT(bare.json()["refusal"].get<std::string>(), Contains("UVs"));

  space.file("lost.mtl", "newmtl m\nmap_Kd lost.png\n");
  space.file("lost.obj",
             "mtllib lost.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl m\n"
             "f 1/1 2/2 3/3\n");
  const Run lost = space.run("info lost.obj --strict");
  CHECK(lost.code == 1);
  CHECK_THAT(lost.out, Contains("lost.png (missing)"));
  CHECK_THAT(lost.err, Contains("textures"));
}

TEST_CASE("info counts texels that several faces share, and what cleaning leaves out",
          "[tools][info]") {
  const Workspace space;
  // Two squares over one and the same half of the atlas, and the first triangle a second time.
  space.file("m.obj",
             "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 3 0 0\nv 4 0 0\nv 4 1 0\nv 3 1 0\n"
             "vt 0 0\nvt 1 0\nvt 1 0.5\nvt 0 0.5\n"
             "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\nf 5/1 6/2 7/3\nf 5/1 7/3 8/4\nf 1/1 2/2 3/3\n");
  const auto json = space.must("info m.obj --resolution 8x8 --json").json();
  CHECK(json["duplicate_faces"] == 1);
  CHECK(json["cleaning"]["duplicates"] == 1);
  CHECK(json["textures"][0]["covered"] == 32);
  CHECK(json["textures"][0]["overlapped"] == 32);
  CHECK(json["textures"][0]["seams"].is_null());
  CHECK(json["max_overlap"] >= 2);
}

TEST_CASE("map writes the surface position of every texel in named channels", "[tools][map]") {
  const Workspace space;
  // The lower left triangle of the atlas, three units wide.
  space.file("m.obj", "v 0 0 1\nv 3 0 1\nv 0 3 1\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n");
  const auto json = space.must("map m.obj --resolution 12x12 -o m.exr --json").json();
  const Image image = read_image(space / "m.exr");
  CHECK(image.channel_names == json["channels"].get<std::vector<std::string>>());
  CHECK(image.channels == 11);
  int covered = 0;
  for (Index i = 0; i < 144; ++i) {
    const float* texel = image.texel(i);
    const auto value = [&](const char* name) { return texel[channel(image, name)]; };
    const double u = (i % 12 + 0.5) / 12, v = 1 - (i / 12 + 0.5) / 12;
    const bool inside = u + v <= 1 + 1e-9;
    CHECK((value("coverage") == 2) == inside);
    CHECK(value("face") == (inside ? 0 : -1));
    CHECK(value("chart") == (inside ? 0 : -1));
    CHECK(value("claims") == (inside ? 1 : 0));
    if (!inside) continue;
    ++covered;
    CHECK(value("x") == Approx(3 * u));
    CHECK(value("y") == Approx(3 * v));
    CHECK(value("z") == Approx(1));
    CHECK(value("b1") == Approx(u));
    CHECK(value("b2") == Approx(v));
    CHECK(value("b0") == Approx(1 - u - v).margin(1e-6));
    CHECK(value("area") == Approx(9.0 / 144));
  }
  CHECK(json["covered"] == covered);
}

TEST_CASE("compare finds the worst texel and fails below the asked PSNR", "[tools][compare]") {
  const Workspace space;
  Image a = make_image(8, 4, 3), b = a;
  b.texel(2 * 8 + 5)[1] = 0.5F;
  write_image(space / "a.exr", a);
  write_image(space / "b.exr", b);
  const double psnr = -10 * std::log10(0.25 / (8 * 4 * 3));
  const auto json = space.must("compare a.exr b.exr --json --fail 20").json();
  CHECK(json["psnr"].get<double>() == Approx(psnr));
  CHECK(json["max"] == 0.5);
  CHECK(json["worst_texel"] == nlohmann::json{5, 2});
  CHECK(json["texels"] == 32);
  CHECK(json["passed"] == true);
  CHECK_THAT(space.must("compare a.exr b.exr").out, Contains("column 5, row 2"));

  const Run failed = space.run("compare a.exr b.exr --fail 60 --json");
  CHECK(failed.code == 1);
  CHECK(failed.json()["passed"] == false);
  CHECK_THAT(failed.err, Contains("below --fail 60"));

  const auto equal = space.must("compare a.exr a.exr --fail 100 --json").json();
  CHECK(equal["equal"] == true);
  CHECK(equal["psnr"].is_null());  // infinite
  write_image(space / "wide.exr", make_image(9, 4, 3));
  const Run wide = space.run("compare a.exr wide.exr");
  CHECK(wide.code == 3);
  CHECK_THAT(wide.err, Contains("wide.exr") && Contains("a.exr"));
}

TEST_CASE("compare with a mesh looks at covered texels and seams only", "[tools][compare]") {
  const Workspace space;
  space.must("make-mesh cube -o m.obj -t a.png --size 64");
  Image b = read_image(space / "a.png");
  const auto map = space.must("map m.obj -t a.png -o map.exr --json").json();
  const Image where = read_image(space / "map.exr");
  const int coverage = channel(where, "coverage");
  Index outside = 0;
  while (where.texel(outside)[coverage] != 0) ++outside;
  b.texel(outside)[0] = b.texel(outside)[0] > 0.5F ? 0.0F : 1.0F;
  write_image(space / "b.png", b);
  CHECK(space.run("compare a.png b.png --fail 90").code == 1);
  const auto json = space.must("compare a.png b.png --mesh m.obj --fail 90 --json").json();
  CHECK(json["equal"] == true);
  CHECK(json["texels"] == map["covered"]);
  CHECK(json["seams_a"]["edges"].get<int>() > 0);
  CHECK(json["seams_a"] == json["seams_b"]);
}

TEST_CASE("distances on a plane are straight with every back end", "[tools][distance]") {
  const Workspace space;
  space.must("make-mesh plane --segments 4 -o m.obj -t m.png --size 64");
  const TriangleMesh mesh = read_mesh(space / "m.obj");
  for (const std::string method : {"unfold", "exact", "heat", "cloud"}) {
    INFO(method);
    const bool by_heat = method == "heat" || method == "cloud";
    const double tolerance = by_heat ? 0.035 : 1e-5 /* half the spacing */;
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

TEST_CASE("a cube as loose triangles gives the bytes of the cube", "[tools][filter]") {
  const Workspace space;
  space.must("make-mesh noisy-cube --segments 3 -o m.obj -t m.png --size 128");
  space.must("make-mesh noisy-cube --segments 3 --soup -o soup.obj");
  const auto soup = space.must("info soup.obj --json").json();
  CHECK(soup["vertices_in_file"] == 3 * soup["faces"].get<int>());
  space.must("filter m.obj -o a.png --sigma-spatial 3tx --quiet");
  space.must("filter soup.obj -t m.png -o b.png --sigma-spatial 3tx --quiet");
  CHECK(content_of(space / "a.png") == content_of(space / "b.png"));
}

TEST_CASE("real meshes that are not manifold are filtered, or told why not", "[tools][filter]") {
  const std::filesystem::path folder = shared_data();
  if (!std::filesystem::exists(folder)) {
    WARN("skipped: no ../shared/data");
    return;
  }
  const Workspace space;
  const Run flag =
      space.run("filter '" + (folder / "kenney_flag/flag.obj").string() + "' -o o.png");
  CHECK(flag.code == 3);
  CHECK_THAT(flag.err, Contains("no face have any area") && Contains("nothing to filter"));
  space.must("make-mesh plane -o m.obj -t small.png --size 128 --noise 0.2");
  for (const char* file :
       {"milk_truck/milk_truck.obj", "spider/spider.obj", "cup_scan/textured-0008192.obj"}) {
    INFO(file);
    const Run run = space.must("filter '" + (folder / file).string() +
                               "' -t small.png --material all -o o.exr --json");
    const Image image = read_image(space / "o.exr");
    bool within = true;
    for (const float v : image.pixels) within = within && v >= 0 && v <= 1;
    CHECK(within);
    const bool tie = std::string(file).rfind("milk", 0) == 0;
    CHECK((run.err.find("2 vertices join parts that share no edge") != std::string::npos) == tie);
    CHECK(run.json()["counts"]["texels"] > 1000);
  }
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
  for (const std::string name : {"unfold", "heat", "euclidean"}) {
    REQUIRE(rows.contains(name));
    CHECK(rows[name]["points"] == one["compare"]["points"]);
    CHECK(rows[name]["missed"] == 0);
    CHECK(rows[name]["wrong_weights"].get<double>() > 0);
    CHECK(rows[name]["seconds"].get<double>() >= 0);
  }
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
