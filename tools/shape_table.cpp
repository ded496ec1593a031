#include "shape_table.h"

#include <algorithm>

#include "onmesh/procedural/shapes.h"

namespace onmesh::tools {
namespace {

TriangleMesh plane(ShapeParameters& p) {
  const int n = p.integer("segments", 1);
  return make_plane(n, n, p.number("width", 1), p.number("height", 1));
}

TriangleMesh stretched_plane(ShapeParameters& p) {
  const int n = p.integer("segments", 1);
  return make_plane(n, n, p.number("width", 2), p.number("height", 1));
}

TriangleMesh folded_sheet(ShapeParameters& p) {
  const double width = p.number("width", 1), height = p.number("height", 1);
  return make_folded_sheet(p.integer("leaves", 5), width, height, p.number("angle", 80));
}

TriangleMesh u_sheet(ShapeParameters& p) {
  const double leaf = p.number("leaf", 1), height = p.number("height", 1);
  return make_u_sheet(leaf, height, p.number("gap", 0.01), p.integer("segments", 4));
}

TriangleMesh gentle_sheet(ShapeParameters& p) {
  return make_gentle_sheet(p.integer("segments", 32), p.number("amplitude", 0.08));
}

TriangleMesh cube(ShapeParameters& p) { return make_cube(p.integer("segments", 1)); }

TriangleMesh sphere(ShapeParameters& p) { return make_sphere(p.integer("levels", 4)); }

TriangleMesh torus(ShapeParameters& p) {
  const int n = p.integer("segments", 64);
  return make_torus(n, std::max(3, n / 2), p.number("radius", 1), p.number("minor-radius", 0.4));
}

TriangleMesh cone(ShapeParameters& p) {
  const int n = p.integer("segments", 36);
  return make_cone(p.number("sector", 270), n, p.integer("rings", 4));
}

TriangleMesh cylinder(ShapeParameters& p) {
  const int n = p.integer("segments", 48), rings = p.integer("rings", 1);
  return make_cylinder(n, rings, p.number("radius", 1), p.number("height", 2));
}

TriangleMesh saddle(ShapeParameters& p) {
  return make_saddle(p.integer("segments", 32), p.number("amplitude", 0.5));
}

TriangleMesh blob(ShapeParameters& p) {
  return make_blob(p.integer("levels", 4), p.seed(), p.number("amplitude", 0.45));
}

TriangleMesh book(ShapeParameters& p) {
  return make_book(p.integer("segments", 4), p.number("angle", 40));
}

TriangleMesh bow_tie(ShapeParameters& p) { return make_bow_tie(p.integer("segments", 4)); }

TriangleMesh moebius(ShapeParameters& p) {
  const double length = p.number("length", 8), width = p.number("width", 1);
  return make_moebius(p.integer("segments", 4), length, width);
}

TriangleMesh chest(ShapeParameters& p) {
  return make_chest(p.integer("segments", 1), p.number("gap", 0.05));
}

}  // namespace

double ShapeParameters::number(const std::string& name, double fallback) {
  known_.insert(name);
  return arguments_.has(name) ? arguments_.number(name, -1e9, 1e9) : fallback;
}

int ShapeParameters::integer(const std::string& name, int fallback) {
  known_.insert(name);
  return arguments_.has(name) ? int(arguments_.integer(name, 0, 8192)) : fallback;
}

std::uint64_t ShapeParameters::seed() const {
  return std::uint64_t(arguments_.integer("seed", 0, INT64_MAX));
}

const std::vector<Shape>& shape_table() {
  static const std::vector<Shape> table = {
      {"plane", "a rectangle; --width 1, --height 1, --segments 1", 0, plane},
      {"stretched-plane", "the plane at --width 2 with the UVs and texture of the square", 0,
       stretched_plane},
      {"folded-sheet", "an accordion; --leaves 5, --angle 80, --width 1, --height 1", 0,
       folded_sheet},
      {"u-sheet", "two leaves close to each other; --leaf 1, --height 1, --gap 0.01, --segments 4",
       0, u_sheet},
      {"gentle-sheet", "a slightly curved sheet; --segments 32, --amplitude 0.08", 0, gentle_sheet},
      {"cube", "[-1,1]^3 in six charts; --segments 1", 0, cube},
      {"noisy-cube", "the cube with a noisy texture; --segments 1", 0.25, cube},
      {"sphere", "an icosphere in 20 charts; --levels 4", 0, sphere},
      {"torus", "one chart; --segments 64, --radius 1, --minor-radius 0.4", 0, torus},
      {"cone", "a developable cone; --sector 270, --segments 36, --rings 4", 0, cone},
      {"cylinder", "without caps; --segments 48, --rings 1, --radius 1, --height 2", 0, cylinder},
      {"saddle", "z = a (x^2 - y^2); --segments 32, --amplitude 0.5", 0, saddle},
      {"blob", "a bumpy sphere; --levels 4, --amplitude 0.45, shaped by --seed", 0, blob},
      {"book", "three pages on one spine (not manifold); --segments 4, --angle 40", 0, book},
      {"bow-tie", "two squares that share a corner (not manifold); --segments 4", 0, bow_tie},
      {"moebius", "a developable one-sided strip; --segments 4, --length 8, --width 1", 0, moebius},
      {"chest", "a box and a lid apart from it; --segments 1, --gap 0.05", 0, chest},
  };
  return table;
}

const std::vector<std::pair<const char*, const char*>>& shape_options() {
  static const std::vector<std::pair<const char*, const char*>> options = {
      {"segments", "segments per side or around"},
      {"width", "width, mesh units"},
      {"length", "length around, mesh units"},
      {"height", "height, mesh units"},
      {"leaves", "leaves of the accordion"},
      {"leaf", "length of a leaf, mesh units"},
      {"gap", "distance, mesh units"},
      {"angle", "degrees from leaf to leaf"},
      {"amplitude", "height of bumps"},
      {"levels", "subdivisions, 0 to 8"},
      {"radius", "radius, mesh units"},
      {"minor-radius", "radius of the tube"},
      {"sector", "degrees, 0 to 360"},
      {"rings", "segments along the slope"},
  };
  return options;
}

TriangleMesh make_shape(const Shape& shape, const Arguments& arguments) {
  ShapeParameters parameters(arguments);
  TriangleMesh mesh = shape.make(parameters);
  for (const auto& [name, help] : shape_options()) {
    if (!arguments.has(name) || parameters.known().count(name) > 0) continue;
    std::string list;
    for (const std::string& known : parameters.known()) list += " --" + known;
    throw UsageError(std::string("--") + name + ": " + shape.name + " takes only" + list);
  }
  return mesh;
}

}  // namespace onmesh::tools
