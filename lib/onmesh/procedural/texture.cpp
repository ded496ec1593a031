#include "onmesh/procedural/texture.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "onmesh/base/error.h"
#include "onmesh/base/random.h"
#include "onmesh/base/triangle.h"

namespace onmesh {
namespace {

std::uint64_t lattice(double x) { return std::uint64_t(std::int64_t(std::floor(x))); }

double smooth_step(double t) { return t * t * (3 - 2 * t); }

// Value noise: hashed lattice values, interpolated smoothly.
double value_noise(std::uint64_t seed, const Vec3& p) {
  const Vec3 t(smooth_step(p.x() - std::floor(p.x())), smooth_step(p.y() - std::floor(p.y())),
               smooth_step(p.z() - std::floor(p.z())));
  double sum = 0;
  for (unsigned corner = 0; corner < 8; ++corner) {
    const bool dx = corner & 1U, dy = corner & 2U, dz = corner & 4U;
    const double weight =
        (dx ? t.x() : 1 - t.x()) * (dy ? t.y() : 1 - t.y()) * (dz ? t.z() : 1 - t.z());
    if (weight == 0) continue;
    sum += weight *
           random_unit_at(seed, lattice(p.x()) + dx, lattice(p.y()) + dy, lattice(p.z()) + dz);
  }
  return sum;
}

// The pattern's colour at a point in units of cells; `extent` is the point within the whole, [0,1].
Vec3 pattern_colour(Pattern pattern, const Vec3& p, const Vec3& extent, std::uint64_t seed) {
  const Vec3 warm(0.88, 0.62, 0.28), cool(0.16, 0.30, 0.48), pale(0.90, 0.88, 0.82),
      red(0.72, 0.22, 0.20);
  switch (pattern) {
    case Pattern::checker:
      return (lattice(p.x()) + lattice(p.y()) + lattice(p.z())) % 2 == 0 ? warm : cool;
    case Pattern::stripes: {
      const double phase = (p.x() + 0.5 * p.y() + 0.25 * p.z()) / 3;
      const double third = 3 * (phase - std::floor(phase));
      return third < 1 ? pale : third < 2 ? red : cool;
    }
    case Pattern::noise: {
      Vec3 colour;
      for (int c = 0; c < 3; ++c) {
        const std::uint64_t octave = random_bits_at(seed, std::uint64_t(c));
        colour[c] = 0.65 * value_noise(octave, p) + 0.35 * value_noise(octave + 1, 2 * p);
      }
      return colour;
    }
    case Pattern::gradient:
      return 0.1 * Vec3::Ones() + 0.8 * extent;
    case Pattern::dots: {
      // One disk per cell, its centre and colour hashed; it stays inside its cell.
      const std::uint64_t cell =
          random_bits_at(seed, lattice(p.x()), lattice(p.y()), lattice(p.z()));
      Vec3 centre;
      for (int c = 0; c < 3; ++c)
        centre[c] = std::floor(p[c]) + 0.5 + 0.2 * (random_unit_at(cell, unsigned(c)) - 0.5);
      if ((p - centre).norm() > 0.38) return Vec3(pale);
      return cell % 3 == 0 ? warm : cell % 3 == 1 ? cool : red;
    }
  }
  return Vec3::Zero();
}

void check_size(int width, int height, int channels, double noise) {
  if (width <= 0 || height <= 0 || channels <= 0 || width > 32768 || height > 32768)
    throw UsageError("texture: size must be between 1 and 32768 texels");
  if (!(noise >= 0 && noise <= 1)) throw UsageError("texture: noise must be between 0 and 1");
}

void add_noise(Image& image, Index texel, double noise, std::uint64_t seed) {
  for (int c = 0; c < image.channels; ++c) {
    float& value = image.texel(texel)[c];
    const double delta =
        noise * (2 * random_unit_at(seed, texel, std::uint64_t(c), 0x6e6f697365ULL) - 1);
    value = float(std::clamp(value + delta, 0.0, 1.0));
  }
}

// Closest face to each texel centre within the padding, as the surface point carried on linearly.
class NearestFaces {
 public:
  NearestFaces(const TriangleMesh& mesh, int width, int height, int padding)
      : width_(width),
        height_(height),
        padding_(padding),
        distance_(std::size_t(width) * height, std::numeric_limits<double>::infinity()),
        position_(distance_.size(), Vec3::Zero()) {
    for (Index face = 0; face < mesh.faces.size(); ++face) {
      if (mesh.has_uvs(face)) add(mesh, face);
    }
  }

  bool reached(std::size_t texel) const { return std::isfinite(distance_[texel]); }
  const Vec3& position(std::size_t texel) const { return position_[texel]; }

 private:
  void add(const TriangleMesh& mesh, Index face) {
    std::array<Vec2, 3> p = mesh.corner_uvs(face);
    for (Vec2& q : p) q = Vec2(q.x() * width_, (1 - q.y()) * height_);
    const std::array<Vec3, 3> corners = mesh.corners(face);
    Eigen::Matrix2d edges;
    edges << p[1] - p[0], p[2] - p[0];
    if (edges.determinant() == 0) return;
    const Eigen::Matrix2d inverse = edges.inverse();

    const Vec2 low = p[0].cwiseMin(p[1]).cwiseMin(p[2]), high = p[0].cwiseMax(p[1]).cwiseMax(p[2]);
    const auto first = [&](double x) { return std::int64_t(std::floor(x - 0.5)) - padding_; };
    const auto last = [&](double x) { return std::int64_t(std::ceil(x - 0.5)) + padding_; };
    for (std::int64_t y = first(low.y()); y <= last(high.y()); ++y) {
      for (std::int64_t x = first(low.x()); x <= last(high.x()); ++x) {
        const Vec2 centre(double(x) + 0.5, double(y) + 0.5);
        const Vec2 b = inverse * (centre - p[0]);
        const double distance = inside(b) ? 0 : distance_to(p, centre);
        if (distance > padding_) continue;
        const std::size_t texel =
            std::size_t(wrap(y, height_)) * width_ + std::size_t(wrap(x, width_));
        if (!(distance < distance_[texel])) continue;
        distance_[texel] = distance;
        position_[texel] =
            corners[0] + b.x() * (corners[1] - corners[0]) + b.y() * (corners[2] - corners[0]);
      }
    }
  }

  static bool inside(const Vec2& b) { return b.x() >= 0 && b.y() >= 0 && b.x() + b.y() <= 1; }
  static std::int64_t wrap(std::int64_t x, int size) { return ((x % size) + size) % size; }
  static double distance_to(const std::array<Vec2, 3>& p, const Vec2& q) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < 3; ++k) {
      least = std::min(least, squared_distance_to_segment(q, p[k], p[(k + 1) % 3]));
    }
    return std::sqrt(least);
  }

  int width_, height_, padding_;
  std::vector<double> distance_;
  std::vector<Vec3> position_;
};

}  // namespace

Image make_texture(int width, int height, Pattern pattern, double noise, std::uint64_t seed,
                   int channels) {
  check_size(width, height, channels, noise);
  Image image = make_image(width, height, channels);
  const double cell = std::max(width, height) / 8.0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Vec3 p(x + 0.5, y + 0.5, 0.5 * cell);
      const Vec3 extent(p.x() / width, p.y() / height, 0.5);
      const Vec3 colour = pattern_colour(pattern, p / cell, extent, seed);
      float* texel = image.texel(Index(y) * Index(width) + Index(x));
      for (int c = 0; c < channels; ++c) texel[c] = float(colour[c % 3]);
      add_noise(image, Index(y) * Index(width) + Index(x), noise, seed);
    }
  }
  return image;
}

Image make_surface_texture(const TriangleMesh& mesh, int width, int height,
                           const SurfaceTextureOptions& options) {
  check_size(width, height, 3, options.noise);
  if (!(options.cell >= 0) || options.padding < 0 || options.padding > 64)
    throw UsageError("texture: cell must not be negative and padding must be between 0 and 64");
  if (mesh.positions.empty()) throw UsageError("texture: the mesh is empty");

  Vec3 low = mesh.positions.front(), high = low;
  for (const Vec3& p : mesh.positions) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const Vec3 size = high - low;
  const double cell = options.cell > 0 ? options.cell : size.maxCoeff() / 8;

  const NearestFaces nearest(mesh, width, height, options.padding);
  Image image = make_image(width, height, 3);
  for (std::size_t i = 0; i < std::size_t(width) * std::size_t(height); ++i) {
    Vec3 colour = Vec3::Constant(0.5);
    if (nearest.reached(i)) {
      const Vec3 p = nearest.position(i) - low;
      const Vec3 extent = p.cwiseQuotient(size.cwiseMax(1e-300)).cwiseMax(0).cwiseMin(1);
      // Half a cell of offset in every direction: a face of a box then cuts cells in their middle
      // instead of along their walls, where rounding would decide the colour.
      colour =
          pattern_colour(options.pattern, p / cell + Vec3::Constant(0.5), extent, options.seed);
    }
    for (int c = 0; c < 3; ++c) image.texel(Index(i))[c] = float(colour[c]);
    if (nearest.reached(i)) add_noise(image, Index(i), options.noise, options.seed);
  }
  return image;
}

}  // namespace onmesh
