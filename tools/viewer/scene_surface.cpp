#include "scene_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "../distance_field.h"
#include "onmesh/base/error.h"
#include "onmesh/base/parallel.h"
#include "onmesh/base/triangle.h"
#include "onmesh/measure/seam_edges.h"
#include "onmesh/mesh/shading_normals.h"
#include "onmesh/nodes/overlay_lookup.h"
#include "scene_mesh.h"

namespace onmesh::tools {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

template <class Point>
void append(const Point& p, std::vector<float>& values) {
  for (Eigen::Index k = 0; k < p.size(); ++k) values.push_back(float(p[k]));
}

/// Both ends of a side.
/// \param side 3 * face + edge
std::pair<std::size_t, std::size_t> ends(Index side) { return {side % 3, (side % 3 + 1) % 3}; }

/// The part of a node face's edge that lies within an input face, by barycentric coordinates there.
struct EdgePart {
  Vec3 from, to;
  bool is_there = false;
};

/// \param to_node from coordinates in the input face to those in the node face
/// \param zero the node face's coordinate that is 0 on the edge
EdgePart edge_within_face(const Eigen::Matrix3d& to_node, int zero) {
  // The line through the two points where it meets the sides of the input face, cut to where the
  // node face's other coordinates are not negative either.
  constexpr double kRounding = 1e-9;
  Vec3 values = to_node.row(zero);
  for (double& value : values)
    if (std::abs(value) < kRounding) value = 0;
  std::vector<Vec3> hits;
  for (int k = 0; k < 3; ++k) {
    const double a = values[k], b = values[(k + 1) % 3];
    if (a == 0) hits.emplace_back(Vec3::Unit(k));
    if (!((a < 0 && b > 0) || (a > 0 && b < 0))) continue;
    Vec3 hit = Vec3::Zero();
    hit[k] = b / (b - a);
    hit[(k + 1) % 3] = -a / (b - a);
    hits.push_back(hit);
  }
  if (hits.size() != 2) return {};
  double from = 0, to = 1;
  for (int j = 0; j < 3; ++j) {
    if (j == zero) continue;
    const double a = to_node.row(j) * hits[0], b = to_node.row(j) * hits[1];
    if (a < kRounding && b < kRounding) return {};
    if (a < 0) from = std::max(from, a / (a - b));
    if (b < 0) to = std::min(to, a / (a - b));
  }
  if (!(from < to)) return {};
  const Vec3 step = hits[1] - hits[0];
  return {hits[0] + from * step, hits[0] + to * step, true};
}

/// How often the edges of each face are divided so that there are not too many parts.
std::vector<Index> divisions(const TriangleMesh& mesh) {
  constexpr double kMostTriangles = 250'000;
  constexpr double kMostDivisions = 256;
  std::vector<double> longest;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const auto c = mesh.corners(f);
    longest.push_back(std::max({(c[1] - c[0]).norm(), (c[2] - c[1]).norm(), (c[0] - c[2]).norm()}));
  }
  const auto parts = [&](double length, double step) {
    return std::clamp(std::ceil(length / step), 1.0, kMostDivisions);
  };
  double step = mesh.diagonal() / 200;
  for (int tries = 0; tries < 60; ++tries, step *= 1.2) {
    double sum = 0;
    for (const double length : longest) sum += parts(length, step) * parts(length, step);
    if (sum <= std::max(kMostTriangles, double(mesh.faces.size()))) break;
  }
  std::vector<Index> result;
  for (const double length : longest) result.push_back(Index(parts(length, step)));
  return result;
}

/// The surface as small triangles: of each face (n + 1) (n + 2) / 2 vertices, row by row.
struct DividedSurface {
  std::vector<SurfacePoint> points;
  std::vector<std::uint32_t> indices;
};

DividedSurface divide(const TriangleMesh& mesh) {
  const std::vector<Index> parts = divisions(mesh);
  DividedSurface out;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const auto n = parts[f], first = Index(out.points.size());
    for (Index i = 0; i <= n; ++i)
      for (Index j = 0; j <= n - i; ++j)
        out.points.push_back({f, Vec3(double(n - i - j), double(j), double(i)) / double(n)});
    // Row i has n - i + 1 vertices.
    Index row = first;
    for (Index i = 0; i < n; ++i) {
      const Index next = row + n - i + 1;
      for (Index j = 0; j < n - i; ++j) {
        out.indices.insert(out.indices.end(), {row + j, row + j + 1, next + j});
        if (j + 1 < n - i)
          out.indices.insert(out.indices.end(), {row + j + 1, next + j + 1, next + j});
      }
      row = next;
    }
  }
  return out;
}

/// A step for isolines: 1, 2 or 5 times a power of ten, some twenty of them.
double round_step(double range) {
  if (!(range > 0)) return 1;
  const double rough = range / 20, power = std::pow(10, std::floor(std::log10(rough)));
  const double digits = rough / power;
  return power * (digits < 1.5 ? 1 : digits < 3.5 ? 2 : digits < 7.5 ? 5 : 10);
}

}  // namespace

std::vector<float> seam_errors(const std::vector<Image>& images, const TriangleMesh& mesh,
                               const TexelMap& map, std::size_t seams) {
  std::vector<float> errors(seams, kUnknown);
  std::vector<const Image*> pointers;
  for (const Image& image : images) pointers.push_back(&image);
  try {
    const std::vector<MeasuredSeam> measured = measure_seams(mesh, map, pointers);
    for (std::size_t i = 0; i < seams; ++i) errors[i] = float(std::sqrt(measured[i].mean_square));
  } catch (const InputError&) {
    // An image that is lost, or of another size: scene_map() notes it.
  }
  return errors;
}

nlohmann::json scene_seams(const Review& review, const TriangleMesh& mesh,
                           const std::vector<const TexelMap*>& maps, PageWriter& page) {
  const auto some =
      std::find_if(maps.begin(), maps.end(), [](auto* map) { return map != nullptr; });
  if (some == maps.end()) return {};
  const TexelMap& map = **some;
  const std::vector<Seam> seams = find_seams(mesh, map);
  std::vector<float> segments, uvs;
  std::vector<std::uint16_t> tiles;
  for (const Seam& seam : seams) {
    const auto [a, b] = ends(seam.side);
    auto [c, d] = ends(seam.other_side);
    if (seam.opposed) std::swap(c, d);
    const auto corners = mesh.corners(seam.face());
    const auto one = mesh.corner_uvs(seam.face()), two = mesh.corner_uvs(seam.other_face());
    append(corners[a], segments);
    append(corners[b], segments);
    for (const Vec2& uv : {one[a], one[b], two[c], two[d]}) append(uv, uvs);
    tiles.push_back(std::uint16_t(map.tile_number(seam.face())));
    tiles.push_back(std::uint16_t(map.tile_number(seam.other_face())));
  }
  nlohmann::json errors = nlohmann::json::array();
  for (std::size_t m = 0; m < review.maps.size(); ++m) {
    nlohmann::json states = nlohmann::json::array();
    const auto add = [&](const std::vector<Image>& images) {
      const bool is_known = maps[m] != nullptr;
      states.push_back(page.add(is_known ? seam_errors(images, mesh, *maps[m], seams.size())
                                         : std::vector<float>(seams.size(), kUnknown)));
    };
    add(review.maps[m].before);
    for (const auto& images : review.maps[m].after) add(images);
    errors.push_back(std::move(states));
  }
  return {{"count", seams.size()},
          {"segments", page.add(segments)},
          {"uvs", page.add(uvs)},
          {"tiles", page.add(tiles)},
          {"errors", errors}};
}

nlohmann::json scene_samples(const Review& review, PageWriter& page) {
  if (review.samples.empty()) return {};
  std::vector<float> positions;
  for (const SurfacePoint& p : review.samples) append(review.mesh->cleaned.position(p), positions);
  return {{"positions", page.add(positions)},
          {"count", review.samples.size()},
          {"kind", review.samples_text}};
}

nlohmann::json scene_nodes(const Review& review, PageWriter& page) {
  if (!review.shows_nodes) return {};
  const TriangleMesh& mesh = review.mesh->cleaned;
  const NodeMesh& nodes = review.surface.nodes;
  const Overlay& overlay = review.surface.overlay;
  std::vector<float> segments;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    for (Index i = overlay.face_offsets[f]; i < overlay.face_offsets[f + 1]; ++i) {
      const OverlayPiece& piece = overlay.pieces[i];
      for (int k = 0; k < 3; ++k) {
        // An edge is drawn once, by the face that comes first.
        const Index there = nodes.neighbours.empty() ? kNone : nodes.neighbours[piece.node_face][k];
        if (there != kNone && there < 3 * piece.node_face + Index(k)) continue;
        const EdgePart part = edge_within_face(piece.to_node, (k + 2) % 3);
        if (!part.is_there) continue;
        append(mesh.position({f, part.from}), segments);
        append(mesh.position({f, part.to}), segments);
      }
    }
  }
  return {{"segments", page.add(segments)},
          {"count", nodes.nodes.size()},
          {"edges", nodes.faces.size() * 3 / 2}};
}

FieldSurface::FieldSurface(const TriangleMesh& mesh, const NodeSurface& surface)
    : nodes_(surface.nodes) {
  const DividedSurface divided = divide(mesh);
  const std::vector<std::array<Vec3, 3>> corner_normals = shading_normals(mesh);
  std::vector<Vec3> normals;
  for (const SurfacePoint& p : divided.points) {
    append(mesh.position(p), positions_);
    const auto& n = corner_normals[p.face];
    const Vec3 &b = p.barycentric, mean = b[0] * n[0] + b[1] * n[1] + b[2] * n[2];
    normals.push_back(mean.stableNormalized());
  }
  normals_ = rounded_normals(normals);
  indices_ = divided.indices;
  const OverlayLookup lookup(surface.overlay);
  places_.resize(divided.points.size());
  parallel_over(places_.size(),
                [&](std::size_t i) { places_[i] = lookup.locate(divided.points[i]); });
}

nlohmann::json FieldSurface::scene(PageWriter& page) const {
  return {{"vertices", places_.size()},        {"triangles", indices_.size() / 3},
          {"positions", page.add(positions_)}, {"normals", page.add(normals_)},
          {"indices", page.add(indices_)},     {"layers", nlohmann::json::array()}};
}

nlohmann::json FieldSurface::layer(const ReviewDistances& distances, PageWriter& page) const {
  std::vector<float> values;
  double farthest = 0;
  for (const NodePoint& place : places_) {
    const double d =
        place.face == kNone ? double(kUnknown) : distance_at(nodes_, place, distances.at_nodes);
    values.push_back(float(d));
    if (std::isfinite(d)) farthest = std::max(farthest, d);
  }
  const Vec3& p = distances.source;
  return {{"name", distances.name},
          {"values", page.add(values)},
          {"min", 0},
          {"max", farthest},
          {"unit", "mesh units"},
          {"source", {p.x(), p.y(), p.z()}},
          {"step", round_step(farthest)}};
}

nlohmann::json scene_fields(const Review& review, PageWriter& page) {
  if (review.distances.empty()) return {};
  const FieldSurface surface(review.mesh->cleaned, review.surface);
  nlohmann::json json = surface.scene(page);
  for (const ReviewDistances& distances : review.distances)
    json["layers"].push_back(surface.layer(distances, page));
  return json;
}

}  // namespace onmesh::tools
