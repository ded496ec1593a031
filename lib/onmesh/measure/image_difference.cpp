#include "onmesh/measure/image_difference.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "onmesh/atlas/unfolded_walk.h"
#include "onmesh/atlas/uv_triangle.h"
#include "onmesh/base/error.h"
#include "onmesh/base/parallel.h"

namespace onmesh {
namespace {

std::string size_of(const Image& image) {
  return std::to_string(image.width) + " x " + std::to_string(image.height) + " with " +
         std::to_string(image.channels) + " channels";
}

/// Index of a column or row outside the image.
std::size_t wrapped(double index, int size, Wrap wrap) {
  if (wrap == Wrap::clamp) return std::size_t(std::clamp(index, 0.0, size - 1.0));
  const double rest = index - size * std::floor(index / size);
  return std::min(std::size_t(rest), std::size_t(size - 1));
}

}  // namespace

ImageDifference difference(const Image& a, const Image& b, const TexelMap* map) {
  if (a.width != b.width || a.height != b.height || a.channels != b.channels)
    throw InputError("the images differ in size: " + size_of(a) + " and " + size_of(b));
  if (map != nullptr && (map->width != a.width || map->height != a.height))
    throw InputError("the texel map is not of the images' size");
  struct Row {
    double squares = 0, max = 0;
    Index worst = kNone, texels = 0, bad = kNone;
  };
  std::vector<Row> rows(std::size_t(a.height));
  parallel_over(rows.size(), [&](std::size_t y) {
    Row& row = rows[y];
    const Index begin = Index(y) * Index(a.width);
    for (Index i = begin; i < begin + Index(a.width); ++i) {
      if (map != nullptr && map->coverage[i] != Coverage::covered) continue;
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
  });
  ImageDifference result;
  double squares = 0;
  bool first = true;
  for (const Row& row : rows) {
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
  result.psnr =
      result.rms > 0 ? -20 * std::log10(result.rms) : std::numeric_limits<double>::infinity();
  return result;
}

SeamError seam_error(const TriangleMesh& mesh, const TexelMap& map, const Image& image) {
  if (map.width != image.width || map.height != image.height)
    throw InputError("the texel map is not of the image's size");
  const UnfoldedWalk walk(mesh, map);
  struct Seam {
    Index face, other;  ///< 3 * face + edge
    double length = 0, mean_square = 0, max = 0;
  };
  std::vector<Seam> seams;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const Index other = walk.across(f, k);
      if (other == kNone || walk.across_in_chart(f, k) == other) continue;
      // Once, unless the surface branches and the way back leads elsewhere.
      const bool mutual = walk.across(other / 3, int(other % 3)) == 3 * f + Index(k);
      if (mutual && other / 3 < f) continue;
      if (map.chart_of_face[f] == kNone || map.chart_of_face[other / 3] == kNone) continue;
      seams.push_back({3 * f + Index(k), other});
    }
  }
  const auto channels = std::size_t(image.channels);
  parallel_over(seams.size(), [&](std::size_t i) {
    Seam& seam = seams[i];
    const Index f = seam.face / 3, g = seam.other / 3;
    const std::size_t a = seam.face % 3, b = (a + 1) % 3, c = seam.other % 3, d = (c + 1) % 3;
    const bool opposed = mesh.faces[f][a] == mesh.faces[g][d];
    const auto u = mesh.corner_uvs(f), v = mesh.corner_uvs(g);
    const Vec2 u0 = u[a], u1 = u[b], v0 = v[opposed ? d : c], v1 = v[opposed ? c : d];
    seam.length = (mesh.positions[mesh.faces[f][b]] - mesh.positions[mesh.faces[f][a]]).norm();
    const Vec2 size(map.width, map.height);
    const double pixels =
        std::max((u1 - u0).cwiseProduct(size).norm(), (v1 - v0).cwiseProduct(size).norm());
    const int points = int(std::ceil(std::min(2 * pixels, 1e6))) + 1;
    std::vector<float> one(channels), two(channels);
    for (int p = 0; p < points; ++p) {
      const double t = points > 1 ? p / (points - 1.0) : 0.5;
      bilinear(image, map.wrap, (1 - t) * u0 + t * u1, one.data());
      bilinear(image, map.wrap, (1 - t) * v0 + t * v1, two.data());
      for (std::size_t ch = 0; ch < channels; ++ch) {
        if (one[ch] == two[ch] || !std::isfinite(one[ch]) || !std::isfinite(two[ch])) continue;
        const double e = std::abs(double(one[ch]) - double(two[ch]));
        seam.mean_square += e * e / (double(points) * double(channels));
        seam.max = std::max(seam.max, e);
      }
    }
  });
  SeamError result;
  double squares = 0;
  for (const Seam& seam : seams) {
    squares += seam.length * seam.mean_square;
    result.length += seam.length;
    result.max = std::max(result.max, seam.max);
  }
  result.edges = Index(seams.size());
  if (result.length > 0) result.rms = std::sqrt(squares / result.length);
  return result;
}

void bilinear(const Image& image, Wrap wrap, const Vec2& uv, float* out) {
  const double x = uv.x() * image.width - 0.5, y = (1 - uv.y()) * image.height - 0.5;
  const double x0 = std::floor(x), y0 = std::floor(y);
  const double fx = x - x0, fy = y - y0;
  const std::size_t width = std::size_t(image.width), channels = std::size_t(image.channels);
  const std::size_t left = wrapped(x0, image.width, wrap),
                    right = wrapped(x0 + 1, image.width, wrap);
  const std::size_t top = wrapped(y0, image.height, wrap) * width;
  const std::size_t bottom = wrapped(y0 + 1, image.height, wrap) * width;
  const float* p = image.pixels.data();
  for (std::size_t c = 0; c < channels; ++c) {
    const auto value = [&](std::size_t row, std::size_t column) {
      return double(p[(row + column) * channels + c]);
    };
    // Weights of 0 leave their texel out, so that one that is not finite does not spread.
    const auto mix = [](double a, double b, double t) {
      return t == 0 ? a : t == 1 ? b : a + t * (b - a);
    };
    const double above = mix(value(top, left), value(top, right), fx);
    out[c] =
        float(mix(above, fy == 0 ? above : mix(value(bottom, left), value(bottom, right), fx), fy));
  }
}

}  // namespace onmesh
