#include "scene_maps.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "onmesh/base/error.h"
#include "onmesh/base/parallel.h"
#include "onmesh/image/colour_space.h"
#include "onmesh/measure/image_difference.h"
#include "onmesh/measure/seam_error.h"

namespace onmesh::tools {
namespace {

/// Texels per side that a page holds.
constexpr int kMostTexels = 4096;
/// Beyond so many values floats are halved: what they lose is 1/2048 of their size.
constexpr std::size_t kManyValues = 4'000'000;

std::string size_text(const Image& image) {
  return std::to_string(image.width) + " x " + std::to_string(image.height);
}

/// Means over blocks of texels, of the codes as they are.
Image scaled_down(const Image& image, int factor) {
  Image out = make_image((image.width + factor - 1) / factor, (image.height + factor - 1) / factor,
                         image.channels);
  out.alpha_channel = image.alpha_channel;
  parallel_over(std::size_t(out.height), [&](std::size_t row) {
    const int first = int(row) * factor, last = std::min(first + factor, image.height);
    for (int x = 0; x < out.width; ++x) {
      float* const texel = out.texel(Index(row) * Index(out.width) + Index(x));
      const int left = x * factor, right = std::min(left + factor, image.width);
      for (int j = first; j < last; ++j) {
        for (int i = left; i < right; ++i) {
          const float* const from = image.texel(Index(j) * Index(image.width) + Index(i));
          for (int c = 0; c < image.channels; ++c) texel[c] += from[c];
        }
      }
      for (int c = 0; c < image.channels; ++c) texel[c] /= float((last - first) * (right - left));
    }
  });
  return out;
}

template <class Value, class Convert>
std::vector<std::byte> bytes_of(const std::vector<float>& values, const Convert& convert) {
  std::vector<std::byte> bytes(values.size() * sizeof(Value));
  over_blocks(values.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Value value = convert(values[i]);
      std::memcpy(&bytes[i * sizeof(Value)], &value, sizeof(Value));
    }
  });
  return bytes;
}

template <class Code>
std::vector<std::byte> codes_of(const std::vector<float>& values) {
  constexpr double kMost = std::numeric_limits<Code>::max();
  return bytes_of<Code>(values, [](float v) {
    return Code(std::isnan(v) ? 0 : std::lround(std::clamp(double(v), 0.0, 1.0) * kMost));
  });
}

nlohmann::json add_image(const Image& image, int levels, PageWriter& page) {
  const auto channels = std::size_t(image.channels), row = std::size_t(image.width) * channels;
  const auto add = [&](std::vector<std::byte> bytes, const char* type, std::size_t size) {
    return page.add_rows(std::move(bytes), type, size, row * size, channels * size);
  };
  if (levels == 255) return add(codes_of<std::uint8_t>(image.pixels), "u8", 1);
  if (levels > 0) return add(codes_of<std::uint16_t>(image.pixels), "u16", 2);
  if (image.pixels.size() > kManyValues)
    return add(bytes_of<Eigen::half>(image.pixels, [](float v) { return Eigen::half(v); }), "f16",
               2);
  return add(bytes_of<float>(image.pixels, [](float v) { return v; }), "f32", 4);
}

/// Of the finite values of all channels but alpha.
std::pair<double, double> range_of(const ReviewMap& map) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  const auto look = [&](const std::vector<Image>& images) {
    for (const Image& image : images) {
      for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const float v = image.pixels[i];
        if (int(i % std::size_t(image.channels)) == image.alpha_channel || !std::isfinite(v))
          continue;
        low = std::min(low, double(v));
        high = std::max(high, double(v));
      }
    }
  };
  look(map.before);
  for (const auto& images : map.after) look(images);
  return low <= high ? std::pair(low, high) : std::pair(0.0, 1.0);
}

const Image* first_image(const ReviewMap& map) {
  const auto find = [](const std::vector<Image>& images) -> const Image* {
    const auto there = std::find_if(images.begin(), images.end(),
                                    [](const Image& image) { return !image.pixels.empty(); });
    return there == images.end() ? nullptr : &*there;
  };
  const Image* image = find(map.before);
  for (std::size_t run = 0; image == nullptr && run < map.after.size(); ++run)
    image = find(map.after[run]);
  return image;
}

std::vector<std::string> channel_names(const Image& image) {
  if (!image.channel_names.empty()) return image.channel_names;
  static const char* const kNames[] = {"R", "G", "B", "A"};
  std::vector<std::string> names;
  for (int c = 0; c < image.channels; ++c) {
    const bool is_grey = image.channels <= 2;
    names.push_back(is_grey ? (c == 0 ? "Y" : "A") : c < 4 ? kNames[c] : std::to_string(c));
  }
  return names;
}

}  // namespace

nlohmann::json scene_image(const Image& image, const std::string& file, PageWriter& page,
                           std::vector<std::string>& notes) {
  if (image.pixels.empty()) return {};
  const int levels = levels_of(image);
  const int longest = std::max(image.width, image.height);
  const int factor = (longest + kMostTexels - 1) / kMostTexels;
  Image scaled;
  if (factor > 1) scaled = scaled_down(image, factor);
  const Image& shown = factor > 1 ? scaled : image;
  if (factor > 1)
    notes.push_back(file + " is shown at " + size_text(shown) + " instead of " + size_text(image));
  nlohmann::json json = add_image(shown, levels, page);
  json["width"] = shown.width;
  json["height"] = shown.height;
  json["channels"] = shown.channels;
  json["alpha"] = shown.alpha_channel;
  json["full_width"] = image.width;
  json["full_height"] = image.height;
  return json;
}

nlohmann::json scene_map(const Review& review, const ReviewMap& map, PageWriter& page,
                         std::vector<std::string>& notes) {
  nlohmann::json json;
  json["name"] = map.name.empty() ? "texture" : map.name;
  json["space"] = map.space;
  json["before"] = json["after"] = nlohmann::json::array();
  for (std::size_t t = 0; t < map.before.size(); ++t)
    json["before"].push_back(scene_image(map.before[t], map.files[t], page, notes));
  for (std::size_t run = 0; run < map.after.size(); ++run) {
    nlohmann::json images = nlohmann::json::array();
    for (std::size_t t = 0; t < map.after[run].size(); ++t) {
      const Image &after = map.after[run][t], &before = map.before[t];
      const std::string name = review.after_names[run] + " (" + map.files[t] + ")";
      images.push_back(scene_image(after, name, page, notes));
      if (after.pixels.empty() || before.pixels.empty()) continue;
      if (size_text(after) != size_text(before) || after.channels != before.channels) {
        notes.push_back(name + ": " + size_text(after) + " with " + std::to_string(after.channels) +
                        " channels does not fit " + map.files[t] + ": " + size_text(before) +
                        " with " + std::to_string(before.channels) +
                        "; their differences are not shown");
      }
    }
    json["after"].push_back(std::move(images));
  }
  const Image* const first = first_image(map);
  json["hdr"] = first != nullptr && levels_of(*first) == 0;
  json["display"] = {{"encoding", map.space == "linear" ? "linear" : "srgb"}};
  json["channels"] = first != nullptr ? channel_names(*first) : std::vector<std::string>();
  const auto [low, high] = range_of(map);
  json["range"] = {low, high};
  return json;
}

nlohmann::json map_numbers(const ReviewMap& map, std::size_t run, const TriangleMesh& mesh,
                           const TexelMap* texels) {
  std::vector<ImageDifference> parts;
  std::vector<const Image*> before, after;
  try {
    for (std::size_t t = 0; t < map.before.size(); ++t) {
      const Image &a = map.before[t], &b = map.after[run][t];
      if (a.pixels.empty() || b.pixels.empty()) return {};
      const auto counted =
          texels != nullptr ? covered_texels(*texels, Index(t)) : std::vector<unsigned char>();
      parts.push_back(difference(a, b, counted));
      before.push_back(&a);
      after.push_back(&b);
    }
    if (parts.empty()) return {};
    const ImageDifference all = together(parts);
    nlohmann::json json{{"psnr_db", all.psnr}, {"rms", all.rms}, {"max", all.max}};
    if (!std::isfinite(all.psnr)) json["psnr_db"] = nullptr;  // they are equal
    if (texels != nullptr) {
      json["seam_rms_before"] = seam_error(mesh, *texels, before).rms;
      json["seam_rms_after"] = seam_error(mesh, *texels, after).rms;
    }
    return json;
  } catch (const InputError&) {
    return {};  // of other sizes or channels, which scene_map() notes
  }
}

}  // namespace onmesh::tools
