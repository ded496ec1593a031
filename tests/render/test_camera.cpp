#include "onmesh/render/camera.h"

#include <catch2/catch.hpp>

#include "onmesh/procedural/shapes.h"
#include "support/pictures.h"

using namespace onmesh;

TEST_CASE("the camera stands where azimuth, elevation and up say", "[camera]") {
  const TriangleMesh mesh = make_cube();
  RenderOptions options = facing(100);
  const auto direction = [&] { return Camera(mesh, options).eye().normalized(); };
  CHECK((direction() - Vec3(0, 0, 1)).norm() < 1e-12);
  options.azimuth_degrees = 90;
  CHECK((direction() - Vec3(1, 0, 0)).norm() < 1e-12);
  options.elevation_degrees = 90;
  CHECK((direction() - Vec3(0, 1, 0)).norm() < 1e-12);
  options.up = Vec3(0, 0, 5);
  CHECK((direction() - Vec3(0, 0, 1)).norm() < 1e-12);
  options.elevation_degrees = options.azimuth_degrees = 0;
  CHECK((direction() - Vec3(0, -1, 0)).norm() < 1e-12);
  // Up is up in the picture.
  const Camera camera(mesh, options);
  CHECK(camera.project(Vec3(0, 0, 1)).y() < camera.project(Vec3(0, 0, -1)).y());
  CHECK(camera.project(Vec3(1, 0, 0)).x() > camera.project(Vec3(-1, 0, 0)).x());
}
