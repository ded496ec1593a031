#include "reduced_texture.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "../review_maps.h"
#include "onmesh/base/parallel.h"

namespace onmesh::tools {
namespace {

/// Texels [first, last) of a side that one of the smaller side has.
struct Range {
  int first, last;
};

Range range_of(int place, int smaller, int larger) {
  const auto scaled = [&](int x) { return std::int64_t(x) * larger; };
  return {int(scaled(place) / smaller), int((scaled(place + 1) + smaller - 1) / smaller)};
}

/// Sums of one block, in linear light.
class BlockMean {
 public:
  BlockMean(const Image& image, const ColourSpace* space, bool is_premultiplied)
      : image_(image), space_(space), is_premultiplied_(is_premultiplied) {
    for (int c = 0; c < image.channels; ++c)
      if (c != image.alpha_channel) colours_.push_back(c);
    light_.resize(colours_.size());
    sums_.resize(colours_.size());
  }

  /// \param counted per texel; empty = all
  void find(Range columns, Range rows, const std::vector<unsigned char>& counted, float* texel) {
    std::fill(sums_.begin(), sums_.end(), 0.0);
    weight_ = alpha_ = 0;
    texels_ = 0;
    for (int y = rows.first; y < rows.last; ++y) {
      for (int x = columns.first; x < columns.last; ++x) {
        const Index i = Index(y) * Index(image_.width) + Index(x);
        if (counted.empty() || counted[i] != 0) add(image_.texel(i));
      }
    }
    if (texels_ == 0 && !counted.empty()) return find(columns, rows, {}, texel);
    write(texel);
  }

 private:
  void add(const float* from) {
    for (std::size_t k = 0; k < colours_.size(); ++k) {
      light_[k] = from[colours_[k]];
      if (!std::isfinite(light_[k])) return;
    }
    const double alpha = image_.alpha_channel >= 0 ? double(from[image_.alpha_channel]) : 1.0;
    if (!std::isfinite(alpha)) return;
    if (space_ != nullptr) space_->to_linear(light_.data(), 1, int(light_.size()));
    const double weight = is_premultiplied_ ? 1 : alpha;
    for (std::size_t k = 0; k < light_.size(); ++k) sums_[k] += weight * double(light_[k]);
    weight_ += weight;
    alpha_ += alpha;
    ++texels_;
  }

  void write(float* texel) {
    const float nothing = texels_ == 0 ? std::numeric_limits<float>::quiet_NaN() : 0.0F;
    for (std::size_t k = 0; k < light_.size(); ++k)
      light_[k] = weight_ > 0 ? float(sums_[k] / weight_) : nothing;
    if (space_ != nullptr && weight_ > 0) space_->from_linear(light_.data(), 1, int(light_.size()));
    for (std::size_t k = 0; k < light_.size(); ++k) texel[colours_[k]] = light_[k];
    if (image_.alpha_channel >= 0)
      texel[image_.alpha_channel] = texels_ > 0 ? float(alpha_ / texels_) : 0.0F;
  }

  const Image& image_;
  const ColourSpace* space_;
  bool is_premultiplied_;
  std::vector<int> colours_;  ///< channels that are no alpha
  std::vector<float> light_;
  std::vector<double> sums_;
  double weight_ = 0, alpha_ = 0;
  int texels_ = 0;
};

}  // namespace

int reduction_of(const Image& image) {
  const int longest = std::max({image.width, image.height, 1});
  return (longest + kPreviewTexels - 1) / kPreviewTexels;
}

Image reduced_texture(const Image& image, const ColourSpace* space, bool is_premultiplied,
                      const std::vector<unsigned char>& covered, int factor) {
  if (factor <= 1) return image;
  Image out = make_image((image.width + factor - 1) / factor, (image.height + factor - 1) / factor,
                         image.channels);
  out.alpha_channel = image.alpha_channel;
  out.channel_names = image.channel_names;
  out.source = image.source;  // how many levels codes have; it is not written
  parallel_over(std::size_t(out.height), [&](std::size_t row) {
    BlockMean mean(image, space, is_premultiplied);
    const Range rows = range_of(int(row), out.height, image.height);
    for (int x = 0; x < out.width; ++x) {
      mean.find(range_of(x, out.width, image.width), rows, covered,
                out.texel(Index(row) * Index(out.width) + Index(x)));
    }
  });
  round_to_codes(out);
  return out;
}

}  // namespace onmesh::tools
