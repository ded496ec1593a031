#include "view_page.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>

#include "../atlas.h"
#include "../distance_field.h"
#include "../format.h"
#include "../inputs.h"
#include "../interruption.h"
#include "../map_files.h"
#include "../messages.h"
#include "../output_names.h"
#include "../shared_options.h"
#include "../tile_names.h"
#include "../worn_textures.h"
#include "onmesh/base/error.h"
#include "onmesh/base/text.h"
#include "onmesh/distance/make_backend.h"
#include "onmesh/mesh_io/write_gltf.h"
#include "onmesh/poisson/poisson.h"
#include "review.h"

namespace onmesh::tools {
namespace {

/// The textures of all maps, one map after the other, all on the same faces.
struct WornMaps {
  TextureSet set;
  std::vector<std::string> names;         ///< per map
  std::vector<ColourSpaceChoice> spaces;  ///< per map, once they are read
  std::size_t tiles = 0;                  ///< per map
};

/// A single file is for all faces with UVs, several are for those that wear them.
TextureSet set_of_map(const TriangleMesh& mesh, const MapFiles& map) {
  if (map.files.size() == 1 && !names_several(split_role(map.files[0]).name)) {
    return textures_like(std::vector<Index>(mesh.faces.size(), 0), map.files[0]);
  }
  return choose_textures(mesh, {map.files, {}, {}});
}

WornMaps worn_maps(const TriangleMesh& mesh, const Arguments& arguments) {
  WornMaps maps;
  if (!arguments.has("texture")) {
    maps.set = worn_textures(mesh, {}, confining_folder(arguments)).set();
    if (!maps.set.textures.empty()) maps.names = {""};
    maps.tiles = maps.set.textures.size();
    return maps;
  }
  for (const MapFiles& map : maps_of_files(arguments.texts("texture"))) {
    TextureSet set = set_of_map(mesh, map);
    warn(set.warnings);
    for (SetTexture& texture : set.textures) texture.map = map.name;
    maps.names.push_back(map.name);
    if (maps.names.size() == 1) {
      maps.tiles = set.textures.size();
      maps.set = std::move(set);
      continue;
    }
    if (set.tile_of_face !=
        std::vector<Index>(maps.set.tile_of_face.begin(), maps.set.tile_of_face.end()))
      throw UsageError("--texture: " + map.name + " is on other faces than " + maps.names[0] +
                       "; a page shows maps of the same faces");
    append(std::move(set), maps.set);
  }
  return maps;
}

/// One that was named must be there; of those that materials name what is left is worth seeing.
Image read_shown(const SetTexture& texture, bool is_named) {
  check_interrupted();
  if (!is_named) {
    const auto image = read_if_there(texture);
    return image ? *image : Image();
  }
  std::vector<std::string> odd;
  Image image = read_texture(texture, odd);
  warn(odd);
  return image;
}

std::string space_of(const SetTexture& texture, const Image& image, const Arguments& arguments) {
  ColourSpaceRequest request =
      colour_space_request_of_slot(slot_of(arguments), !arguments.has("texture"));
  request.role = texture.role;
  return image.pixels.empty() ? "sRGB" : choose_colour_space(image, request).name;
}

/// The files of a state, one per texture of all maps.
std::vector<SetTexture> textures_after(const std::string& after, const WornMaps& maps,
                                       const Arguments& arguments) {
  if (is_gltf_name(after)) {
    ReadReport read;
    const TriangleMesh mesh = weld(read_mesh_file(after, arguments, read));
    warn(read.warnings);
    const auto textures = worn_textures(mesh, {}, confining_folder(arguments)).set().textures;
    if (textures.size() != maps.set.textures.size()) {
      throw InputError(after + ": has " + count_text(textures.size(), "texture", "textures") +
                       ", before there are " + std::to_string(maps.set.textures.size()));
    }
    return textures;
  }
  if (!names_several(after)) {
    if (maps.set.textures.size() != 1) {
      throw UsageError("--after: " + after + ": there are " +
                       std::to_string(maps.set.textures.size()) +
                       " textures; name a folder/, or a file for each, with {map}, <UDIM>, {stem} "
                       "or {material}");
    }
    SetTexture texture = maps.set.textures[0];
    texture.path = split_role(after).name;
    texture.content = nullptr;
    return {texture};
  }
  std::vector<SetTexture> textures = maps.set.textures;
  const OutputNames names = name_outputs(maps.set, after);
  for (std::size_t i = 0; i < textures.size(); ++i) {
    textures[i].path = names.paths[i];
    textures[i].content = nullptr;
  }
  return textures;
}

/// What tells a state from the others.
std::string name_of_state(const std::string& after) {
  std::filesystem::path path(after);
  if (!path.has_filename()) path = path.parent_path();
  return path.filename().string();
}

void add_maps(const Arguments& arguments, Review& review) {
  const WornMaps maps = worn_maps(review.mesh->welded, arguments);
  if (maps.set.textures.empty()) {
    if (arguments.has("after"))
      throw UsageError("--after: there is no texture before; name it with -t");
    return;
  }
  review.tile_of_face = maps.set.tile_of_face;
  for (std::size_t t = 0; t < maps.tiles; ++t) {
    const SetTexture& texture = maps.set.textures[t];
    const std::string name =
        texture.udim > 0 ? std::to_string(texture.udim) : texture.path.filename().string();
    review.tiles.push_back({name, texture.column(), texture.row()});
  }
  const bool is_named = arguments.has("texture") && maps.set.textures.size() == maps.names.size();
  for (std::size_t m = 0; m < maps.names.size(); ++m) {
    ReviewMap& map = review.maps.emplace_back();
    map.name = maps.names[m];
    for (std::size_t t = 0; t < maps.tiles; ++t) {
      const SetTexture& texture = maps.set.textures[m * maps.tiles + t];
      map.files.push_back(texture.path.filename().string());
      map.before.push_back(read_shown(texture, is_named));
    }
    map.space = space_of(maps.set.textures[m * maps.tiles], map.before[0], arguments);
  }
  if (!arguments.has("after")) return;
  for (const std::string& after : arguments.texts("after")) {
    review.after_names.push_back(name_of_state(after));
    const std::vector<SetTexture> textures = textures_after(after, maps, arguments);
    for (std::size_t m = 0; m < maps.names.size(); ++m) {
      std::vector<Image>& images = review.maps[m].after.emplace_back();
      for (std::size_t t = 0; t < maps.tiles; ++t)
        images.push_back(read_shown(textures[m * maps.tiles + t], is_named));
    }
  }
}

/// The median size of the texels of the first map.
/// \throw UsageError if there are none
double texel_size(const Arguments& arguments, const InputMesh& input, const char* option) {
  const Atlas atlas = read_atlas(arguments, input.cleaned);
  const double size = covered_map(input, atlas).median_texel_size();
  if (!(size > 0)) throw UsageError(dashed(option) + ": there are no texels to measure with");
  return size;
}

double length_of(const Arguments& arguments, const char* option, const InputMesh& input) {
  const Length length = arguments.length(option);
  const double texel =
      length.unit == Length::Unit::texel ? texel_size(arguments, input, option) : 0;
  return resolve(length, texel, input.cleaned.diagonal());
}

/// vertex:N, uv:U,V or point:X,Y,Z.
DistanceSource source_of(const std::string& text, const InputMesh& input) {
  const std::string usage = "--distances: '" + text + "' is not vertex:N, uv:U,V or point:X,Y,Z";
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) throw UsageError(usage);
  const std::string kind = text.substr(0, colon);
  const std::vector<double> numbers = numbers_in("distances", text.substr(colon + 1));
  if (kind == "vertex" && numbers.size() == 1 && numbers[0] == std::floor(numbers[0]) &&
      std::abs(numbers[0]) < 1e15)
    return source_at_vertex(input, std::int64_t(numbers[0]), "distances");
  if (kind == "uv" && numbers.size() == 2)
    return source_at_uv(input.cleaned, {numbers[0], numbers[1]}, "distances");
  if (kind == "point" && numbers.size() == 3)
    return source_at_point(input.cleaned, {numbers[0], numbers[1], numbers[2]});
  throw UsageError(usage);
}

void add_distances(const Arguments& arguments, const InputMesh& input, Review& review) {
  const bool has_distances = arguments.has("distances");
  review.shows_nodes = arguments.has("nodes");
  if (!has_distances && !review.shows_nodes) return;
  constexpr double kEverywhere = std::numeric_limits<double>::infinity();
  RefineOptions options;
  options.spacing = review.shows_nodes ? length_of(arguments, "nodes", input)
                                       : default_spacing(input.cleaned, kEverywhere);
  check_node_count(input.cleaned, options);
  review.surface = naming(input, [&] { return refine(input.cleaned, input.cleaning, options); });
  check_interrupted();
  ReviewTable table{"Distances", {}};
  table.rows.emplace_back("nodes", format_count(review.surface.nodes.nodes.size()) + ", " +
                                       format_number(options.spacing) + " apart");
  if (has_distances) {
    for (const std::string& text : arguments.texts("distances")) {
      const DistanceSource source = naming(input, [&] { return source_of(text, input); });
      std::vector<double> distances = naming(input, [&] {
        return node_distances(input.cleaned, review.surface, source, DistanceMethod::automatic,
                              kEverywhere);
      });
      forget_beyond(kEverywhere, distances);
      review.distances.push_back(
          {"distance from " + text, input.cleaned.position(source.point), std::move(distances)});
      check_interrupted();
    }
    table.rows.emplace_back(
        "computed by",
        make_backend(DistanceMethod::automatic, input.cleaned, review.surface.nodes)->name());
  }
  review.tables.push_back(std::move(table));
}

void add_samples(const Arguments& arguments, const InputMesh& input, Review& review) {
  if (!arguments.has("samples")) return;
  constexpr double kMost = 2e6;
  PoissonOptions options;
  options.spacing = length_of(arguments, "samples", input);
  double area = 0;
  for (Index f = 0; f < input.cleaned.faces.size(); ++f) area += input.cleaned.face_area(f);
  if (0.7 * area / (options.spacing * options.spacing) > kMost)
    throw UsageError("--samples: there would be more than 2,000,000, too many for a page");
  review.samples = naming(input, [&] { return poisson_samples(input.cleaned, options); });
  review.samples_text = "Poisson-disk samples, " + format_number(options.spacing) + " apart";
}

ReviewTable table_of(const InputMesh& input) {
  ReviewTable table{"Mesh", {}};
  table.rows.emplace_back("vertices", format_count(input.as_read.positions.size()));
  table.rows.emplace_back("triangles", format_count(input.as_read.faces.size()));
  table.rows.emplace_back("diagonal", format_number(input.cleaned.diagonal()) + " mesh units");
  return table;
}

}  // namespace

void write_view_page(const Arguments& arguments, const RenderOptions& camera) {
  const std::string path = arguments.argument("mesh"), output = arguments.text("output");
  check_writable_file(output);
  const InputMesh input = read_input_mesh(path, arguments);
  warn(input.read.warnings);
  check_interrupted();
  Review review;
  review.title = std::filesystem::path(path).filename().string();
  review.created = {"onmesh", "view"};
  review.created.insert(review.created.end(), arguments.as_given().begin(),
                        arguments.as_given().end());
  review.notes = input.read.warnings;
  review.camera = camera;
  review.mesh = &input;
  review.wrap = wrap_of(arguments);
  review.tile_of_face.assign(input.welded.faces.size(), kNone);
  review.tables.push_back(table_of(input));
  add_maps(arguments, review);
  add_samples(arguments, input, review);
  add_distances(arguments, input, review);
  write_review(output, std::move(review));
}

}  // namespace onmesh::tools
