#include "atlas.h"

#include <charconv>
#include <utility>

#include "command.h"
#include "interruption.h"
#include "messages.h"
#include "shared_options.h"

namespace onmesh::tools {
namespace {

// "512x256"
TexelTile parse_resolution(const std::string& text) {
  TexelTile tile;
  const char* const end = text.data() + text.size();
  const auto [cross, first] = std::from_chars(text.data(), end, tile.width);
  if (first == std::errc() && cross != end && (*cross == 'x' || *cross == 'X')) {
    const auto [rest, second] = std::from_chars(cross + 1, end, tile.height);
    const auto fits = [](int side) { return side >= 1 && side <= 32768; };
    if (second == std::errc() && rest == end && fits(tile.width) && fits(tile.height)) return tile;
  }
  throw UsageError("--resolution: '" + text + "' is not WIDTHxHEIGHT with sides of 1 to 32768");
}

/// All faces, or those of a material, in one tile without a file.
Atlas atlas_of_size(const Arguments& arguments, const TriangleMesh& mesh) {
  Atlas atlas;
  atlas.mesh = mesh;
  atlas.tiles = {parse_resolution(arguments.text("resolution"))};
  atlas.tiles[0].wrap = wrap_of(arguments);
  atlas.set.textures.emplace_back();
  atlas.set.tile_of_face = faces_of_material(mesh, arguments.optional_text("material"));
  make_uvs_local({{nullptr, atlas.tiles[0].wrap, 0, 0, {}}}, atlas.set.tile_of_face, atlas.mesh);
  return atlas;
}

}  // namespace

void add_atlas_options(boost::program_options::options_description& options) {
  auto add = options.add_options();
  add("texture,t", texts(),
      "a texture of the atlas, may be given several times (default: those that the mesh's "
      "materials "
      "name)");
  add("resolution", text(), "size of the atlas instead of a texture, such as 1024x1024");
  add("material", text(), "only the faces of this material; all = every face with UVs");
  add_wrap_option(options);
  add_gltf_options(options);
}

bool has_atlas_option(const Arguments& arguments) {
  return arguments.has("texture") || arguments.has("resolution");
}

std::vector<const Image*> Atlas::image_pointers() const {
  std::vector<const Image*> pointers;
  for (const Image& image : images) pointers.push_back(&image);
  return pointers;
}

Atlas read_atlas(TextureSet set, const TriangleMesh& mesh, Wrap wrap) {
  Atlas atlas;
  atlas.set = std::move(set);
  for (const SetTexture& texture : atlas.set.textures) {
    atlas.images.push_back(read_texture(texture, atlas.warnings));
    refuse_image_bombs(atlas.set, atlas.images);
    check_interrupted();
  }
  const SurfaceTextures textures = surface_textures(atlas.set, atlas.images, wrap);
  atlas.tiles = texel_tiles(textures.tiles);
  atlas.mesh = mesh;
  make_uvs_local(textures.tiles, atlas.set.tile_of_face, atlas.mesh);
  return atlas;
}

Atlas read_atlas(const Arguments& arguments, const TriangleMesh& mesh, const std::string& texture) {
  if (arguments.has("resolution")) {
    if (arguments.has(texture)) throw UsageError("-t and --resolution exclude each other");
    return atlas_of_size(arguments, mesh);
  }
  TextureRequest request;
  request.material = arguments.optional_text("material");
  if (arguments.has(texture)) {
    request.files = arguments.texts(texture);
  } else {
    request.confined_to = confining_folder(arguments);
  }
  TextureSet set;
  try {
    set = choose_textures(mesh, request);
  } catch (const UsageError& error) {
    if (arguments.has(texture)) throw;
    throw UsageError(std::string(error.what()) + ", or give --resolution");
  }
  if (!arguments.has(texture)) keep_written(set);
  return read_atlas(std::move(set), mesh, wrap_of(arguments));
}

TexelMap covered_map(const InputMesh& input, const Atlas& atlas) {
  TexelMap map = naming(input, [&] { return atlas.map(); });
  if (map.claims.empty()) throw InputError(input.path + ": no texel is covered; has the mesh UVs?");
  return map;
}

SurfaceTextures surface_textures(const TextureSet& set, const std::vector<Image>& images,
                                 Wrap wrap) {
  SurfaceTextures textures;
  textures.tile_of_face = set.tile_of_face;
  for (std::size_t i = 0; i < images.size(); ++i) {
    const SetTexture& file = set.textures[i];
    textures.tiles.push_back({&images[i], wrap, file.column(), file.row(), file.path.string()});
  }
  return textures;
}

std::vector<Image> images_like(const std::vector<TexelTile>& tiles, int channels) {
  std::vector<Image> images;
  for (const TexelTile& tile : tiles)
    images.push_back(make_image(tile.width, tile.height, channels));
  return images;
}

}  // namespace onmesh::tools
