#include "onmesh/render/render.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "onmesh/base/error.h"
#include "onmesh/base/triangle.h"
#include "onmesh/image/lookup.h"
#include "onmesh/render/camera.h"
#include "onmesh/render/clip.h"
#include "onmesh/render/raster.h"
#include "onmesh/render/texture_view.h"

namespace onmesh {
namespace {

constexpr int kBandRows = 16;  // pixels
const Vec3 kGrey(0.72, 0.72, 0.72);

void check(const TriangleMesh& mesh, const RenderColour& colour, const RenderOptions& options) {
  const auto within = [](double x, double low, double high) { return x >= low && x <= high; };
  if (!within(options.width, 1, 16384) || !within(options.height, 1, 16384))
    throw UsageError("view: width and height must be between 1 and 16384 pixels");
  if (!within(options.elevation_degrees, -90, 90))
    throw UsageError("view: elevation must be between -90 and 90 degrees");
  if (!std::isfinite(options.azimuth_degrees)) throw UsageError("view: azimuth must be finite");
  if (!(options.zoom > 0 && options.zoom <= 1000))
    throw UsageError("view: zoom must be in (0, 1000]");
  if (options.target && !options.target->allFinite())
    throw UsageError("view: target must be finite");
  if (!(options.extent >= 0 && std::isfinite(options.extent)))
    throw UsageError("view: extent must be a length");
  if (!within(options.supersampling, 1, 8))
    throw UsageError("view: supersampling must be between 1 and 8");
  // Products of coordinates in 256ths of a pixel must fit into 64 bits.
  if (options.zoom * std::max(options.width, options.height) * options.supersampling > 4e6)
    throw UsageError("view: zoom times pixels times supersampling must be at most 4,000,000");
  if (!options.up.allFinite() || options.up.norm() == 0)
    throw UsageError("view: up must be a direction");
  if (mesh.faces.empty()) throw InputError("view: the mesh has no faces");
  for (const Vec3& p : mesh.positions) {
    if (!p.allFinite()) throw InputError("view: the mesh has a position that is not finite");
  }
  if (colour.scalar != nullptr && colour.scalar->size() != mesh.positions.size())
    throw InputError("view: " + std::to_string(colour.scalar->size()) + " scalars for " +
                     std::to_string(mesh.positions.size()) + " vertices");
  if (!colour.face_textures.empty() && colour.face_textures.size() != mesh.faces.size())
    throw InputError("view: the number of textures is not that of faces");
}

// Normals per face corner: smooth over gentle edges, apart at creases.
std::vector<std::array<Vec3, 3>> corner_normals(const TriangleMesh& mesh) {
  const double crease = std::cos(40 * std::numbers::pi / 180);
  std::vector<Vec3> area_normal, unit_normal;
  std::vector<Index> offsets(mesh.positions.size() + 1), around(3 * mesh.faces.size());
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const auto [a, b, c] = mesh.corners(f);
    area_normal.push_back((b - a).cross(c - a));
    unit_normal.push_back(area_normal.back().stableNormalized());
    for (const Index v : mesh.faces[f]) ++offsets[v + 1];
  }
  for (std::size_t v = 0; v + 1 < offsets.size(); ++v) offsets[v + 1] += offsets[v];
  std::vector<Index> next(offsets.begin(), offsets.end() - 1);
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    for (const Index v : mesh.faces[f]) around[next[v]++] = f;
  }
  std::vector<std::array<Vec3, 3>> normals(mesh.faces.size());
  tbb::parallel_for(std::size_t(0), mesh.faces.size(), [&](std::size_t f) {
    for (unsigned k = 0; k < 3; ++k) {
      const Index v = mesh.faces[f][k];
      Vec3 sum = Vec3::Zero();
      for (Index i = offsets[v]; i < offsets[v + 1]; ++i) {
        const double cosine = unit_normal[around[i]].dot(unit_normal[f]);
        if (std::abs(cosine) >= crease) sum += (cosine < 0 ? -1 : 1) * area_normal[around[i]];
      }
      normals[f][k] = sum.squaredNorm() > 0 ? Vec3(sum.stableNormalized()) : unit_normal[f];
    }
  });
  return normals;
}

// Well separated hues for flat colours, by the golden angle.
Vec3 flat_colour(Index i) {
  Vec3 colour;
  for (int c = 0; c < 3; ++c) {
    colour[c] = 0.62 + 0.3 * std::cos(2 * std::numbers::pi * (0.381966 * i - c / 3.0));
  }
  return colour;
}

/// A face, or a part of one, on the screen.
struct DrawnTriangle {
  ScreenTriangle screen;
  Index face;
  FacePart part;
  bool is_whole;

  /// Barycentric coordinates in the face; perspective-correct, extrapolated outside.
  Vec3 weights(double px, double py) const {
    const Vec3 w = screen.weights(px, py);
    return is_whole ? w : Vec3(w[0] * part[0] + w[1] * part[1] + w[2] * part[2]);
  }
  /// Distance in samples to the face's edge k.
  double edge_distance(int k, double px, double py) const {
    if (is_whole) return screen.edge_distance(k, px, py);
    const int opposite = (k + 2) % 3;
    const double dx = weights(px + 0.5, py)[opposite] - weights(px - 0.5, py)[opposite];
    const double dy = weights(px, py + 0.5)[opposite] - weights(px, py - 0.5)[opposite];
    return std::abs(weights(px, py)[opposite]) / std::max(std::hypot(dx, dy), 1e-300);
  }
};

class Scene {
 public:
  Scene(const TriangleMesh& mesh, const RenderColour& colour, const RenderOptions& options)
      : mesh_(mesh), colour_(colour), options_(options), camera_(mesh, options) {
    project_faces();
    if (options.light) normals_ = corner_normals(mesh);
    if (colour.scalar != nullptr) find_range();
    sort_into_bands();
  }

  Image draw_picture() const {
    Image picture = make_image(options_.width, options_.height, 3);
    tbb::parallel_for(std::size_t(0), bands_.size(), [&](std::size_t i) { draw_band(i, picture); });
    return picture;
  }

 private:
  void project_faces() {
    const std::vector<ViewPlane> planes = camera_.cutting_planes(options_);
    triangles_.reserve(mesh_.faces.size());
    for (Index f = 0; f < mesh_.faces.size(); ++f) {
      std::array<Vec3, 3> corners = mesh_.corners(f);
      for (Vec3& p : corners) p = camera_.view(p);
      const bool is_whole = std::all_of(planes.begin(), planes.end(), [&](const ViewPlane& plane) {
        return std::all_of(corners.begin(), corners.end(),
                           [&](const Vec3& q) { return plane.normal.dot(q) + plane.offset >= 0; });
      });
      if (is_whole) {
        add_triangle(f, corners, whole_face(), true);
        continue;
      }
      for (const FacePart& part : clip_face(corners, planes)) {
        std::array<Vec3, 3> cut;
        for (std::size_t k = 0; k < 3; ++k) cut[k] = interpolate(corners, part[k]);
        add_triangle(f, cut, part, false);
      }
    }
  }

  /// \param corners of the part, in the view
  void add_triangle(Index face, std::array<Vec3, 3> corners, const FacePart& part, bool is_whole) {
    for (Vec3& p : corners) p = camera_.project_view(p);
    triangles_.push_back(
        {make_screen_triangle(corners, options_.supersampling), face, part, is_whole});
  }

  void find_range() {
    low_ = std::numeric_limits<double>::infinity(), high_ = -low_;
    for (const auto& face : mesh_.faces) {
      for (const Index v : face) {
        const double s = (*colour_.scalar)[v];
        if (std::isfinite(s)) low_ = std::min(low_, s), high_ = std::max(high_, s);
      }
    }
    step_ = colour_.isoline_step == 0 ? (high_ - low_) / 20 : colour_.isoline_step;
  }

  void sort_into_bands() {
    bands_.resize(std::size_t((options_.height + kBandRows - 1) / kBandRows));
    const std::int64_t rows =
        std::int64_t(kBandRows) * options_.supersampling * ScreenTriangle::kSubpixel;
    const auto last_band = std::int64_t(bands_.size()) - 1;
    for (Index t = 0; t < triangles_.size(); ++t) {
      const ScreenTriangle& screen = triangles_[t].screen;
      const auto [low, high] = std::minmax({screen.y[0], screen.y[1], screen.y[2]});
      if (screen.twice_area == 0 || high < 0) continue;
      const std::int64_t first = std::max<std::int64_t>(low, 0) / rows,
                         last = std::min(high / rows, last_band);
      for (std::int64_t band = first; band <= last; ++band) bands_[std::size_t(band)].push_back(t);
    }
  }

  void draw_band(std::size_t number, Image& picture) const {
    const int s = options_.supersampling;
    const int first = int(number) * kBandRows, last = std::min(first + kBandRows, options_.height);
    RasterBand band;
    band.width = options_.width * s;
    band.first_row = first * s;
    band.last_row = last * s;
    const std::size_t samples =
        std::size_t(band.width) * std::size_t(band.last_row - band.first_row);
    band.face.assign(samples, kNone);
    band.inverse.assign(samples, 0);
    for (const Index t : bands_[number]) draw_face(triangles_[t].screen, t, band);

    std::vector<float> buffer;
    for (int y = first; y < last; ++y) {
      for (int x = 0; x < options_.width; ++x) {
        Vec3 sum = Vec3::Zero();
        for (int j = 0; j < s; ++j) {
          for (int i = 0; i < s; ++i) {
            const int sx = x * s + i, sy = y * s + j;
            const Index t = band.face[std::size_t(sy - band.first_row) * std::size_t(band.width) +
                                      std::size_t(sx)];
            sum +=
                t == kNone ? options_.background : shade(triangles_[t], sx + 0.5, sy + 0.5, buffer);
          }
        }
        float* pixel = picture.texel(Index(y) * Index(options_.width) + Index(x));
        for (int c = 0; c < 3; ++c) pixel[c] = float(sum[c] / (s * s));
      }
    }
  }

  Vec3 shade(const DrawnTriangle& drawn, double px, double py, std::vector<float>& buffer) const {
    const Index f = drawn.face;
    const Vec3 weights = drawn.weights(px, py).cwiseMax(0);
    const Vec3 b = weights / weights.sum();
    Vec3 colour = surface_colour(drawn, b, px, py, buffer);
    if (options_.light) {
      const Vec3 at = interpolate(mesh_.corners(f), b), normal = interpolate(normals_[f], b);
      const double length = normal.norm() * (camera_.eye() - at).norm();
      const double facing = length > 0 ? std::abs(normal.dot(camera_.eye() - at)) / length : 1;
      colour *= 0.4 + 0.6 * facing;
    }
    if (options_.wireframe) {
      double nearest = std::numeric_limits<double>::infinity();
      for (int k = 0; k < 3; ++k) nearest = std::min(nearest, drawn.edge_distance(k, px, py));
      // Half a line on either side of the edge, its border softened over a pixel.
      const double ink = std::clamp(1 - nearest / options_.supersampling, 0.0, 1.0);
      colour += 0.75 * ink * (Vec3(0.05, 0.05, 0.1) - colour);
    }
    return colour;
  }

  Vec3 surface_colour(const DrawnTriangle& drawn, const Vec3& b, double px, double py,
                      std::vector<float>& buffer) const {
    const Index f = drawn.face;
    if (colour_.scalar != nullptr) return scalar_colour(drawn, b, px, py);
    const Index material = mesh_.face_materials.empty() ? kNone : mesh_.face_materials[f];
    if (colour_.by_material) return material == kNone ? kGrey : flat_colour(material);
    const Image* texture = colour_.texture;
    if (texture == nullptr && !colour_.face_textures.empty()) texture = colour_.face_textures[f];
    if (texture == nullptr || !mesh_.has_uvs(f)) return kGrey;
    const Vec2 at = interpolate(mesh_.corner_uvs(f), b);
    if (!at.allFinite()) return kGrey;
    buffer.resize(std::size_t(texture->channels));
    bilinear(*texture, mesh_.wrap_of(f, options_.wrap), at, buffer.data());
    return display_colour(buffer.data(), texture->channels);
  }

  Vec3 scalar_colour(const DrawnTriangle& drawn, const Vec3& b, double px, double py) const {
    const Index f = drawn.face;
    Vec3 s;
    for (int k = 0; k < 3; ++k) s[k] = (*colour_.scalar)[mesh_.faces[f][unsigned(k)]];
    if (!s.allFinite()) return kGrey;
    const double value = s.dot(b);
    Vec3 colour = colour_map(high_ > low_ ? (value - low_) / (high_ - low_) : 0.5);
    if (!(step_ > 0)) return colour;
    // Isolines one and a half pixels wide: the distance to the nearest one is that of the values
    // over the slope per pixel. Where lines would run together they fade.
    const double pixel = options_.supersampling;
    const double dx = drawn.weights(px + 1, py).dot(s) - drawn.weights(px - 1, py).dot(s);
    const double dy = drawn.weights(px, py + 1).dot(s) - drawn.weights(px, py - 1).dot(s);
    const double slope = std::hypot(dx, dy) / 2 * pixel;
    if (!(slope > 0)) return colour;
    const double lines = (value - low_) / step_;
    if (std::round(lines) == 0)
      return colour;  // the least value is a point or a border, not a line
    const double distance = std::abs(lines - std::round(lines)) * step_ / slope;
    const double spacing = step_ / slope;
    const double ink =
        std::clamp(1.25 - distance, 0.0, 1.0) * std::clamp((spacing - 2) / 4, 0.0, 1.0);
    return colour + 0.8 * ink * (Vec3(0.05, 0.05, 0.08) - colour);
  }

  const TriangleMesh& mesh_;
  const RenderColour& colour_;
  const RenderOptions& options_;
  Camera camera_;
  std::vector<DrawnTriangle> triangles_;
  std::vector<std::array<Vec3, 3>> normals_;
  std::vector<std::vector<Index>> bands_;
  double low_ = 0, high_ = 0, step_ = 0;
};

}  // namespace

Vec3 colour_map(double t) {
  // A straight rise of lightness from dark violet over teal to yellow in the OKLab space (Ottosson
  // 2020), with a chroma that stays within sRGB.
  t = std::clamp(t, 0.0, 1.0);
  const double lightness = 0.30 + 0.63 * t;
  const double hue = (300 - 195 * t) * std::numbers::pi / 180;
  const double chroma = 0.10 + 0.04 * t;
  const double a = chroma * std::cos(hue), b = chroma * std::sin(hue);
  const double l = std::pow(lightness + 0.3963377774 * a + 0.2158037573 * b, 3);
  const double m = std::pow(lightness - 0.1055613458 * a - 0.0638541728 * b, 3);
  const double s = std::pow(lightness - 0.0894841775 * a - 1.2914855480 * b, 3);
  const Vec3 linear(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
                    -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
                    -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s);
  Vec3 colour;
  for (int c = 0; c < 3; ++c) {
    const double x = std::clamp(linear[c], 0.0, 1.0);
    colour[c] = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
  }
  return colour;
}

Image render(const TriangleMesh& mesh, const RenderColour& colour, const RenderOptions& options) {
  check(mesh, colour, options);
  return Scene(mesh, colour, options).draw_picture();
}

}  // namespace onmesh
