#include "onmesh/measure/image_difference.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "onmesh/base/error.h"
#include "onmesh/base/parallel.h"

namespace onmesh {
namespace {

std::string size_of(const Image& image) {
  return std::to_string(image.width) + " x " + std::to_string(image.height) + " with " +
         std::to_string(image.channels) + " channels";
}

/// What a row of the images adds to their difference.
struct RowDifference {
  double squares = 0, max = 0;
  Index worst = kNone;  ///< the first texel compared that has the maximum
  Index texels = 0;     ///< compared
  Index bad = kNone;    ///< the first texel that is not finite in one image only
};

RowDifference difference_in_row(const Image& a, const Image& b,
                                const std::vector<unsigned char>& counted, Index y) {
  RowDifference row;
  const Index begin = y * Index(a.width);
  for (Index i = begin; i < begin + Index(a.width); ++i) {
    if (!counted.empty() && counted[i] == 0) continue;
    ++row.texels;
    if (row.worst == kNone) row.worst = i;
    for (int c = 0; c < a.channels; ++c) {
      const float va = a.texel(i)[c], vb = b.texel(i)[c];
      if (va == vb || (std::isnan(va) && std::isnan(vb))) continue;
      const double d = std::abs(double(va) - double(vb));
      if (!std::isfinite(d)) {
        if (row.bad == kNone) row.bad = i;
        continue;
      }
      row.squares += d * d;
      if (d > row.max) {
        row.max = d;
        row.worst = i;
      }
    }
  }
  return row;
}

double decibels(double rms) {
  return rms > 0 ? -20 * std::log10(rms) : std::numeric_limits<double>::infinity();
}

}  // namespace

std::vector<unsigned char> covered_texels(const TexelMap& map, Index tile) {
  const TexelTile& of = map.tiles[tile];
  std::vector<unsigned char> covered(of.size());
  for (Index i = 0; i < of.size(); ++i)
    covered[i] = map.coverage[of.first + i] == Coverage::covered ? 1 : 0;
  return covered;
}

ImageDifference difference(const Image& a, const Image& b,
                           const std::vector<unsigned char>& counted) {
  if (a.width != b.width || a.height != b.height || a.channels != b.channels)
    throw InputError("the images differ in size: " + size_of(a) + " and " + size_of(b));
  if (!counted.empty() && counted.size() != std::size_t(a.width) * std::size_t(a.height))
    throw InputError("what is to be compared is not of the images' size");
  std::vector<RowDifference> rows(std::size_t(a.height));
  parallel_over(rows.size(),
                [&](std::size_t y) { rows[y] = difference_in_row(a, b, counted, Index(y)); });
  ImageDifference result;
  double squares = 0;
  bool first = true;
  for (const RowDifference& row : rows) {
    if (row.bad != kNone)
      throw InputError(
          "the images cannot be compared: texel " + std::to_string(row.bad % Index(a.width)) +
          ", " + std::to_string(row.bad / Index(a.width)) + " is not finite in one of them only");
    squares += row.squares;
    result.texels += row.texels;
    if (row.worst != kNone && (first || row.max > result.max)) {
      result.max = row.max;
      result.worst_texel = row.worst;
      first = false;
    }
  }
  const double values = double(result.texels) * a.channels;
  result.rms = values > 0 ? std::sqrt(squares / values) : 0;
  result.psnr = decibels(result.rms);
  return result;
}

ImageDifference together(const std::vector<ImageDifference>& parts, std::size_t* which) {
  ImageDifference result;
  double squares = 0;
  std::size_t worst = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    squares += parts[i].rms * parts[i].rms * parts[i].texels;
    result.texels += parts[i].texels;
    if (parts[i].max > parts[worst].max) worst = i;
  }
  result.max = parts[worst].max;
  result.worst_texel = parts[worst].worst_texel;
  if (result.texels > 0) result.rms = std::sqrt(squares / result.texels);
  result.psnr = decibels(result.rms);
  if (which != nullptr) *which = worst;
  return result;
}

}  // namespace onmesh
