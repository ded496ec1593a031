// onmesh view: a picture of the textured model, before and after, or of distances.
#include <cmath>
#include <filesystem>
#include <optional>

#include "inputs.h"
#include "interruption.h"
#include "messages.h"
#include "onmesh/image/image_io.h"
#include "onmesh/mesh_io/write_gltf.h"
#include "onmesh/render/render.h"
#include "onmesh/render/texture_view.h"
#include "output_names.h"
#include "ply_column.h"
#include "shared_options.h"
#include "subcommands.h"
#include "texture_set.h"
#include "tile_names.h"
#include "viewer/page_writer.h"
#include "viewer/server/serve.h"
#include "viewer/view_page.h"
#include "worn_textures.h"

namespace onmesh::tools {

Command view_command() {
  Command command;
  command.name = "view";
  command.synopsis =
      "(MESH | --flat) -o PAGE.html | PICTURE [-t TEXTURE]... [--after TEXTURE]... [options]\n"
      "       onmesh view --serve MESH [-t TEXTURE]... [--port N] [options]";
  command.summary =
      "Shows the mesh with a texture, or with the textures of its own materials without -t, and\n"
      "with --after what became of them. A page that ends in .html opens in any browser and needs\n"
      "nothing else: turn the model, compare before and after, see seams, differences, distances\n"
      "and the texel under the cursor. A picture has the states beside each other, or the mesh\n"
      "coloured by a scalar per vertex with isolines; with --flat the textures themselves.\n"
      "With --serve the page comes from this program, until Ctrl-C: move sliders and see the "
      "filter's\n"
      "result at once, click for distances, run at full resolution and save. Only this machine "
      "is\n"
      "answered; from another, forward the port: ssh -L 8080:127.0.0.1:8080 HOST.";
  command.examples =
      "  onmesh view cube.obj -t cube.png --after filtered.png -o page.html\n"
      "  onmesh view figure.obj --after smooth/ --after rough/ -o page.html\n"
      "  onmesh view cube.obj --distances vertex:0 --distances uv:0.2,0.6 --nodes 5% -o page.html\n"
      "  onmesh view --serve cube.obj -t cube.png\n"
      "  onmesh view cube.obj -t cube.png --after filtered.png -o picture.png\n"
      "  onmesh view cube.obj -t cube.png --after a.png --after b.png --size 400 -o three.png\n"
      "  onmesh view figure.obj --after smooth/ -o figure.png\n"
      "  onmesh view --flat -t cube.png --after filtered.png -o textures.png\n"
      "  onmesh view cube.obj --azimuth -30 --elevation 60 --no-light -o top.png\n"
      "  onmesh view cube.obj --distance-ply distance.ply --isolines 0.1 -o distance.png\n";
  auto add = command.options.add_options();
  add("mesh", text());
  add("output,o", text(), "the page (.html) or picture to write");
  add("serve", flag(),
      "serve the page, with what it takes to try the filter, at the address printed");
  add("port", text(), "--serve: the port, 0 to 65535 (default: any that is free)");
  add("texture,t", texts(),
      "texture for all faces; several, or a name with <UDIM> or {material}, for those that wear "
      "them (default: what the mesh's materials name)");
  add("after", texts(),
      "another texture, or a folder or name with <UDIM>, {stem} or {material} for several, shown "
      "beside the first; may be given several times");
  add("flat", flag(), "show the textures themselves, without a mesh");
  add("distance-ply", text(),
      "PLY with a scalar per vertex of the mesh, as onmesh distance writes it");
  add("property", text("distance"), "which property of that PLY");
  add("isolines", text(), "step of the isolines (default: a twentieth of the range; 0 = none)");
  add_wrap_option(command.options);
  add_gltf_options(command.options);
  add_confine_option(command.options);
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
  add("target", text(), "X,Y,Z: the point in the middle (default: the model is framed)");
  add("extent", text(), "with --target: mesh units from bottom to top there");
  add("distances", texts(),
      "page: geodesic distances from vertex:N, uv:U,V or point:X,Y,Z; may be given several times");
  add("samples", text(), "page: Poisson-disk samples so far apart: mesh units, 2tx or 1%");
  add("nodes", text(), "page: the nodes between which distances are computed, so far apart");
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
  if (arguments.has("target")) {
    const auto p = arguments.numbers("target", 3);
    options.target = Vec3(p[0], p[1], p[2]);
  }
  if (arguments.has("extent")) {
    options.extent = arguments.number("extent");
    if (!(options.extent > 0)) throw UsageError("--extent: must be more than 0");
  }
  return options;
}

/// What a page has controls for, so that only pictures take it.
constexpr const char* kOfPictures[] = {"flat",      "distance-ply",  "size",
                                       "height",    "supersampling", "no-light",
                                       "wireframe", "face-materials"};

void check_serving(const Arguments& arguments) {
  for (const char* const name : {"output", "after", "distances", "samples", "nodes"}) {
    if (arguments.given(name)) throw UsageError(dashed(name) + ": not with --serve");
  }
  for (const char* const name : kOfPictures) {
    if (arguments.given(name))
      throw UsageError(dashed(name) + ": only for pictures; the page has controls of its own");
  }
}

void check_combination(const Arguments& arguments) {
  arguments.refuse_together("distance-ply", {"texture", "after", "face-materials", "wrap"});
  arguments.refuse_together("face-materials", {"texture", "after", "wrap"});
  arguments.refuse_together(
      "flat", {"distance-ply", "face-materials", "wrap", "confine", "slot", "uv-set", "height",
               "azimuth", "elevation", "zoom", "up", "no-light", "wireframe", "target", "extent"});
  if (arguments.flag("flat") && arguments.has("mesh"))
    throw UsageError("--flat shows textures without a mesh; leave out '" + arguments.text("mesh") +
                     "' or --flat");
  arguments.require_with({"property", "isolines"}, "distance-ply");
  arguments.require_with({"extent"}, "target");
  const bool page = is_page_name(arguments.text("output"));
  for (const char* name : {"distances", "samples", "nodes"}) {
    if (!page && arguments.given(name))
      throw UsageError(dashed(name) + ": only for a page: -o PAGE.html");
  }
  for (const char* const name : kOfPictures) {
    if (page && arguments.given(name))
      throw UsageError(dashed(name) + ": only for pictures; the page has controls of its own");
  }
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

std::vector<Image> flat_pictures(const Arguments& arguments, const RenderOptions& options) {
  if (!arguments.has("texture")) throw UsageError("--texture is missing");
  std::vector<std::string> paths = arguments.texts("texture");
  for (const std::string& after : arguments.texts("after")) paths.push_back(after);
  std::vector<Image> pictures;
  for (const std::string& path : paths) {
    pictures.push_back(view_texture(read_texture(path), options.width, options.supersampling));
    check_interrupted();
  }
  return pictures;
}

/// One texture for all faces.
Image picture_with(const TriangleMesh& mesh, const std::string& path,
                   const RenderOptions& options) {
  const Image texture = read_texture(path);
  RenderColour colour;
  colour.texture = &texture;
  return render(mesh, colour, options);
}

/// Coloured by a scalar.
Image scalar_picture(const TriangleMesh& mesh, const std::vector<double>& scalar,
                     const Arguments& arguments, const RenderOptions& options) {
  RenderColour colour;
  colour.scalar = &scalar;
  if (arguments.has("isolines")) {
    const double step = arguments.number("isolines", 0, 1e300);
    colour.isoline_step = step == 0 ? -1 : step;
  }
  return render(mesh, colour, options);
}

/// A model that filter wrote, with its own textures.
Image picture_of_gltf(const std::string& path, const Arguments& arguments,
                      const RenderOptions& options) {
  ReadReport read;
  const TriangleMesh mesh = weld(read_mesh_file(path, arguments, read));
  warn(read.warnings);
  const WornTextures worn = worn_textures(mesh, {}, confining_folder(arguments));
  return worn.picture(worn.local(mesh), worn.set().textures, options);
}

/// The model with its textures, and with each of --after.
std::vector<Image> textured_pictures(const TriangleMesh& mesh, const Arguments& arguments,
                                     const RenderOptions& options) {
  std::vector<std::string> files;
  if (arguments.has("texture")) files = arguments.texts("texture");
  const bool is_one = files.size() == 1 && !names_several(files[0]);
  std::vector<std::string> afters = arguments.texts("after");
  std::vector<Image> pictures;
  std::optional<WornTextures> worn;
  std::optional<TriangleMesh> local;
  const auto wear = [&] {
    if (worn) return;
    worn = worn_textures(mesh, is_one ? std::vector<std::string>{} : files,
                         confining_folder(arguments));
    local = worn->local(mesh);
  };
  if (is_one) {
    pictures.push_back(picture_with(mesh, files[0], options));
  } else {
    wear();
    pictures.push_back(worn->picture(*local, worn->set().textures, options));
  }
  for (const std::string& after : afters) {
    check_interrupted();
    if (is_gltf_name(after)) {
      pictures.push_back(picture_of_gltf(after, arguments, options));
      continue;
    }
    if (!names_several(after)) {
      pictures.push_back(picture_with(mesh, after, options));
      continue;
    }
    wear();
    std::vector<SetTexture> textures;
    for (const auto& written : name_outputs(worn->set(), after).paths) {
      textures.emplace_back();
      textures.back().path = written;
    }
    pictures.push_back(worn->picture(*local, textures, options));
  }
  return pictures;
}

std::vector<Image> model_pictures(const std::string& path, const Arguments& arguments,
                                  const RenderOptions& options) {
  ReadReport read;
  TriangleMesh mesh = read_mesh_file(path, arguments, read);
  warn(read.warnings);
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

  if (arguments.has("distance-ply")) return {scalar_picture(mesh, scalar, arguments, options)};
  if (!arguments.flag("face-materials")) return textured_pictures(mesh, arguments, options);
  RenderColour colour;
  colour.by_material = true;
  return {render(mesh, colour, options)};
}

}  // namespace

int run_view(const Arguments& arguments) {
  if (arguments.flag("serve")) {
    check_serving(arguments);
    arguments.argument("mesh");
    serve_view(arguments, render_options(arguments));
  }
  if (arguments.given("port")) throw UsageError("--port: only with --serve");
  const std::string output = arguments.text("output");
  const RenderOptions options = render_options(arguments);
  check_combination(arguments);
  if (is_page_name(output)) {
    write_view_page(arguments, options);
    return 0;
  }
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
