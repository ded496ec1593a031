// onmesh make-mesh: the parametric shapes of the library as OBJ with a texture.
#include <algorithm>
#include <string_view>

#include "bake.h"
#include "interruption.h"
#include "onmesh/image/image_io.h"
#include "onmesh/mesh_io/write_obj.h"
#include "onmesh/procedural/shapes.h"
#include "onmesh/procedural/texture.h"
#include "shape_table.h"
#include "subcommands.h"

namespace onmesh::tools {

Command make_mesh_command() {
  Command command;
  command.name = "make-mesh";
  command.synopsis = "SHAPE -o OUT.obj [-t TEXTURE] [options]";
  command.summary =
      "Writes a parametric mesh as OBJ, with a texture and its MTL if one is asked for. The "
      "pattern is\n"
      "carved out of space by the surface, so that it runs on across the atlas's seams.\n\n"
      "Shapes and the values of their options unless given:";
  for (const Shape& shape : shape_table()) {
    const std::string name = shape.name;
    command.summary += "\n  " + name + std::string(17 - name.size(), ' ') + shape.help;
  }
  command.examples =
      "  onmesh make-mesh noisy-cube -o cube.obj -t cube.png\n"
      "  onmesh make-mesh torus --segments 128 -o torus.obj -t torus.png --pattern dots --size "
      "1024\n"
      "  onmesh make-mesh cone --sector 200 -o cone.obj\n"
      "  onmesh make-mesh blob -o blob.obj -t noisy.exr --sky 4\n";
  auto add = command.options.add_options();
  add("shape", text());
  add("output,o", text(), "the OBJ to write");
  add("texture,t", text(),
      "the texture to write, any image format; 8 bits where there is a choice");
  add("size", text("512"), "texels per side of the texture");
  add("pattern", text("checker"), "checker, stripes, noise, gradient or dots");
  add("cell", text(),
      "size of the pattern's cells, mesh units (default: an eighth of the longest side)");
  add("sky", text(),
      "instead of the pattern: light of an even sky above, as noisy as so many rays for each texel "
      "make it");
  add("noise", text(), "amplitude of the noise per texel, 0 to 1 (default: 0; noisy-cube: 0.25)");
  add("seed", text("1"), "for noise, the patterns and the blob");
  for (const auto& [name, help] : shape_options()) add(name, text(), help);
  add("soup", flag(), "write loose triangles: every face gets vertices and UVs of its own");
  command.positional.add("shape", 1);
  return command;
}

namespace {

const std::pair<const char*, Pattern> kPatterns[] = {{"checker", Pattern::checker},
                                                     {"stripes", Pattern::stripes},
                                                     {"noise", Pattern::noise},
                                                     {"gradient", Pattern::gradient},
                                                     {"dots", Pattern::dots}};

// The entry of that name, or an error that lists what there is.
template <typename Entries, typename NameOf>
const auto& find_entry(const char* what, const std::string& name, const Entries& entries,
                       NameOf name_of) {
  std::string list;
  for (const auto& entry : entries) {
    if (name == name_of(entry)) return entry;
    list += (list.empty() ? "" : ", ") + std::string(name_of(entry));
  }
  throw UsageError(std::string("unknown ") + what + " '" + name + "'; there are " + list);
}

SurfaceTextureOptions texture_options(const Arguments& arguments, const Shape& shape) {
  SurfaceTextureOptions options;
  options.pattern = find_entry("pattern", arguments.text("pattern"), kPatterns, [](const auto& p) {
                      return p.first;
                    }).second;
  options.noise = arguments.has("noise") ? arguments.number("noise", 0, 1) : shape.noise;
  options.cell = arguments.has("cell") ? arguments.number("cell", 1e-6, 1e9) : 0;
  options.seed = std::uint64_t(arguments.integer("seed", 0, INT64_MAX));
  return options;
}

void write_texture(const std::string& path, const Shape& shape, const TriangleMesh& mesh, int size,
                   const SurfaceTextureOptions& options) {
  // The stretched plane wears the square's texture: that is what stretches it.
  const bool stretched = std::string_view(shape.name) == "stretched-plane";
  const Image image =
      make_surface_texture(stretched ? make_plane(1, 1) : mesh, size, size, options);
  check_interrupted();
  ImageWriteOptions eight_bits;
  eight_bits.bits = 8;
  write_image(path, image, eight_bits);
}

}  // namespace

int run_make_mesh(const Arguments& arguments) {
  const Shape& shape = find_entry("shape", arguments.argument("shape"), shape_table(),
                                  [](const Shape& s) { return s.name; });
  const std::string output = arguments.text("output");
  const SurfaceTextureOptions options = texture_options(arguments, shape);
  const int size = int(arguments.integer("size", 1, 32768));

  TriangleMesh mesh = make_shape(shape, arguments);
  check_interrupted();
  arguments.require_with({"sky"}, "texture");
  if (arguments.has("texture")) {
    const std::string texture = arguments.text("texture");
    if (arguments.has("sky")) {
      const int rays = int(arguments.integer("sky", 1, 1000000));
      write_image(texture, bake_sky(mesh, size, rays, options.seed));
    } else {
      write_texture(texture, shape, mesh, size, options);
    }
    mesh.materials = {{shape.name, texture}};
    std::fill(mesh.face_materials.begin(), mesh.face_materials.end(), 0);
  }
  check_interrupted();
  write_obj(output, arguments.flag("soup") ? loosen(mesh) : mesh);
  return 0;
}

}  // namespace onmesh::tools
