#include "onmesh/render/render.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "onmesh/base/error.h"
#include "onmesh/image/lookup.h"
#include "onmesh/procedural/shapes.h"
#include "support/pictures.h"

using namespace onmesh;

namespace {

const Vec3 kBlack(0, 0, 0);

// Two squares facing +z, the red one (material 0) at z = `red`, the other at z = 0.
TriangleMesh two_squares(double red, bool red_first) {
  TriangleMesh mesh;
  mesh.materials = {{"red", ""}, {"blue", ""}};
  for (const bool first : {red_first, !red_first}) {
    const auto v = Index(mesh.positions.size());
    const double z = first ? red : 0;
    mesh.positions.insert(mesh.positions.end(), {{0, 0, z}, {1, 0, z}, {1, 1, z}, {0, 1, z}});
    mesh.faces.insert(mesh.faces.end(), {{v, v + 1, v + 2}, {v, v + 2, v + 3}});
    mesh.face_uvs.insert(mesh.face_uvs.end(), 2, {kNone, kNone, kNone});
    mesh.face_materials.insert(mesh.face_materials.end(), 2, first ? 0 : 1);
  }
  return mesh;
}

}  // namespace

TEST_CASE("a textured square that faces the camera shows its texture", "[render]") {
  const Image texture = make_texture(64, 64, Pattern::noise, 0, 5);
  RenderColour colour;
  colour.texture = &texture;
  const RenderOptions options = facing(256);
  const Image picture = render(make_plane(3, 3), colour, options);
  // The square takes .92 of the picture; every pixel is the mean of its 2 x 2 look-ups.
  const double side = 0.92 * 256;
  double worst = 0;
  for (int y = 16; y < 240; ++y) {
    for (int x = 16; x < 240; ++x) {
      Vec3 expected = Vec3::Zero();
      for (int k = 0; k < 4; ++k) {
        const Vec2 at(x + 0.25 + 0.5 * (k % 2), y + 0.25 + 0.5 * (k / 2));
        float value[3];
        bilinear(texture, Wrap::repeat, {0.5 + (at.x() - 128) / side, 0.5 - (at.y() - 128) / side},
                 value);
        expected += Vec3(value[0], value[1], value[2]) / 4;
      }
      worst = std::max(worst, (pixel(picture, x, y) - expected).cwiseAbs().maxCoeff());
    }
  }
  CHECK(worst < 2e-3);  // corners are rounded to 1/256 of a sample
  CHECK(pixel(picture, 4, 128) == kBlack);
}

TEST_CASE("the nearer face hides the farther one, whatever their order", "[render]") {
  RenderColour colour;
  colour.by_material = true;
  const Image red_in_front = render(two_squares(0.2, true), colour, facing(32));
  CHECK(red_in_front.pixels == render(two_squares(0.2, false), colour, facing(32)).pixels);
  const Image blue_in_front = render(two_squares(-0.2, true), colour, facing(32));
  CHECK(blue_in_front.pixels == render(two_squares(-0.2, false), colour, facing(32)).pixels);
  CHECK((pixel(red_in_front, 16, 16) - pixel(blue_in_front, 16, 16)).norm() > 0.2);
}

TEST_CASE("a sphere has no holes", "[render]") {
  RenderOptions options = facing(300);
  options.supersampling = 1;
  const Image picture = render(make_sphere(4), {}, options);
  int holes = 0;
  for (int y = 0; y < 300; ++y) {
    for (int x = 0; x < 300; ++x) {
      const bool within = std::hypot(x + 0.5 - 150, y + 0.5 - 150) < 0.45 * 300;
      holes += within && pixel(picture, x, y) == kBlack;
    }
  }
  CHECK(holes == 0);
}

TEST_CASE("pictures of every shape hold numbers from 0 to 1, light or not", "[render]") {
  const Image texture = make_texture(32, 32, Pattern::dots, 0.1, 1);
  RenderColour colour;
  colour.texture = &texture;
  std::vector<TriangleMesh> meshes{make_cube(2), make_torus(8, 5), make_book(1), make_chest(),
                                   make_cone(100, 5, 2)};
  // Degenerate faces, faces without UVs, a mesh of one point.
  TriangleMesh bad = make_plane(1, 1);
  bad.faces.push_back({0, 0, 1});
  bad.face_uvs.push_back({0, 0, 1});
  bad.face_uvs[0] = {kNone, 0, 1};
  bad.face_materials.push_back(kNone);
  meshes.push_back(bad);
  TriangleMesh point = bad;
  for (Vec3& p : point.positions) p = Vec3(1e6, 2, 3);
  meshes.push_back(point);
  for (const TriangleMesh& mesh : meshes) {
    bool shows = false;
    for (const bool light : {true, false}) {
      for (const double elevation : {-90.0, -20.0, 0.0, 90.0}) {
        RenderOptions options;
        options.width = 70, options.height = 50;
        options.elevation_degrees = elevation;
        options.light = light;
        options.wireframe = light;
        const Image picture = render(mesh, colour, options);
        CHECK(std::all_of(picture.pixels.begin(), picture.pixels.end(),
                          [](float v) { return v >= 0 && v <= 1; }));
        shows = shows || std::any_of(picture.pixels.begin(), picture.pixels.end(),
                                     [](float v) { return v > 0; });
      }
    }
    CHECK((shows || &mesh == &meshes.back()));  // a point need not be seen
  }
}

TEST_CASE("texture values out of range are clamped, missing ones are magenta", "[render]") {
  Image texture = make_image(2, 2, 1);
  texture.pixels.assign(4, 7.0F);
  RenderColour colour;
  colour.texture = &texture;
  CHECK(pixel(render(make_plane(1, 1), colour, facing(16)), 8, 8) == Vec3(1, 1, 1));
  texture.pixels.assign(4, std::numeric_limits<float>::quiet_NaN());
  CHECK(pixel(render(make_plane(1, 1), colour, facing(16)), 8, 8) == Vec3(1, 0, 1));
}

TEST_CASE("the picture does not depend on the number of threads", "[render]") {
  const TriangleMesh mesh = make_blob(3, 2);
  const Image texture = make_texture(64, 64, Pattern::checker, 0.2, 5);
  RenderColour colour;
  colour.texture = &texture;
  RenderOptions options;
  options.width = options.height = 150;
  Image one, many;
  tbb::task_arena(1).execute([&] { one = render(mesh, colour, options); });
  tbb::task_arena(2).execute([&] { many = render(mesh, colour, options); });
  CHECK(one.pixels == many.pixels);
}

TEST_CASE("isolines lie where the scalar is a multiple of the step", "[render]") {
  const TriangleMesh mesh = make_plane(4, 4);
  std::vector<double> scalar;
  for (const Vec3& p : mesh.positions) scalar.push_back(p.x());
  RenderColour colour;
  colour.scalar = &scalar;
  colour.isoline_step = 0.1;
  const Image lines = render(mesh, colour, facing(400));
  colour.isoline_step = -1;
  const Image plain = render(mesh, colour, facing(400));
  for (int k = 1; k < 10; ++k) {
    // Pixels: the plane reaches from 16 to 384.
    const int on = int(16 + 368 * 0.1 * k), off = int(16 + 368 * (0.1 * k - 0.05));
    CHECK(pixel(lines, on, 200).sum() < 0.75 * pixel(plain, on, 200).sum());
    CHECK(pixel(lines, off, 200) == pixel(plain, off, 200));
  }
}

TEST_CASE("the colour map rises in lightness without leaving the range", "[render]") {
  double before = -1;
  for (int i = 0; i <= 50; ++i) {
    const Vec3 colour = colour_map(i / 50.0);
    CHECK(colour.minCoeff() >= 0);
    CHECK(colour.maxCoeff() <= 1);
    const double luma = colour.dot(Vec3(0.2126, 0.7152, 0.0722));
    CHECK(luma > before);
    before = luma;
  }
}

TEST_CASE("faces are drawn with textures of their own", "[render]") {
  const TriangleMesh mesh = make_plane(2, 1);
  Image left = make_image(1, 1, 3), right = make_image(1, 1, 3);
  left.pixels = {1, 0, 0};
  right.pixels = {0, 1, 0};
  RenderColour colour;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const auto p = mesh.corners(f);
    colour.face_textures.push_back((p[0] + p[1] + p[2]).x() / 3 < 0.5 ? &left : &right);
  }
  const Image picture = render(mesh, colour, facing(32));
  CHECK(pixel(picture, 8, 16) == Vec3(1, 0, 0));
  CHECK(pixel(picture, 24, 16) == Vec3(0, 1, 0));
  std::replace(colour.face_textures.begin(), colour.face_textures.end(),
               static_cast<const Image*>(&right), static_cast<const Image*>(nullptr));
  const Vec3 grey = pixel(render(mesh, colour, facing(32)), 24, 16);
  CHECK(grey[0] == grey[1]);
  CHECK(grey[0] == grey[2]);
}

TEST_CASE("options outside their domain are refused", "[render]") {
  const TriangleMesh mesh = make_plane(1, 1);
  RenderOptions options;
  options.width = 0;
  CHECK_THROWS_AS(render(mesh, {}, options), UsageError);
  options = {};
  options.zoom = std::nan("");
  CHECK_THROWS_AS(render(mesh, {}, options), UsageError);
  options = {};
  options.up = Vec3::Zero();
  CHECK_THROWS_AS(render(mesh, {}, options), UsageError);
  CHECK_THROWS_AS(render({}, {}, {}), InputError);
  const std::vector<double> scalar(3);
  RenderColour colour;
  colour.scalar = &scalar;
  CHECK_THROWS_AS(render(mesh, colour, {}), InputError);
}

TEST_CASE("a material's wrap mode goes before the picture's", "[render]") {
  const Image texture = make_texture(16, 16, Pattern::noise, 0, 5);
  TriangleMesh mesh = make_plane(1, 1, 2, 2);
  for (Vec2& uv : mesh.uvs) uv *= 2;
  RenderColour colour;
  colour.texture = &texture;
  RenderOptions options;
  options.width = options.height = 64;
  options.light = false;
  const auto picture = [&](std::optional<WrapModes> material, WrapModes otherwise) {
    mesh.materials = {{"m", {}, material}};
    mesh.face_materials.assign(mesh.faces.size(), 0);
    options.wrap = otherwise;
    return render(mesh, colour, options).pixels;
  };
  const auto mirrored = picture({}, Wrap::mirror);
  CHECK(picture(Wrap::mirror, Wrap::repeat) == mirrored);
  CHECK(picture({}, Wrap::repeat) != mirrored);
  CHECK(picture(WrapModes(Wrap::mirror, Wrap::repeat), Wrap::mirror) != mirrored);
}
