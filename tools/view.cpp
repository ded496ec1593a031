// onmesh view: a picture of the textured model, before and after, or of distances.
#include <cmath>
#include <map>
#include <memory>

#include "interruption.h"
#include "messages.h"
#include "onmesh/image/image_io.h"
#include "onmesh/mesh_io/read_mesh.h"
#include "onmesh/render/render.h"
#include "onmesh/render/texture_view.h"
#include "ply_column.h"
#include "shared_options.h"
#include "subcommands.h"

namespace onmesh::tools {

Command view_command() {
  Command command;
  command.name = "view";
  command.synopsis = "(MESH | --flat) -o PICTURE [-t TEXTURE [--after TEXTURE]...] [options]";
  command.summary =
      "Renders the mesh with a texture, or with the textures of its own materials without -t; "
      "with\n"
      "--after further pictures beside it; or coloured by a scalar per vertex with isolines. With\n"
      "--flat the textures themselves are shown instead of the model.";
  command.examples =
      "  onmesh view cube.obj -t cube.png --after filtered.png -o picture.png\n"
      "  onmesh view cube.obj -t cube.png --after a.png --after b.png --size 400 -o three.png\n"
      "  onmesh view --flat -t cube.png --after filtered.png -o textures.png\n"
      "  onmesh view cube.obj --azimuth -30 --elevation 60 --no-light -o top.png\n"
      "  onmesh view cube.obj --distance-ply distance.ply --isolines 0.1 -o distance.png\n";
  auto add = command.options.add_options();
  add("mesh", text());
  add("output,o", text(), "the picture to write");
  add("texture,t", text(), "texture for all faces (default: what the mesh's materials name)");
  add("after", texts(), "another texture, shown beside the first; may be given several times");
  add("flat", flag(), "show the textures themselves, without a mesh");
  add("distance-ply", text(),
      "PLY with a scalar per vertex of the mesh, as onmesh distance writes it");
  add("property", text("distance"), "which property of that PLY");
  add("isolines", text(), "step of the isolines (default: a twentieth of the range; 0 = none)");
  add("wrap", text("repeat"), "what UVs outside [0,1] mean: repeat or clamp");
  add("size", text("800"), "pixels per side of each picture (flat: the longer side), 1 to 16384");
  add("height", text(), "pixels, if pictures of the model are not to be square");
  add("azimuth", text("35"), "degrees around the up axis");
  add("elevation", text("25"), "degrees above the horizon, -90 to 90");
  add("zoom", text("1"), "1 = the model fills the picture");
  add("up", text("y"), "the axis that points up: x, y, z, -x, -y or -z");
  add("supersampling", text("2"), "samples per pixel and direction, 1 to 8");
  add("no-light", flag(), "texture values as they are, without shading");
  add("wireframe", flag(), "draw the mesh's edges");
  add("face-materials", flag(), "one flat colour per material");
  command.positional.add("mesh", 1);
  return command;
}

namespace {

Vec3 axis(const std::string& name) {
  const bool minus = !name.empty() && name[0] == '-';
  const std::string letter = name.substr(minus ? 1 : 0);
  const double sign = minus ? -1 : 1;
  if (letter == "x") return {sign, 0, 0};
  if (letter == "y") return {0, sign, 0};
  if (letter == "z") return {0, 0, sign};
  throw UsageError("--up: '" + name + "' is not x, y, z, -x, -y or -z");
}

RenderOptions render_options(const Arguments& arguments) {
  RenderOptions options;
  options.width = options.height = int(arguments.integer("size", 1, 16384));
  if (arguments.has("height")) options.height = int(arguments.integer("height", 1, 16384));
  options.azimuth_degrees = arguments.number("azimuth", -1e6, 1e6);
  options.elevation_degrees = arguments.number("elevation", -90, 90);
  options.zoom = arguments.number("zoom", 1e-3, 1000);
  options.supersampling = int(arguments.integer("supersampling", 1, 8));
  options.light = !arguments.flag("no-light");
  options.wireframe = arguments.flag("wireframe");
  options.up = axis(arguments.text("up"));
  options.wrap = wrap_of(arguments);
  return options;
}

void check_combination(const Arguments& arguments) {
  arguments.refuse_together("distance-ply", {"texture", "after", "face-materials", "wrap"});
  arguments.refuse_together("face-materials", {"texture", "after", "wrap"});
  arguments.refuse_together("flat", {"distance-ply", "face-materials", "wrap", "height", "azimuth",
                                     "elevation", "zoom", "up", "no-light", "wireframe"});
  if (arguments.flag("flat") && arguments.has("mesh"))
    throw UsageError("--flat shows textures without a mesh; leave out '" + arguments.text("mesh") +
                     "' or --flat");
  arguments.require_with({"property", "isolines"}, "distance-ply");
}

// The scalar may have a value per vertex of the file or per vertex once they are welded.
void fit_to_scalar(TriangleMesh& mesh, std::size_t values, const std::string& path) {
  const std::size_t as_read = mesh.positions.size();
  if (values == as_read) return;
  mesh = weld(mesh);
  if (values != mesh.positions.size())
    throw InputError("--distance-ply: " + path + " has " + std::to_string(values) +
                     " vertices, the mesh has " + std::to_string(as_read));
}

// The textures that the mesh's materials name, each read once.
class MaterialTextures {
 public:
  explicit MaterialTextures(const TriangleMesh& mesh) {
    for (const Material& material : mesh.materials) {
      if (material.texture.empty()) {
        pointers.push_back(nullptr);
        continue;
      }
      const auto [entry, is_new] = images_.try_emplace(material.texture);
      if (is_new) entry->second = read(material.texture);
      pointers.push_back(entry->second.get());
    }
  }
  std::vector<const Image*> pointers;

 private:
  // A model is worth seeing even if one of its textures got lost: that part stays grey.
  static std::unique_ptr<Image> read(const std::string& path) {
    try {
      return std::make_unique<Image>(read_texture(path));
    } catch (const FileError& error) {
      warn(error.what());
    } catch (const InputError& error) {
      warn(error.what());
    }
    return nullptr;
  }

  std::map<std::string, std::unique_ptr<Image>> images_;
};

std::vector<Image> flat_pictures(const Arguments& arguments, const RenderOptions& options) {
  std::vector<std::string> paths = arguments.texts("after");
  paths.insert(paths.begin(), arguments.text("texture"));
  std::vector<Image> pictures;
  for (const std::string& path : paths) {
    pictures.push_back(view_texture(read_texture(path), options.width, options.supersampling));
    check_interrupted();
  }
  return pictures;
}

// The first picture of the model: coloured by a scalar, by material, or by textures.
Image first_picture(const TriangleMesh& mesh, const std::vector<double>& scalar,
                    const Arguments& arguments, const RenderOptions& options) {
  RenderColour colour;
  colour.by_material = arguments.flag("face-materials");
  if (arguments.has("distance-ply")) {
    colour.scalar = &scalar;
    if (arguments.has("isolines")) {
      const double step = arguments.number("isolines", 0, 1e300);
      colour.isoline_step = step == 0 ? -1 : step;
    }
    return render(mesh, colour, options);
  }
  if (arguments.has("texture")) {
    const Image texture = read_texture(arguments.text("texture"));
    colour.texture = &texture;
    return render(mesh, colour, options);
  }
  if (colour.by_material) return render(mesh, colour, options);
  const MaterialTextures textures(mesh);
  colour.material_textures = textures.pointers;
  return render(mesh, colour, options);
}

std::vector<Image> model_pictures(const std::string& path, const Arguments& arguments,
                                  const RenderOptions& options) {
  std::vector<std::string> warnings;
  TriangleMesh mesh = read_mesh(path, &warnings);
  warn(warnings);
  check_interrupted();
  std::vector<double> scalar;
  if (arguments.has("distance-ply")) {
    const std::string ply = arguments.text("distance-ply");
    scalar = read_ply_column(ply, arguments.text("property"));
    fit_to_scalar(mesh, scalar.size(), ply);
  } else {
    mesh = weld(mesh);  // shading is smooth across seams, so that a seam in sight is the texture's
  }
  check_interrupted();

  std::vector<Image> pictures{first_picture(mesh, scalar, arguments, options)};
  for (const std::string& after : arguments.texts("after")) {
    check_interrupted();
    const Image texture = read_texture(after);
    RenderColour colour;
    colour.texture = &texture;
    pictures.push_back(render(mesh, colour, options));
  }
  return pictures;
}

}  // namespace

int run_view(const Arguments& arguments) {
  const std::string output = arguments.text("output");
  const RenderOptions options = render_options(arguments);
  check_combination(arguments);
  check_writable_image(output, make_image(1, 1, 3));
  const std::vector<Image> pictures =
      arguments.flag("flat") ? flat_pictures(arguments, options)
                             : model_pictures(arguments.argument("mesh"), arguments, options);
  check_interrupted();
  ImageWriteOptions eight_bits;
  eight_bits.bits = 8;
  std::vector<std::string> warnings;
  write_image(output, side_by_side(pictures), eight_bits, &warnings);
  warn(warnings);
  return 0;
}

}  // namespace onmesh::tools
