#include "onmesh/filter/check_options.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "onmesh/base/face_error.h"
#include "onmesh/base/text.h"

namespace onmesh {
namespace {

/// Squares of values between these, and their reciprocals, hold in single precision.
constexpr double kLeastValue = 1e-15, kLargestValue = 1e15;

/// More rings than an image has rows.
constexpr int kMostRings = 32768;

constexpr int kMostIterations = 100;

/// Both ends belong to it.
void check_between(const char* option, double value, double least, double largest) {
  if (value >= least && value <= largest) return;
  throw OptionError(option, number_text(value) + " is not between " + number_text(least) + " and " +
                                number_text(largest));
}

/// Multiples of noise, or widths whose squares hold.
void check_width(const char* option, const RangeWidth& width) {
  if (width.unit != RangeWidth::Unit::feature) {
    require_within(option, width.value, 1e-6, 1e6, " of the noise");
    return require_within(option, width.power, 0.1, 10, " as a power of the noise");
  }
  require_within(option, width.value, kLeastValue, kLargestValue);
}

void check_guide(const Guide& guide) {
  const std::string option = "guide " + guide.name;
  if (guide.kind == Guide::Kind::images && guide.textures.tiles.empty())
    throw OptionError(option, "has no image");
  if (guide.kind == Guide::Kind::surface_position) {
    require_positive(option.c_str(), guide.length.value);
  } else {
    check_width(option.c_str(), guide.width);
  }
  if (guide.blur && guide.median) throw OptionError(option, "is blurred or a median, not both");
  for (const auto& length : {guide.blur, guide.median})
    if (length) require_positive(option.c_str(), length->value);
}

void check_numbers(const FilterOptions& options) {
  const auto check = [](const char* option, const std::optional<Length>& length) {
    if (length) require_positive(option, length->value);
  };
  check("sigma_spatial", options.sigma_spatial);
  if (options.kind == FilterKind::bilateral && options.guides.empty())
    check_width("sigma_range", options.sigma_range);
  for (const Guide& guide : options.guides) check_guide(guide);
  if (options.despike != 0) check_between("despike", options.despike, 1, 1e6);
  if (options.iterations < 1 || options.iterations > kMostIterations)
    throw OptionError("iterations", "must be between 1 and " + std::to_string(kMostIterations));
  check("radius", options.radius);
  check("spacing", options.spacing);
  if (options.r_coef) require_within("r_coef", *options.r_coef, 1e-9, 1e9);
  check("node_spacing", options.node_spacing);
  require_within("tolerance", options.tolerance, 1e-9, 1e3);
  check("bridge", options.bridge);
  if (options.weld) require_tolerance("weld", *options.weld);
  check_between("strength", options.strength, 0, 1);
  check_between("detail_gain", options.detail_gain, -100, 100);
  if (options.threads < 0) throw OptionError("threads", "must not be negative");
  if (options.gutter < 0 || options.gutter > kMostRings) {
    throw OptionError("gutter", "must be between 0 and " + std::to_string(kMostRings));
  }
}

void check_combination(const FilterOptions& options) {
  if (options.kind == FilterKind::gaussian && !options.guides.empty())
    throw OptionError("guide", "only with kind=bilateral");
  if (options.bridge && options.distance == DistanceMethod::exact) {
    throw OptionError("bridge", "exact distances know none, so not with distance=exact");
  }
  if (options.spacing && options.r_coef) throw OptionError("r_coef", "excludes spacing");
  if (options.samples != SampleKind::poisson && (options.spacing || options.r_coef)) {
    throw OptionError(options.spacing ? "spacing" : "r_coef", "only with samples=poisson");
  }
}

void check_count(const char* what, std::size_t count, std::size_t faces) {
  if (count == faces) return;
  throw InputError("the mesh has " + count_text(faces, "face", "faces") + " but " +
                   std::to_string(count) + " " + what);
}

void check_image(const Image& image) {
  const auto values = [](int n) { return std::size_t(std::max(n, 0)); };
  if (image.pixels.size() != values(image.width) * values(image.height) * values(image.channels) ||
      image.pixels.empty()) {
    throw InputError("the texture's pixels are not width * height * channels values");
  }
}

void check_mask(const Image& mask) {
  check_image(mask);
  if (mask.range_channels().empty()) throw InputError("a mask has no channel but alpha");
}

std::string channels_text(const Image& image) {
  return count_text(image.channels, "channel", "channels") +
         (image.alpha_channel >= 0 ? " with alpha" : "");
}

}  // namespace

void require_positive(const char* option, double value) {
  if (!(value > 0) || !std::isfinite(value)) {
    throw OptionError(option, "must be positive and finite");
  }
}

void require_within(const char* option, double value, double least, double largest,
                    const char* of) {
  require_positive(option, value);
  if (value >= least && value <= largest) return;
  throw OptionError(option, number_text(value) + of + " is not between " + number_text(least) +
                                " and " + number_text(largest));
}

void check_options(const FilterOptions& options, std::size_t faces) {
  check_numbers(options);
  check_combination(options);
  if (!options.faces.empty() && options.faces.size() != faces) {
    throw OptionError("faces", "one entry per face of the mesh is needed");
  }
}

void check_arrays(const TriangleMesh& mesh) {
  check_count("face_uvs", mesh.face_uvs.size(), mesh.faces.size());
  check_count("face_materials", mesh.face_materials.size(), mesh.faces.size());
  const bool has_normals = !mesh.face_normals.empty();
  if (has_normals) check_count("face_normals", mesh.face_normals.size(), mesh.faces.size());
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (mesh.faces[f][k] >= mesh.positions.size()) {
        throw FaceError<InputError>(f, "a vertex index is out of range");
      }
      const Index uv = mesh.face_uvs[f][k];
      if (uv != kNone && uv >= mesh.uvs.size()) {
        throw FaceError<InputError>(f, "a UV index is out of range");
      }
      const Index normal = has_normals ? mesh.face_normals[f][k] : kNone;
      if (normal != kNone && normal >= mesh.normals.size()) {
        throw FaceError<InputError>(f, "a normal index is out of range");
      }
    }
    const Index material = mesh.face_materials[f];
    if (material != kNone && material >= mesh.materials.size()) {
      throw FaceError<InputError>(f, "its material is out of range");
    }
  }
  for (Index v = 0; v < mesh.positions.size(); ++v) {
    if (!mesh.positions[v].allFinite()) {
      throw InputError("vertex " + std::to_string(v) + ": its position is not finite");
    }
  }
}

void check_alpha(const SurfaceTextures& textures) {
  const Image& first = *textures.tiles[0].image;
  if (first.alpha_channel < 0)
    throw InputError("there is no alpha: the texture has " + channels_text(first));
}

void check_textures(const SurfaceTextures& textures, std::size_t faces, RangeSpace range_space) {
  if (textures.tiles.empty()) throw InputError("there is no texture");
  if (!textures.tile_of_face.empty())
    check_count("tile_of_face", textures.tile_of_face.size(), faces);
  for (const Index tile : textures.tile_of_face) {
    if (tile != kNone && tile >= textures.tiles.size())
      throw InputError("tile_of_face: a tile is out of range");
  }
  const Image& first = *textures.tiles[0].image;
  double texels = 0;
  for (const TextureTile& tile : textures.tiles) {
    check_image(*tile.image);
    for (const Image* const mask : {tile.mask, tile.sample_mask})
      if (mask != nullptr) check_mask(*mask);
    texels += double(tile.image->width) * tile.image->height;
    if (tile.image->channels != first.channels ||
        tile.image->alpha_channel != first.alpha_channel) {
      throw InputError(tile.name + " has " + channels_text(*tile.image) + ", " +
                       textures.tiles[0].name + " has " + channels_text(first) +
                       ": textures that are filtered together need the same channels");
    }
  }
  constexpr double kMostTexels = 4294967295.0;
  if (texels >= kMostTexels) throw InputError("the textures have more than 2^32 texels in all");
  if (range_space == RangeSpace::oklab && first.range_channels().size() != 3) {
    throw OptionError("range_space",
                      "oklab is for three channels, and the texture has " + channels_text(first));
  }
  if (first.range_channels().empty()) {
    throw InputError("the texture has no channel but alpha: nothing to filter");
  }
}

}  // namespace onmesh
