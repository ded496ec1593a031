// onmesh make-mesh: the parametric shapes of the library as OBJ with a texture.
#include "onmesh/procedural/shapes.h"

#include <algorithm>
#include <set>
#include <string_view>

#include "command.h"
#include "onmesh/image/image_io.h"
#include "onmesh/mesh_io/write_obj.h"
#include "onmesh/procedural/texture.h"

namespace onmesh::tools {
namespace {

// A shape's parameters as given; remembers which ones the shape asked for.
class Parameters {
 public:
  explicit Parameters(const po::variables_map& values) : values_(values) {}

  double number(const std::string& name, double fallback) {
    known_.insert(name);
    return has(values_, name) ? number_of(values_, name, -1e9, 1e9) : fallback;
  }
  int integer(const std::string& name, int fallback) {
    known_.insert(name);
    return has(values_, name) ? int(integer_of(values_, name, 0, 8192)) : fallback;
  }
  std::uint64_t seed() const { return std::uint64_t(integer_of(values_, "seed", 0, INT64_MAX)); }
  const std::set<std::string>& known() const { return known_; }

 private:
  const po::variables_map& values_;
  std::set<std::string> known_;
};

struct Shape {
  const char* name;
  const char* help;
  double noise;  // of its texture unless --noise says otherwise
  TriangleMesh (*make)(Parameters& p);
};

const Shape kShapes[] = {
    {"plane", "a rectangle; --width 1, --height 1, --segments 1", 0,
     [](Parameters& p) {
       const int n = p.integer("segments", 1);
       return make_plane(n, n, p.number("width", 1), p.number("height", 1));
     }},
    {"stretched-plane", "the plane at --width 2 with the UVs and texture of the square", 0,
     [](Parameters& p) {
       const int n = p.integer("segments", 1);
       return make_plane(n, n, p.number("width", 2), p.number("height", 1));
     }},
    {"folded-sheet", "an accordion; --leaves 5, --angle 80, --width 1, --height 1", 0,
     [](Parameters& p) {
       const double width = p.number("width", 1), height = p.number("height", 1);
       return make_folded_sheet(p.integer("leaves", 5), width, height, p.number("angle", 80));
     }},
    {"u-sheet", "two leaves close to each other; --leaf 1, --height 1, --gap 0.01, --segments 4", 0,
     [](Parameters& p) {
       const double leaf = p.number("leaf", 1), height = p.number("height", 1);
       return make_u_sheet(leaf, height, p.number("gap", 0.01), p.integer("segments", 4));
     }},
    {"gentle-sheet", "a slightly curved sheet; --segments 32, --amplitude 0.08", 0,
     [](Parameters& p) {
       return make_gentle_sheet(p.integer("segments", 32), p.number("amplitude", 0.08));
     }},
    {"cube", "[-1,1]^3 in six charts; --segments 1", 0,
     [](Parameters& p) { return make_cube(p.integer("segments", 1)); }},
    {"noisy-cube", "the cube with a noisy texture; --segments 1", 0.25,
     [](Parameters& p) { return make_cube(p.integer("segments", 1)); }},
    {"sphere", "an icosphere in 20 charts; --levels 4", 0,
     [](Parameters& p) { return make_sphere(p.integer("levels", 4)); }},
    {"torus", "one chart; --segments 64, --radius 1, --minor-radius 0.4", 0,
     [](Parameters& p) {
       const int n = p.integer("segments", 64);
       return make_torus(n, std::max(3, n / 2), p.number("radius", 1),
                         p.number("minor-radius", 0.4));
     }},
    {"cone", "a developable cone; --sector 270, --segments 36, --rings 4", 0,
     [](Parameters& p) {
       const int n = p.integer("segments", 36);
       return make_cone(p.number("sector", 270), n, p.integer("rings", 4));
     }},
    {"cylinder", "without caps; --segments 48, --rings 1, --radius 1, --height 2", 0,
     [](Parameters& p) {
       const int n = p.integer("segments", 48), rings = p.integer("rings", 1);
       return make_cylinder(n, rings, p.number("radius", 1), p.number("height", 2));
     }},
    {"saddle", "z = a (x^2 - y^2); --segments 32, --amplitude 0.5", 0,
     [](Parameters& p) {
       return make_saddle(p.integer("segments", 32), p.number("amplitude", 0.5));
     }},
    {"blob", "a bumpy sphere; --levels 4, --amplitude 0.45, shaped by --seed", 0,
     [](Parameters& p) {
       return make_blob(p.integer("levels", 4), p.seed(), p.number("amplitude", 0.45));
     }},
    {"book", "three pages on one spine (not manifold); --segments 4, --angle 40", 0,
     [](Parameters& p) { return make_book(p.integer("segments", 4), p.number("angle", 40)); }},
    {"bow-tie", "two squares that share a corner (not manifold); --segments 4", 0,
     [](Parameters& p) { return make_bow_tie(p.integer("segments", 4)); }},
    {"moebius", "a developable one-sided strip; --segments 4, --length 8, --width 1", 0,
     [](Parameters& p) {
       const double length = p.number("length", 8), width = p.number("width", 1);
       return make_moebius(p.integer("segments", 4), length, width);
     }},
    {"chest", "a box and a lid apart from it; --segments 1, --gap 0.05", 0,
     [](Parameters& p) { return make_chest(p.integer("segments", 1), p.number("gap", 0.05)); }},
};

// Options that belong to shapes; one that the shape at hand does not take is refused.
const std::pair<const char*, const char*> kShapeOptions[] = {
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

const std::pair<const char*, Pattern> kPatterns[] = {{"checker", Pattern::checker},
                                                     {"stripes", Pattern::stripes},
                                                     {"noise", Pattern::noise},
                                                     {"gradient", Pattern::gradient},
                                                     {"dots", Pattern::dots}};

// The entry of that name, or an error that lists what there is.
template <typename Entry, std::size_t N, typename NameOf>
const Entry& find_entry(const char* what, const std::string& name, const Entry (&entries)[N],
                        NameOf name_of) {
  std::string list;
  for (const Entry& entry : entries) {
    if (name == name_of(entry)) return entry;
    list += (list.empty() ? "" : ", ") + std::string(name_of(entry));
  }
  throw UsageError(std::string("unknown ") + what + " '" + name + "'; there are " + list);
}

TriangleMesh make_shape(const Shape& shape, const po::variables_map& values) {
  Parameters parameters(values);
  TriangleMesh mesh = shape.make(parameters);
  for (const auto& [name, help] : kShapeOptions) {
    if (!has(values, name) || parameters.known().count(name) > 0) continue;
    std::string list;
    for (const std::string& known : parameters.known()) list += " --" + known;
    throw UsageError(std::string("--") + name + ": " + shape.name + " takes only" + list);
  }
  return mesh;
}

Command make_command() {
  Command command;
  command.name = "make-mesh";
  command.synopsis = "SHAPE -o OUT.obj [-t TEXTURE] [options]";
  command.summary =
      "Writes a parametric mesh as OBJ, with a texture and its MTL if one is asked for. The "
      "pattern is\n"
      "carved out of space by the surface, so that it runs on across the atlas's seams.\n\n"
      "Shapes and the values of their options unless given:";
  for (const Shape& shape : kShapes) {
    const std::string name = shape.name;
    command.summary += "\n  " + name + std::string(17 - name.size(), ' ') + shape.help;
  }
  command.examples =
      "  onmesh make-mesh noisy-cube -o cube.obj -t cube.png\n"
      "  onmesh make-mesh torus --segments 128 -o torus.obj -t torus.png --pattern dots --size "
      "1024\n"
      "  onmesh make-mesh cone --sector 200 -o cone.obj\n";
  auto add = command.options.add_options();
  add("shape", text());
  add("output,o", text(), "the OBJ to write");
  add("texture,t", text(),
      "the texture to write, any image format; 8 bits where there is a choice");
  add("size", text("512"), "texels per side of the texture");
  add("pattern", text("checker"), "checker, stripes, noise, gradient or dots");
  add("cell", text(),
      "size of the pattern's cells, mesh units (default: an eighth of the longest side)");
  add("noise", text(), "amplitude of the noise per texel, 0 to 1 (default: 0; noisy-cube: 0.25)");
  add("seed", text("1"), "for noise, the patterns and the blob");
  for (const auto& [name, help] : kShapeOptions) add(name, text(), help);
  add("soup", flag(), "write loose triangles: every face gets vertices and UVs of its own");
  command.positional.add("shape", 1);
  return command;
}

}  // namespace

int run_make_mesh(const std::vector<std::string>& arguments) {
  const Command command = make_command();
  po::variables_map values;
  if (!parse(command, arguments, values)) return 0;
  const Shape& shape = find_entry("shape", argument_of(command, values, "shape"), kShapes,
                                  [](const Shape& s) { return s.name; });
  const std::string output = text_of(values, "output");

  SurfaceTextureOptions options;
  options.pattern = find_entry("pattern", text_of(values, "pattern"), kPatterns, [](const auto& p) {
                      return p.first;
                    }).second;
  options.noise = has(values, "noise") ? number_of(values, "noise", 0, 1) : shape.noise;
  options.cell = has(values, "cell") ? number_of(values, "cell", 1e-6, 1e9) : 0;
  options.seed = std::uint64_t(integer_of(values, "seed", 0, INT64_MAX));
  const int size = int(integer_of(values, "size", 1, 32768));

  TriangleMesh mesh = make_shape(shape, values);
  check_interrupted();
  if (has(values, "texture")) {
    const std::string texture = text_of(values, "texture");
    // The stretched plane wears the square's texture: that is what stretches it.
    const bool stretched = std::string_view(shape.name) == "stretched-plane";
    const Image image =
        make_surface_texture(stretched ? make_plane(1, 1) : mesh, size, size, options);
    check_interrupted();
    ImageWriteOptions eight_bits;
    eight_bits.bits = 8;
    write_image(texture, image, eight_bits);
    mesh.materials = {{shape.name, texture}};
    std::fill(mesh.face_materials.begin(), mesh.face_materials.end(), 0);
  }
  check_interrupted();
  write_obj(output, flag_of(values, "soup") ? loosen(mesh) : mesh);
  return 0;
}

}  // namespace onmesh::tools
