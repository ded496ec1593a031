#include "live_textures.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "../../destination.h"
#include "../../filter_options.h"
#include "../../guides.h"
#include "../../presets.h"
#include "onmesh/filter/filter.h"
#include "onmesh/filter/noise.h"
#include "onmesh/image/channels.h"
#include "onmesh/measure/image_difference.h"
#include "onmesh/measure/seam_error.h"
#include "reduced_texture.h"

namespace onmesh::tools {
namespace {

FileStamp stamp_of(const std::filesystem::path& path) {
  std::error_code error;
  FileStamp stamp;
  stamp.path = path.string();
  stamp.bytes = std::filesystem::file_size(path, error);
  if (error) stamp.bytes = 0;
  stamp.time = std::filesystem::last_write_time(path, error);
  return stamp;
}

}  // namespace

LiveTextures::LiveTextures(const std::vector<std::string>& words) {
  Arguments arguments = filter_arguments(words);
  apply_preset(arguments);
  Stopwatch watch;
  inputs_ = read_surface(arguments, watch);
  if (inputs_.maps.size() != 1 || !inputs_.maps[0].is_filtered)
    throw UsageError("--texture: --serve shows one map, and one that can be filtered");
  texel_size_ = working_on(inputs_, [&] {
    FilterOptions plain;
    plain.weld = filter_options(arguments).weld;
    return plan_filter(inputs_.mesh, inputs_.textures(), plain).texel_size;
  });
}

void LiveTextures::reduce(const TexelMap* texels) {
  const InputMap& map = inputs_.maps[0];
  const SurfaceTextures textures = inputs_.textures();
  reduced_.clear();
  reduced_parts_.clear();
  for (std::size_t i = 0; i < map.count; ++i) {
    const Image& image = inputs_.images[i];
    const std::vector<unsigned char> covered =
        texels != nullptr ? covered_texels(*texels, Index(i)) : std::vector<unsigned char>();
    const int factor = reduction_of(image);
    const TextureTile& tile = textures.tiles[i];
    reduced_.push_back(
        reduced_texture(image, tile.space.get(), tile.premultiplied, covered, factor));
    if (map.filtered.parts.empty()) continue;
    reduced_parts_.push_back(reduced_texture(map.filtered.parts[i], tile.space.get(),
                                             tile.premultiplied, covered, factor));
  }
  kept_.reset();
}

SurfaceTextures LiveTextures::reduced_textures() const {
  SurfaceTextures textures = inputs_.textures();
  const std::vector<Image>& images = reduced_parts_.empty() ? reduced_ : reduced_parts_;
  for (std::size_t i = 0; i < textures.tiles.size(); ++i) textures.tiles[i].image = &images[i];
  return textures;
}

double LiveTextures::noise(RangeWidth::Unit unit) {
  const SurfaceTextures textures = inputs_.textures();
  if (!map_) {
    TriangleMesh mesh = weld(inputs_.mesh);
    std::vector<Index> tiles = textures.tile_of_face;
    make_uvs_local(textures.tiles, tiles, mesh);
    map_ = make_texel_map(mesh, texel_tiles(textures.tiles), tiles);
  }
  const std::vector<int> channels = textures.tiles[0].image->range_channels();
  std::vector<float> codes;
  for (const TextureTile& tile : textures.tiles) {
    const Image part = take_channels(*tile.image, channels);
    codes.insert(codes.end(), part.pixels.begin(), part.pixels.end());
  }
  Colours colours;
  colours.floats = codes.data();
  colours.channels = colours.range_channels = colours.stride = int(channels.size());
  colours.width = textures.tiles[0].image->width;
  return noise_of(colours, *map_,
                  unit == RangeWidth::Unit::noise ? NoiseBy::median : NoiseBy::mean);
}

FilterOptions LiveTextures::options_of(Arguments& arguments) {
  apply_preset(arguments);
  const FilterOptions options = filter_options(arguments);
  inputs_.guides.clear();
  if (arguments.has("guide")) read_guides(arguments, inputs_);
  return with_guides(options, inputs_);
}

LiveResult LiveTextures::preview(Arguments arguments, const Progress& progress) {
  return working_on(inputs_, [&] {
    const FullScale scale{texel_size_, [&](RangeWidth::Unit unit) { return noise(unit); }};
    const FilterOptions options = with_numbers(options_of(arguments), scale);
    const SurfaceTextures textures = reduced_textures();
    if (!kept_ || !kept_->fits(options)) {
      kept_.reset();
      kept_.emplace(inputs_.mesh, textures, options, progress);
    }
    LiveResult result;
    std::vector<Image> images = kept_->run(textures, options, &result.report, progress);
    const InputMap& map = inputs_.maps[0];
    for (std::size_t i = 0; i < images.size(); ++i) {
      if (map.filtered.parts.empty()) {
        result.images.push_back(std::move(images[i]));
      } else {
        result.images.push_back(reduced_[i]);
        put_channels(images[i], map.filtered.channels[i], result.images.back());
      }
    }
    return result;
  });
}

LiveResult LiveTextures::run(Arguments arguments, const Progress& progress) {
  return working_on(inputs_, [&] {
    const FilterOptions options = options_of(arguments);
    LiveResult result;
    result.images = inputs_.whole_images(
        filter_maps(inputs_.mesh, library_maps(inputs_), options, &result.report, progress));
    return result;
  });
}

void LiveTextures::check_destination(const Arguments& arguments) const {
  const Destination to(arguments, arguments.text("output"), inputs_);
}

std::vector<std::string> LiveTextures::write(const Arguments& arguments,
                                             const std::vector<Image>& images) {
  Destination to(arguments, arguments.text("output"), inputs_);
  const std::size_t before = inputs_.warnings.size();
  to.write(images, inputs_);
  std::vector<std::string> told(inputs_.warnings.begin() + std::ptrdiff_t(before),
                                inputs_.warnings.end());
  inputs_.warnings.resize(before);
  return told;
}

std::vector<FileStamp> stamps_of(const SurfaceInputs& inputs) {
  std::vector<FileStamp> stamps{stamp_of(inputs.mesh_path)};
  for (const SetTexture& texture : inputs.set.textures)
    if (!texture.content) stamps.push_back(stamp_of(texture.path));
  return stamps;
}

std::string changed_file(const std::vector<FileStamp>& stamps) {
  for (const FileStamp& stamp : stamps) {
    const FileStamp now = stamp_of(stamp.path);
    if (now.bytes != stamp.bytes || now.time != stamp.time) return stamp.path;
  }
  return {};
}

}  // namespace onmesh::tools
