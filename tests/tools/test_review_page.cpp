// What a review page holds: that of view, and that of filter --report.
#include "tools/review_page.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <string>

#include "onmesh/image/image_io.h"
#include "tools/tool_checks.h"

using namespace onmesh;
using Catch::Contains;

namespace {

/// A sphere with a noisy texture and what filtering makes of it.
struct NoisySphere : Workspace {
  NoisySphere() {
    must("make-mesh sphere --levels 2 -o m.obj -t m.png --size 128 --noise 0.3");
    must("filter m.obj -t m.png -o f.png --quiet");
  }
};

/// Values of an image's file as codes.
std::vector<std::uint8_t> codes_of(const Workspace& space, const std::string& name) {
  std::vector<std::uint8_t> codes;
  for (const float v : read_image(space / name).pixels)
    codes.push_back(std::uint8_t(std::lround(v * 255)));
  return codes;
}

}  // namespace

TEST_CASE("a page holds the model and its textures as they are", "[review_page]") {
  const NoisySphere space;
  space.must("view m.obj -t m.png --after f.png -o p.html");
  const ReviewPage page(space / "p.html");
  const auto& map = page.scene["maps"][0];
  CHECK(page.values<std::uint8_t>(map["before"][0]) == codes_of(space, "m.png"));
  CHECK(page.values<std::uint8_t>(map["after"][0][0]) == codes_of(space, "f.png"));

  const auto& mesh = page.scene["mesh"];
  const auto positions = page.values<float>(mesh["positions"]);
  const auto indices = page.values<std::uint16_t>(mesh["indices"]);
  CHECK(mesh["triangles"] == 320);
  CHECK(indices.size() == 960);
  // Every vertex lies on the sphere, and its normal points away from the centre.
  const auto origin = mesh["positions"]["origin"].get<std::vector<double>>();
  const auto normals = page.values<std::int8_t>(mesh["normals"]);
  for (std::size_t v = 0; v < positions.size() / 3; ++v) {
    double square = 0, along = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double p = origin[k] + positions[3 * v + k];
      square += p * p;
      along += p * normals[3 * v + k] / 127.0;
    }
    CHECK(square == Approx(1).margin(1e-5));
    CHECK(along > 0.97);
  }
}

TEST_CASE("a page's numbers are those of compare", "[review_page]") {
  const NoisySphere space;
  space.must("view m.obj -t m.png --after f.png -o p.html");
  const ReviewPage page(space / "p.html");
  const auto numbers = page.scene["maps"][0]["numbers"][0];
  const auto compared = space.must("compare m.png f.png --mesh m.obj --json").json();
  CHECK(numbers["psnr_db"].get<double>() == Approx(compared["psnr"].get<double>()));
  CHECK(numbers["max"].get<double>() == Approx(compared["max"].get<double>()));
  CHECK(numbers["seam_rms_before"].get<double>() ==
        Approx(compared["seams_a"]["rms"].get<double>()));
  CHECK(numbers["seam_rms_after"].get<double>() ==
        Approx(compared["seams_b"]["rms"].get<double>()));

  // The errors of its seam edges come to the same, over their lengths.
  const auto& seams = page.scene["seams"];
  const auto segments = page.values<float>(seams["segments"]);
  const auto errors = page.values<float>(seams["errors"][0][0]);
  REQUIRE(errors.size() == seams["count"].get<std::size_t>());
  REQUIRE(segments.size() == 6 * errors.size());
  double squares = 0, length = 0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const float* const s = &segments[6 * i];
    const double l = std::hypot(s[3] - s[0], s[4] - s[1], s[5] - s[2]);
    squares += l * errors[i] * errors[i];
    length += l;
  }
  CHECK(std::sqrt(squares / length) ==
        Approx(compared["seams_a"]["rms"].get<double>()).epsilon(1e-5));
}

TEST_CASE("distances, samples and nodes of a page lie on the surface", "[review_page]") {
  const Workspace space;
  space.must("make-mesh plane --segments 2 -o m.obj -t m.png --size 16");
  space.must("view m.obj -t m.png --distances point:0,0,0 --samples 5% --nodes 20% -o p.html");
  const ReviewPage page(space / "p.html");
  const auto& fields = page.scene["fields"];
  const auto at = page.values<float>(fields["positions"]);
  const auto distances = page.values<float>(fields["layers"][0]["values"]);
  const auto source = fields["layers"][0]["source"].get<std::vector<double>>();
  REQUIRE(distances.size() == at.size() / 3);
  REQUIRE(distances.size() > 1000);
  for (std::size_t v = 0; v < distances.size(); ++v) {
    const double straight =
        std::hypot(at[3 * v] - source[0], at[3 * v + 1] - source[1], at[3 * v + 2] - source[2]);
    CHECK(distances[v] == Approx(straight).margin(1e-5));
  }
  const auto samples = page.values<float>(page.scene["samples"]["positions"]);
  CHECK(samples.size() > 300);
  for (std::size_t i = 2; i < samples.size(); i += 3) CHECK(samples[i] == 0);
  // Edges of nodes: together as long as the triangulation's, each once.
  const auto segments = page.values<float>(page.scene["nodes"]["segments"]);
  CHECK(segments.size() >= 6 * page.scene["nodes"]["edges"].get<std::size_t>());
}

TEST_CASE("nodes as coarse as the mesh show the mesh's own edges", "[review_page]") {
  const Workspace space;
  space.must("make-mesh cube -o m.obj");
  space.must("view m.obj --nodes 10 -o p.html");
  const ReviewPage page(space / "p.html");
  CHECK(page.values<float>(page.scene["nodes"]["segments"]).size() == 6 * 18);
  CHECK(page.scene["maps"].empty());
  CHECK(page.scene["seams"].is_null());
}

TEST_CASE("names do a page no harm", "[review_page]") {
  const NoisySphere space;
  std::string name(180, 'x');
  name.insert(0, "a <script><!-- \"q\" \xc3\xa4 ");
  name += ".png";
  std::filesystem::copy(space / "f.png", space / name);
  space.must("view m.obj -t m.png --after '" + name + "' -o p.html");
  const ReviewPage page(space / "p.html");
  CHECK(page.scene["afters"][0]["name"] == name);
  // Nothing of it is markup: there are as many scripts as without it.
  space.must("view m.obj -t m.png --after f.png -o q.html");
  const auto count = [](const std::string& text, const std::string& what) {
    int n = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1))
      ++n;
    return n;
  };
  const ReviewPage plain(space / "q.html");
  for (const char* markup : {"<script", "</script", "<!--"})
    CHECK(count(page.text(), markup) == count(plain.text(), markup));
}

TEST_CASE("maps, tiles and materials can all be chosen", "[review_page]") {
  const NoisySphere space;
  std::filesystem::create_directory(space / "out");
  std::filesystem::copy(space / "f.png", space / "out/albedo.png");
  std::filesystem::copy(space / "m.png", space / "out/rough.png");
  std::filesystem::copy(space / "m.png", space / "albedo.png");
  std::filesystem::copy(space / "f.png", space / "rough.png");
  space.must("view m.obj -t albedo=albedo.png -t rough=rough.png@data --after out/ -o p.html");
  const ReviewPage page(space / "p.html");
  REQUIRE(page.scene["maps"].size() == 2);
  CHECK(page.scene["maps"][1]["name"] == "rough");
  CHECK(page.scene["maps"][1]["space"] == "data");
  CHECK(page.scene["afters"][0]["name"] == "out");
  CHECK(page.values<std::uint8_t>(page.scene["maps"][1]["after"][0][0]) ==
        codes_of(space, "m.png"));
}

TEST_CASE("what does not fit is said in the page", "[review_page]") {
  const NoisySphere space;
  space.must("make-mesh sphere --levels 2 -o other.obj -t small.png --size 64");
  space.must("view m.obj -t m.png --after small.png -o p.html");
  const ReviewPage page(space / "p.html");
  REQUIRE(page.scene["notes"].size() == 1);
  CHECK_THAT(page.scene["notes"][0].get<std::string>(), Contains("does not fit"));
  CHECK(page.scene["maps"][0]["numbers"][0].is_null());
}

TEST_CASE("filter writes the page of its run", "[review_page]") {
  const NoisySphere space;
  std::filesystem::copy(space / "m.png", space / "same.png");
  space.must("filter m.obj -t same.png -o same.png --report p.html --quiet");
  const ReviewPage page(space / "p.html");
  const auto& map = page.scene["maps"][0];
  CHECK(page.values<std::uint8_t>(map["before"][0]) == codes_of(space, "m.png"));
  CHECK(page.values<std::uint8_t>(map["after"][0][0]) == codes_of(space, "f.png"));
  CHECK(page.scene["numbers"][0]["title"] == "Run");
  CHECK(page.scene["view_command"][1] == "view");
  check_refused(space, "filter m.obj -t m.png -o x.png --report x.png", 2, "ends in .html");
  check_refused(space, "filter m.obj -t m.png -o x.png --report no/x.html", 4, "no/x.html");
}

TEST_CASE("pages refuse what they cannot show", "[review_page]") {
  const NoisySphere space;
  check_refused(space, "view m.obj -t m.png --size 64 -o p.html", 2, "--size: only for pictures");
  check_refused(space, "view m.obj -t m.png --samples 1% -o p.png", 2,
                "--samples: only for a page");
  check_refused(space, "view m.obj --distances vertex:9999 -o p.html", 2, "--distances: 9999");
  check_refused(space, "view m.obj --distances corner:1 -o p.html", 2, "--distances: 'corner:1'");
  check_refused(space, "view m.obj --distances uv:1 -o p.html", 2, "--distances: 'uv:1'");
  check_refused(space, "view m.obj -t m.png --samples 1e-9 -o p.html", 2, "too many for a page");
  check_refused(space, "view m.obj -t no.png -o p.html", 4, "no.png");
  check_refused(space, "view m.obj -t m.png --after no.png -o p.html", 4, "no.png");
  check_refused(space, "view no.obj -o p.html", 4, "no.obj");
  check_refused(space, "view m.obj --extent 1 -o p.html", 2, "--extent");
}

TEST_CASE("a picture can be taken of a part of the model", "[review_page][tools]") {
  const Workspace space;
  // A checker in the plane: its middle, half as high, is what the middle of the whole shows.
  space.must("make-mesh plane -o m.obj -t m.png --size 256");
  const std::string camera = " --azimuth 0 --elevation 0 --no-light --target 0,0,0 ";
  space.must("view m.obj -t m.png -o near.png --size 128 --extent 0.25" + camera);
  space.must("view m.obj -t m.png -o far.png --size 256 --extent 0.5" + camera);
  const Image near = read_image(space / "near.png"), far = read_image(space / "far.png");
  double squares = 0;
  for (int y = 8; y < 120; ++y) {
    for (int x = 8; x < 120; ++x) {
      const float a = near.texel(Index(y * 128 + x))[0];
      const float b = far.texel(Index((y + 64) * 256 + x + 64))[0];
      squares += (a - b) * (a - b);
    }
  }
  CHECK(std::sqrt(squares / (112 * 112)) < 0.02);
}
