#include "onmesh/render/texture_view.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "onmesh/base/error.h"

namespace onmesh {

Vec3 display_colour(const float* texel, int channels) {
  Vec3 colour;
  for (int c = 0; c < 3; ++c) {
    const float value = texel[channels >= 3 ? c : 0];
    if (!std::isfinite(value)) return {1, 0, 1};
    colour[c] = std::clamp(double(value), 0.0, 1.0);
  }
  return colour;
}

Image view_texture(const Image& texture, int size, int supersampling) {
  if (size < 1 || size > 16384) throw UsageError("view: size must be between 1 and 16384 pixels");
  if (supersampling < 1 || supersampling > 8)
    throw UsageError("view: supersampling must be between 1 and 8");
  if (texture.width < 1 || texture.height < 1 || texture.channels < 1)
    throw InputError("view: the texture is empty");
  const double texels_per_pixel = double(std::max(texture.width, texture.height)) / size;
  const auto pixels = [&](int texels) {
    return std::max(1, int(std::lround(texels / texels_per_pixel)));
  };
  Image picture = make_image(pixels(texture.width), pixels(texture.height), 3);
  // A picture smaller than the texture shows means, not every so manieth texel.
  const int samples = std::max(supersampling, int(std::ceil(texels_per_pixel)));
  const auto texel_at = [&](int pixel, int sample, int pixels_in_all, int texels_in_all) {
    const double share = (pixel + (sample + 0.5) / samples) / pixels_in_all;
    return std::min(int(share * texels_in_all), texels_in_all - 1);
  };
  tbb::parallel_for(0, picture.height, [&](int y) {
    for (int x = 0; x < picture.width; ++x) {
      Vec3 sum = Vec3::Zero();
      for (int j = 0; j < samples; ++j) {
        const int row = texel_at(y, j, picture.height, texture.height);
        for (int i = 0; i < samples; ++i) {
          const int column = texel_at(x, i, picture.width, texture.width);
          sum += display_colour(texture.texel(Index(row) * Index(texture.width) + Index(column)),
                                texture.channels);
        }
      }
      float* pixel = picture.texel(Index(y) * Index(picture.width) + Index(x));
      for (int c = 0; c < 3; ++c) pixel[c] = float(sum[c] / (double(samples) * samples));
    }
  });
  return picture;
}

Image side_by_side(const std::vector<Image>& pictures, int gap) {
  int width = 0, height = 0, channels = 3;
  for (const Image& picture : pictures) {
    if (&picture == &pictures.front()) channels = picture.channels;
    if (picture.channels != channels)
      throw InputError("pictures to be put beside each other differ in channels");
    width += picture.width + (&picture == &pictures.front() ? 0 : gap);
    height = std::max(height, picture.height);
  }
  Image sheet = make_image(width, height, channels);
  std::fill(sheet.pixels.begin(), sheet.pixels.end(), 1.0F);
  int x = 0;
  for (const Image& picture : pictures) {
    for (int y = 0; y < picture.height; ++y) {
      std::copy_n(picture.texel(Index(y) * Index(picture.width)),
                  std::size_t(picture.width) * std::size_t(channels),
                  sheet.texel(Index(y) * Index(width) + Index(x)));
    }
    x += picture.width + gap;
  }
  return sheet;
}

}  // namespace onmesh
