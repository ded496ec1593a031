// onmesh compare: how two textures differ, and how visible their seams are.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <optional>

#include "atlas.h"
#include "compare_gltf.h"
#include "comparison.h"
#include "format.h"
#include "interruption.h"
#include "messages.h"
#include "onmesh/atlas/chart_mask.h"
#include "onmesh/base/text.h"
#include "onmesh/image/channels.h"
#include "onmesh/image/image_io.h"
#include "onmesh/image/lookup.h"
#include "onmesh/mesh_io/write_gltf.h"
#include "shared_options.h"
#include "subcommands.h"
#include "texture_set.h"
#include "tile_names.h"

namespace onmesh::tools {

Command compare_command() {
  Command command;
  command.name = "compare";
  command.synopsis = "A B [--mesh MESH] [--fail DB] [options]";
  command.summary =
      "Measures how two textures of one size differ, or two sets of them: folders, names with\n"
      "<UDIM>, or glTF files, compared image by image. With their mesh only the texels that its\n"
      "charts cover count, and the seam error of both is measured: the difference of bilinear\n"
      "look-ups on both sides of every seam edge, also between textures. How A's steps from side\n"
      "to side differ from B's is compared with the same at edges within charts, apart for folds.";
  command.examples =
      "  onmesh compare cube.png filtered.png\n"
      "  onmesh compare cube.png filtered.png --mesh cube.obj --json\n"
      "  onmesh compare textures/ filtered/ --mesh figure.obj\n"
      "  onmesh compare scene.glb filtered.glb --slot occlusion\n"
      "  onmesh compare expected.exr filtered.exr --fail 60\n";
  auto add = command.options.add_options();
  add("a", text());
  add("b", text());
  add("mesh", text(),
      "the mesh that wears the textures; of sets, all that its materials name; of glTF files A by "
      "default");
  add("material", text(), "only the faces of this material; all = every face with UVs");
  add_wrap_option(command.options);
  add("mask", text(),
      "an image of any size: texels where it is 0 are left out; of several textures one each, with "
      "<UDIM> or {stem} in its name");
  add_colour_space_options(command.options);
  add("fail", text(), "exit with 1 if the PSNR is below this many dB");
  add_weld_option(command.options);
  add_gltf_options(command.options);
  add_confine_option(command.options);
  add("seams", flag(), "insist on the seam errors: an error without --mesh");
  add("json", flag(), "the result as JSON on stdout");
  command.positional.add("a", 1).add("b", 1);
  return command;
}

namespace {

void require_like(const Image& image, const std::string& path, const Image& like,
                  const std::string& first) {
  const auto size = [](const Image& i) {
    return std::to_string(i.width) + " x " + std::to_string(i.height) + " with " +
           count_text(std::uint64_t(i.channels), "channel", "channels");
  };
  if (size(image) != size(like))
    throw InputError(path + ": " + size(image) + " cannot be compared with " + first + ": " +
                     size(like));
}

/// The files of a folder, or of a name with a placeholder for the tile.
std::vector<std::filesystem::path> files_of(const std::string& name) {
  namespace fs = std::filesystem;
  const std::optional<TileName> tiles = tile_name(name);
  const bool is_pattern = tiles && tiles->is_pattern;
  const fs::path folder = is_pattern ? fs::path(name).parent_path() : fs::path(name);
  std::vector<fs::path> files;
  std::error_code error;
  for (const fs::directory_entry& entry :
       fs::directory_iterator(folder.empty() ? fs::path(".") : folder, error)) {
    if (!entry.is_regular_file(error)) continue;
    const fs::path path = folder / entry.path().filename();
    const std::optional<int> udim = is_pattern ? tiles->tile_of(path) : std::optional<int>(0);
    if (udim && (is_pattern || is_image_name(path))) files.push_back(path);
  }
  std::sort(files.begin(), files.end());
  if (files.empty()) throw FileError(name + ": there are no images");
  return files;
}

/// What A and B mean: two files, or the files of two sets with the same names or tiles.
std::vector<Pair> pairs_of(const std::string& a, const std::string& b) {
  namespace fs = std::filesystem;
  std::error_code error;
  const auto is_pattern = [](const std::string& name) {
    const std::optional<TileName> tiles = tile_name(name);
    return tiles && tiles->is_pattern;
  };
  const bool folders = fs::is_directory(a, error) && fs::is_directory(b, error);
  const bool patterns = is_pattern(a) && is_pattern(b);
  if (!folders && !patterns) return {{a, b}};
  std::vector<Pair> pairs;
  for (const fs::path& file : files_of(a)) {
    const fs::path other = folders ? fs::path(b) / file.filename()
                                   : tile_name(b)->path_of(*tile_name(a)->tile_of(file));
    if (!fs::exists(other, error))
      throw FileError(other.string() + ": is missing, " + file.string() + " is there");
    pairs.push_back({file, other});
  }
  if (const std::size_t others = files_of(b).size(); others != pairs.size()) {
    throw FileError(b + ": has " + count_text(others, "image", "images") + ", " + a + " has " +
                    std::to_string(pairs.size()));
  }
  return pairs;
}

/// The textures that filter would have chosen for one of two files: the other is its result.
TextureSet set_of_pair(const TriangleMesh& mesh, const Pair& pair,
                       const std::optional<std::string>& material) {
  try {
    return choose_textures(mesh, {{pair.a.string()}, material, {}});
  } catch (const UsageError&) {
    if (material) throw;
  }
  try {
    return choose_textures(mesh, {{pair.b.string()}, material, {}});
  } catch (const UsageError&) {
    throw UsageError("--mesh: none of its materials names " + pair.a.string() + " or " +
                     pair.b.string() + "; choose the faces with --material NAME or --material all");
  }
}

/// Sets are those of the mesh's materials; pairs are found by the names of their files.
TextureSet set_of_mesh(const TriangleMesh& mesh, std::vector<Pair>& pairs,
                       const std::optional<std::string>& material) {
  TextureSet set = choose_textures(mesh, {{}, material, {}});
  keep_written(set);
  std::vector<Pair> ordered;
  for (const SetTexture& texture : set.textures) {
    const auto same = std::find_if(pairs.begin(), pairs.end(), [&](const Pair& pair) {
      const auto tile = tile_name(pair.a);
      return pair.a.stem() == texture.path.stem() ||
             (texture.udim > 0 && tile && tile->tile_of(pair.a) == texture.udim);
    });
    if (same == pairs.end()) {
      throw UsageError("--mesh: " + texture.path.filename().string() +
                       " of its materials is not among the textures compared");
    }
    ordered.push_back(*same);
  }
  pairs = std::move(ordered);
  return set;
}

/// Texels that a mask shows, without a mesh: looked up bilinearly.
std::vector<unsigned char> shown_texels(const Image& mask, const Image& like) {
  std::vector<unsigned char> shown(std::size_t(like.width) * std::size_t(like.height));
  const int channel = mask.range_channels()[0];
  std::vector<float> values(std::size_t(mask.channels));
  const WrapModes clamp{Wrap::clamp, Wrap::clamp};
  for (int y = 0; y < like.height; ++y) {
    for (int x = 0; x < like.width; ++x) {
      const Vec2 uv((x + 0.5) / like.width, 1 - (y + 0.5) / like.height);
      bilinear(mask, clamp, uv, values.data());
      shown[std::size_t(y) * std::size_t(like.width) + std::size_t(x)] =
          values[std::size_t(channel)] > 0 ? 1 : 0;
    }
  }
  return shown;
}

/// Adds the figures of the next pair.
/// \param counted per texel, as difference() takes it
void compare_pair(const Arguments& arguments, const std::vector<unsigned char>& counted,
                  Comparison& result) {
  const std::size_t i = result.parts.size();
  if (std::count(counted.begin(), counted.end(), 0) == std::ptrdiff_t(counted.size()) &&
      !counted.empty()) {
    throw InputError(result.pairs[i].a.string() + ": no texel is left to compare");
  }
  const Image &a = result.a[i], &b = result.b[i];
  result.parts.push_back(
      naming(result.pairs[i].b.string(), [&] { return difference(a, b, counted); }));
  const ColourSpaceRequest request = colour_space_request(arguments, {}, false);
  result.light.push_back(light_difference(a, b, choose_colour_space(a, request).space.get(),
                                          choose_colour_space(b, request).space.get(), counted));
  check_interrupted();
}

/// Whose texels count: covered by the mesh, and not hidden by masks.
std::vector<std::vector<unsigned char>> counted_texels(const TriangleMesh& mesh,
                                                       const TexelMap& map,
                                                       const Comparison& result) {
  std::vector<const Image*> masks;
  for (std::size_t i = 0; i < result.pairs.size(); ++i)
    masks.push_back(result.masks.empty() ? nullptr : &result.masks[i]);
  const std::vector<float> shown = chart_mask(mesh, map, masks);
  std::vector<std::vector<unsigned char>> counted;
  for (std::size_t i = 0; i < result.pairs.size(); ++i) {
    counted.push_back(covered_texels(map, Index(i)));
    for (std::size_t t = 0; t < counted[i].size() && !shown.empty(); ++t)
      if (!(shown[map.tiles[i].first + t] > 0)) counted[i][t] = 0;
  }
  return counted;
}

/// Images whose values can be compared across seams.
struct SeamImages {
  std::vector<Image> kept;             ///< what pointers refer to, if the images themselves do not
  std::vector<const Image*> pointers;  ///< per image; empty if they have different channels
};

/// Where only some have alpha, the others' channels are compared.
SeamImages seam_images(const std::vector<Image>& images) {
  SeamImages seams;
  const auto have_as_many = [](const std::vector<Image>& some) {
    return std::all_of(some.begin(), some.end(),
                       [&](const Image& image) { return image.channels == some[0].channels; });
  };
  if (!have_as_many(images)) {
    for (const Image& image : images)
      seams.kept.push_back(take_channels(image, image.range_channels()));
    if (!have_as_many(seams.kept)) return {};
  }
  for (const Image& image : seams.kept.empty() ? images : seams.kept)
    seams.pointers.push_back(&image);
  return seams;
}

void compare_seams(const TriangleMesh& mesh, const TexelMap& map, const std::vector<bool>& counted,
                   Comparison& result) {
  const SeamImages a = seam_images(result.a), b = seam_images(result.b);
  if (a.pointers.empty() || b.pointers.empty()) {
    warn("the textures have different channels, so their seams are not compared");
    return;
  }
  result.seams_a = seam_error(mesh, map, a.pointers);
  result.seams_b = seam_error(mesh, map, b.pointers);
  result.residual = seam_residual(mesh, map, a.pointers, b.pointers, counted);
}

/// On the texels that the mesh's charts cover, and at its seams.
void compare_on_mesh(const Arguments& arguments, const InputMesh& input, TextureSet set,
                     Comparison& result) {
  naming(input, [&] {
    SurfaceTextures textures = surface_textures(set, result.a, wrap_of(arguments));
    TriangleMesh mesh = input.cleaned;
    make_uvs_local(textures.tiles, set.tile_of_face, mesh);
    const TexelMap map =
        make_texel_map(mesh, texel_tiles(textures.tiles), std::move(set.tile_of_face));
    if (map.claims.empty()) throw InputError("no texel is covered, so there is nothing to compare");
    const auto counted = counted_texels(mesh, map, result);
    for (std::size_t i = 0; i < result.pairs.size(); ++i)
      compare_pair(arguments, counted[i], result);
    std::vector<bool> all_counted;
    for (const auto& of_tile : counted)
      for (const unsigned char c : of_tile) all_counted.push_back(c != 0);
    compare_seams(mesh, map, all_counted, result);
    return 0;
  });
}

/// The images of the next pair.
void add_images(Image a, Image b, Comparison& result) {
  const Pair& pair = result.pairs[result.a.size()];
  require_like(b, pair.b.string(), a, pair.a.string());
  result.a.push_back(std::move(a));
  result.b.push_back(std::move(b));
  check_interrupted();
}

/// The mask of each pair, if one was given.
void read_masks(const Arguments& arguments, Comparison& result) {
  if (!arguments.has("mask")) return;
  const std::string name = arguments.text("mask");
  if (result.pairs.size() > 1 && !has_placeholder(name)) {
    throw UsageError("--mask: " + name + ": there are " + std::to_string(result.pairs.size()) +
                     " textures; name a mask for each, with <UDIM> or {stem}");
  }
  for (const Pair& pair : result.pairs) {
    const auto tile = tile_name(pair.a);
    const int udim = tile ? tile->tile_of(pair.a).value_or(0) : 0;
    const auto path = fill_placeholders(name, pair.a, "", udim);
    result.masks.push_back(read_texture(path));
    if (result.masks.back().range_channels().empty())
      throw InputError(path.string() + ": has no channel but alpha, so it is nothing for --mask");
    check_interrupted();
  }
}

void read_pairs(const Arguments& arguments, Comparison& result) {
  for (const Pair& pair : result.pairs) {
    Image a = read_texture(pair.a);
    add_images(std::move(a), read_texture(pair.b), result);
  }
  read_masks(arguments, result);
}

/// The images of two glTF files, on a mesh that wears them.
void compare_gltf(const Arguments& arguments, Comparison& result) {
  GltfPairs gltf = pair_gltf_images(arguments);
  result.mesh = gltf.mesh.path;
  std::vector<std::string> warnings;
  for (std::size_t i = 0; i < gltf.a.size(); ++i) {
    result.pairs.push_back({gltf.a[i].path, gltf.b[i].path});
    Image a = read_texture(gltf.a[i], warnings);
    add_images(std::move(a), read_texture(gltf.b[i], warnings), result);
    refuse_image_bombs({gltf.a, {}, {}, {}}, result.a);
    refuse_image_bombs({gltf.b, {}, {}, {}}, result.b);
  }
  warn(warnings);
  read_masks(arguments, result);
  compare_on_mesh(arguments, gltf.mesh, std::move(gltf.set), result);
}

void put_together(Comparison& result) {
  result.all = together(result.parts, &result.worst);
  result.all_light = together(result.light);
}

bool are_gltf(const Arguments& arguments) {
  return is_gltf_name(arguments.argument("a")) && is_gltf_name(arguments.argument("b"));
}

Comparison compare(const Arguments& arguments) {
  Comparison result;
  if (are_gltf(arguments)) {
    compare_gltf(arguments, result);
    put_together(result);
    return result;
  }
  result.pairs = pairs_of(arguments.argument("a"), arguments.argument("b"));
  result.mesh = arguments.optional_text("mesh").value_or("");
  if (arguments.has("mesh")) {
    const auto material = arguments.optional_text("material");
    const InputMesh input = read_input_mesh(arguments.text("mesh"), arguments);
    warn(input.read.warnings);
    check_interrupted();
    if (result.pairs.size() == 1) {
      read_pairs(arguments, result);
      TextureSet set = set_of_pair(input.cleaned, result.pairs[0], material);
      keep_written(set);
      compare_on_mesh(arguments, input, std::move(set), result);
    } else {
      TextureSet set = set_of_mesh(input.cleaned, result.pairs, material);
      read_pairs(arguments, result);
      compare_on_mesh(arguments, input, std::move(set), result);
    }
  } else {
    read_pairs(arguments, result);
    for (std::size_t i = 0; i < result.pairs.size(); ++i) {
      compare_pair(arguments,
                   result.masks.empty() ? std::vector<unsigned char>{}
                                        : shown_texels(result.masks[i], result.a[i]),
                   result);
    }
  }
  put_together(result);
  check_interrupted();
  return result;
}

}  // namespace

int run_compare(const Arguments& arguments) {
  const std::string path_a = arguments.argument("a"), path_b = arguments.argument("b");
  std::optional<double> least;
  if (arguments.has("fail")) least = arguments.number("fail", -1000, 1000);
  if (!are_gltf(arguments)) {
    arguments.require_with({"wrap", "seams", "material", "weld", "confine", "slot", "uv-set"},
                           "mesh");
  }
  wrap_of(arguments);

  const Comparison result = compare(arguments);
  const bool passed = !least || result.all.psnr >= *least;
  if (arguments.flag("json")) {
    print_json(arguments, result, least, passed);
  } else {
    print_text(result);
  }
  if (passed) return 0;
  std::cout.flush();
  std::cerr << "onmesh compare: " << path_b << " differs from " << path_a << ": PSNR "
            << format_number(result.all.psnr) << " dB is below --fail " << arguments.text("fail")
            << '\n';
  return 1;
}

}  // namespace onmesh::tools
