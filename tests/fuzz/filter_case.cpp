#include "fuzz/filter_case.h"

#include <limits>

#include "onmesh/base/process_memory.h"

namespace onmesh::fuzz {
namespace {

/// For one case, bytes: beside what the program holds by now.
constexpr std::uint64_t kMostMemory = std::uint64_t(1) << 30;

/// The next of the values of a generator that is the same everywhere.
float next_value(std::uint32_t& state) {
  state = state * 1664525U + 1013904223U;
  return float(state >> 8) / 16777216.0F;
}

void fill_with_pattern(Input& input, Image& texture) {
  const std::size_t pattern = input.below(4);
  std::uint32_t state = input.byte();
  const auto channels = std::size_t(texture.channels), width = std::size_t(texture.width);
  for (std::size_t i = 0; i < texture.pixels.size(); ++i) {
    const std::size_t x = i / channels % width, y = i / channels / width;
    float& value = texture.pixels[i];
    if (pattern == 0) value = next_value(state);
    if (pattern == 1) value = (x / 3 + y / 3) % 2 == 0 ? 0.2F : 0.8F;
    if (pattern == 2) value = 0.01F * float(x) + 0.02F * float(y);
    if (pattern == 3) value = 0.5F;
  }
}

void plant_odd_values(Input& input, Image& texture) {
  static constexpr float kInfinity = std::numeric_limits<float>::infinity();
  static constexpr float kNumbers[] = {std::numeric_limits<float>::quiet_NaN(),
                                       kInfinity,
                                       -kInfinity,
                                       std::numeric_limits<float>::max(),
                                       std::numeric_limits<float>::lowest(),
                                       1e20F,
                                       -1e30F,
                                       1e-40F,
                                       -0.0F,
                                       1e6F};
  const std::size_t count = input.below(6);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t high = input.byte(), low = input.byte();
    texture.pixels[(256 * high + low) % texture.pixels.size()] = input.pick(kNumbers);
  }
}

/// \param least texels: what is smaller is taken for texels
Length length(Input& input, double least) {
  using Unit = Length::Unit;
  static constexpr Length kLengths[] = {
      {4, Unit::texel},     {1, Unit::texel},    {2, Unit::texel},    {8, Unit::texel},
      {0.5, Unit::texel},   {40, Unit::texel},   {10, Unit::percent}, {1, Unit::percent},
      {300, Unit::percent}, {0.1, Unit::mesh},   {1, Unit::mesh},     {1e-9, Unit::mesh},
      {1e9, Unit::mesh},    {1e-3, Unit::texel}, {1e5, Unit::texel},  {1e30, Unit::mesh}};
  const Length chosen = input.pick(kLengths);
  if (chosen.unit == Unit::texel && chosen.value < least) return {least, Unit::texel};
  return chosen;
}

}  // namespace

Image make_texture(Input& input) {
  const int width = 1 + int(input.below(24)), height = 1 + int(input.below(24));
  const int channels = 1 + int(input.below(4));
  Image texture = make_image(width, height, channels);
  if (input.flag()) texture.alpha_channel = channels - 1;
  fill_with_pattern(input, texture);
  plant_odd_values(input, texture);
  return texture;
}

SurfaceTextures make_textures(Input& input, std::vector<Image>& images, const TriangleMesh& mesh,
                              const FilterOptions& options) {
  const std::size_t more = input.below(4);
  for (std::size_t i = 0; i < more; ++i) {
    const int width = 1 + int(input.below(24)), height = 1 + int(input.below(24));
    images.push_back(make_image(width, height, images[0].channels));
    images.back().alpha_channel = images[0].alpha_channel;
    fill_with_pattern(input, images.back());
    plant_odd_values(input, images.back());
  }
  SurfaceTextures textures = one_texture(images[0], options);
  if (more == 0) return textures;
  const bool side_by_side = input.flag();
  textures.tiles.clear();
  for (const Image& image : images) {
    const auto number = int(textures.tiles.size());
    textures.tiles.push_back({&image, input.flag() ? Wrap::clamp : Wrap::repeat,
                              side_by_side ? number % 2 : 0, side_by_side ? number / 2 : 0,
                              std::to_string(number)});
  }
  // One more for faces that carry no texels.
  textures.tile_of_face.resize(mesh.faces.size());
  for (Index& tile : textures.tile_of_face) {
    tile = Index(input.below(images.size() + 1));
    if (tile == images.size()) tile = kNone;
  }
  return textures;
}

FilterOptions make_options(Input& input, std::size_t faces) {
  FilterOptions options;
  const std::uint8_t choices = input.byte(), more = input.byte();
  const auto bit = [](std::uint8_t byte, int i) { return (byte >> i & 1) != 0; };
  static constexpr DistanceMethod kDistances[] = {DistanceMethod::unfold, DistanceMethod::heat,
                                                  DistanceMethod::cloud, DistanceMethod::exact,
                                                  DistanceMethod::automatic};
  static constexpr FilterMethod kMethods[] = {FilterMethod::automatic, FilterMethod::direct,
                                              FilterMethod::nodes};
  static constexpr Overlap kOverlaps[] = {Overlap::average, Overlap::first, Overlap::error};
  static constexpr double kRanges[] = {0.1, 0.01, 1, 1e-15, 1e15, 1e-3, 30, 0};
  options.distance = input.pick(kDistances);
  options.method = input.pick(kMethods);
  options.overlap = input.pick(kOverlaps);
  options.sigma_range = input.pick(kRanges);
  options.gutter = int(input.below(4));
  options.sigma_spatial = length(input, 0.25);
  if (bit(choices, 0)) options.kind = FilterKind::gaussian;
  if (bit(choices, 1)) options.samples = SampleKind::poisson;
  if (bit(choices, 2)) options.wrap = Wrap::clamp;
  if (bit(choices, 7)) options.wrap = Wrap::mirror;
  if (bit(choices, 3)) options.radius = length(input, 0.25);
  if (bit(choices, 4)) options.bridge = length(input, 1e-3);
  if (bit(choices, 6)) options.weld = length(input, 1e-3);
  if (bit(choices, 5)) options.tolerance = bit(more, 0) ? 1e-9 : 10;
  if (bit(more, 1)) options.node_spacing = length(input, 0.5);
  if (bit(more, 2)) options.spacing = length(input, 0.5);
  if (bit(more, 3)) options.r_coef = bit(more, 4) ? 0.1 : 1;
  if (bit(more, 5)) options.seed = input.byte();
  if (bit(more, 6)) {
    options.faces.resize(faces);
    for (std::size_t f = 0; f < faces; ++f) options.faces[f] = (f + input.byte()) % 3 != 0;
  }
  if (bit(more, 7)) options.stop_at_materials = true;
  options.max_memory = resident_memory_bytes() + kMostMemory;
  return options;
}

void choose_values(Input& input, FilterOptions& options, SurfaceTextures& textures,
                   std::vector<Image>& masks) {
  const std::uint8_t choices = input.byte();
  const auto bit = [&](int i) { return (choices >> i & 1) != 0; };
  static constexpr RangeSpace kSpaces[] = {RangeSpace::code, RangeSpace::linear, RangeSpace::log,
                                           RangeSpace::oklab};
  if (bit(0)) options.range_space = input.pick(kSpaces);
  if (bit(1)) options.strength = double(input.byte()) / 255;
  if (bit(2)) options.filter_alpha = true;
  // All alike, so that codes bound the results: light from one into another has other codes there.
  const auto space = bit(3) ? find_colour_space("sRGB") : nullptr;
  for (TextureTile& tile : textures.tiles) tile.space = space;
  masks.reserve(2);  // textures refer to them
  for (const int which : {4, 5}) {
    if (!bit(which)) continue;
    masks.push_back(make_image(1 + int(input.below(24)), 1 + int(input.below(24)), 1));
    for (float& v : masks.back().pixels) v = float(input.byte() % 5) / 4;
    (which == 4 ? textures.tiles[0].mask : textures.tiles[0].sample_mask) = &masks.back();
  }
}

void choose_guides(Input& input, const SurfaceTextures& textures, FilterOptions& options,
                   std::vector<Image>& images) {
  const std::uint8_t choices = input.byte();
  const auto bit = [&](int i) { return (choices >> i & 1) != 0; };
  if (bit(2)) options.despike = bit(3) ? 1 : 4;
  options.despike_to_limit = bit(4);
  options.keep_mean = bit(5);
  if (bit(6)) options.iterations = 2;
  options.guides_from_result = bit(7);
  using Kind = Guide::Kind;
  static constexpr Kind kKinds[] = {Kind::own, Kind::surface_normal, Kind::surface_position,
                                    Kind::images};
  static constexpr RangeWidth::Unit kUnits[] = {RangeWidth::Unit::feature, RangeWidth::Unit::noise};
  static constexpr Guide::Meaning kMeanings[] = {Guide::Meaning::values, Guide::Meaning::normal_gl,
                                                 Guide::Meaning::object_normal};
  const std::size_t count = options.kind == FilterKind::bilateral ? choices & 3U : 0;
  images.reserve(4 * count);  // guides refer to them
  for (std::size_t k = 0; k < count; ++k) {
    Guide& guide = options.guides.emplace_back();
    guide.kind = input.pick(kKinds);
    guide.width = RangeWidth{0.01 + double(input.below(8)), input.pick(kUnits)};
    guide.length = length(input, 0.25);
    if (input.flag()) (input.flag() ? guide.blur : guide.median) = length(input, 0.25);
    if (guide.kind != Kind::images) continue;
    guide.name = "guide";
    guide.meaning = input.pick(kMeanings);
    guide.textures = textures;
    const int channels = guide.meaning == Guide::Meaning::values ? 1 + int(input.below(4)) : 3;
    for (TextureTile& tile : guide.textures.tiles) {
      images.push_back(make_image(1 + int(input.below(24)), 1 + int(input.below(24)), channels));
      fill_with_pattern(input, images.back());
      plant_odd_values(input, images.back());
      tile.image = &images.back();
      tile.mask = tile.sample_mask = nullptr;
      tile.space = nullptr;
    }
  }
}

}  // namespace onmesh::fuzz
