#include "distance_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "atlas.h"
#include "format.h"
#include "onmesh/base/face_error.h"
#include "onmesh/base/triangle.h"
#include "onmesh/distance/make_backend.h"
#include "onmesh/measure/nearby_geodesics.h"
#include "onmesh/mesh/closest_point.h"
#include "onmesh/nodes/expected_nodes.h"
#include "onmesh/patches/grow_patch.h"
#include "onmesh/samples/samples.h"

namespace onmesh::tools {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Longer than any shortest path: one passes each face at most once.
double longest_path(const NodeMesh& nodes) {
  double sum = 0;
  for (const auto& l : nodes.lengths) sum += std::max({l[0], l[1], l[2]});
  return sum;
}

/// A distance per texel, NaN to begin with.
class DistanceTexture {
 public:
  explicit DistanceTexture(const TexelMap& map) : images_(images_like(map.tiles, 1)) {
    for (Image& image : images_) {
      std::fill(image.pixels.begin(), image.pixels.end(), float(kNaN));
      texels_.add(image);
    }
  }

  void take_least(Index texel, double distance) {
    float& value = *texels_[texel];
    if (!(value <= float(distance))) value = float(distance);  // NaN is replaced
  }
  std::vector<Image> finish() { return std::move(images_); }

 private:
  std::vector<Image> images_;
  TexelValues texels_;
};

}  // namespace

double default_spacing(const TriangleMesh& mesh, double radius) {
  constexpr double kEnough = 2e6;  // nodes that are added, unless someone asks for more
  RefineOptions options;
  options.spacing = std::max(std::min({mesh.mean_edge_length(), mesh.diagonal() / 100, radius / 5}),
                             mesh.diagonal() * 1e-9);
  for (int tries = 0; tries < 8; ++tries) {
    const double added = expected_nodes(mesh, options) - double(mesh.positions.size());
    if (added <= kEnough) break;
    options.spacing *= std::sqrt(added / kEnough);
  }
  return options.spacing;
}

DistanceSource source_at_vertex(const InputMesh& input, std::int64_t vertex, const char* option) {
  const std::size_t count = input.as_read.positions.size();
  const std::string name = dashed(option) + ": " + std::to_string(vertex);
  if (vertex < 0 || std::uint64_t(vertex) >= count)
    throw UsageError(name + ": " + input.path + " has vertices 0 to " + std::to_string(count - 1));
  // Welding merges what is equal, so the position tells which vertex it became.
  Vec3 position = input.as_read.positions[std::size_t(vertex)];
  const auto& welded = input.welded.positions;
  const auto found = std::find(welded.begin(), welded.end(), position);
  if (found != welded.end())
    position = input.joined.positions[input.joining.vertex[Index(found - welded.begin())]];
  const TriangleMesh& mesh = input.cleaned;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      if (mesh.positions[mesh.faces[f][k]] == position)
        return {{f, Vec3::Unit(k)}, mesh.faces[f][k], 0};
    }
  }
  throw UsageError(name + ": no face of " + input.path + " that is part of the surface uses it");
}

DistanceSource source_at_uv(const TriangleMesh& mesh, const Vec2& uv, const char* option) {
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (!mesh.has_uvs(f)) continue;
    const auto c = mesh.corner_uvs(f);
    const Vec2 low = c[0].cwiseMin(c[1]).cwiseMin(c[2]), high = c[0].cwiseMax(c[1]).cwiseMax(c[2]);
    constexpr double kRounding = 1e-9;
    const Vec2 first = (low - uv).array() - kRounding, last = (high - uv).array() + kRounding;
    if (!((last - first).maxCoeff() < 20000)) continue;
    for (double y = std::ceil(first.y()); y <= last.y(); ++y) {
      for (double x = std::ceil(first.x()); x <= last.x(); ++x) {
        Vec3 b = barycentric_in(c, uv + Vec2(x, y));
        if (!(b.minCoeff() >= -kRounding)) continue;  // also if the triangle has no area
        b = b.cwiseMax(0);
        return {{f, b / b.sum()}, kNone, 0};
      }
    }
  }
  throw UsageError(dashed(option) + ": no UV triangle holds " + format_number(uv.x()) + "," +
                   format_number(uv.y()));
}

DistanceSource source_at_point(const TriangleMesh& mesh, const Vec3& point) {
  const SurfacePoint closest = ClosestPoint(mesh).closest(point);
  return {closest, kNone, (mesh.position(closest) - point).norm()};
}

std::vector<double> at_welded_vertices(const InputMesh& input,
                                       const std::vector<double>& at_cleaned) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> at_joined(input.joined.positions.size(), kUnknown);
  for (Index f = 0; f < input.cleaned.faces.size(); ++f) {
    const auto& corners = input.joined.faces[input.joined_faces[f]];
    for (const Index v : input.cleaned.faces[f]) {
      // The face may have been turned over.
      for (const Index w : corners) {
        if (input.joined.positions[w] == input.cleaned.positions[v]) at_joined[w] = at_cleaned[v];
      }
    }
  }
  std::vector<double> at_welded;
  for (const Index w : input.joining.vertex) at_welded.push_back(at_joined[w]);
  return at_welded;
}

void forget_beyond(double radius, std::vector<double>& distances) {
  for (double& d : distances) {
    if (!std::isfinite(d) || d > radius) d = kNaN;
  }
}

std::vector<double> node_distances(const TriangleMesh& mesh, const NodeSurface& surface,
                                   const DistanceSource& source, DistanceMethod method,
                                   double radius) {
  const NodeMesh& nodes = surface.nodes;
  NodePoint start;
  if (source.vertex != kNone) {
    // The mesh's vertices are nodes with the same numbers.
    start.face = nodes.node_faces[nodes.node_offsets[source.vertex]];
    int k = 0;
    while (nodes.faces[start.face][k] != source.vertex) ++k;
    start.barycentric = Vec3::Unit(k);
  } else {
    start = surface.overlay.locate(source.point);
    if (start.face == kNone) {
      throw FaceError<NumericError>(source.point.face, "it has no area to measure from");
    }
  }
  const auto backend = make_backend(method, mesh, nodes);
  // A node of the source's face is up to an edge farther away than the source itself.
  const double longest = nodes.longest_edge();
  double reach = std::min(radius + longest, longest_path(nodes));
  const bool heat = method == DistanceMethod::heat || method == DistanceMethod::cloud;
  if (heat && reach < radius) {
    // The heat method takes its time step from the reach, so that a bound far off would spoil it.
    const auto march = node_distances(mesh, surface, source, DistanceMethod::unfold, radius);
    reach = longest;
    for (const double d : march) reach = std::isnan(d) ? reach : std::max(reach, d + longest);
  }
  const Patch patch = grow_patch(nodes, {start.face}, reach + backend->margin(reach, longest));
  DistanceTable table;
  backend->fill(patch, {std::min(radius, reach), reach}, table);
  const std::vector<double> local = distances_from(patch, table, 0, start.barycentric);
  std::vector<double> distances(nodes.nodes.size(), kNaN);
  for (std::size_t i = 0; i < local.size(); ++i) {
    if (std::isfinite(local[i])) distances[patch.nodes[i]] = local[i];
  }
  return distances;
}

double distance_at(const NodeMesh& nodes, const NodePoint& place,
                   const std::vector<double>& at_nodes) {
  const auto& corners = nodes.faces[place.face];
  const Vec3& b = place.barycentric;
  double squared = -barycentric_variance(nodes.lengths[place.face], b);
  for (int k = 0; k < 3; ++k) {
    if (b[k] != 0) squared += b[k] * at_nodes[corners[k]] * at_nodes[corners[k]];
  }
  return std::isnan(squared) ? kNaN : std::sqrt(std::max(squared, 0.0));
}

std::vector<Image> distance_texture(const TexelMap& map, const NodeSurface& surface,
                                    const std::vector<double>& at_nodes, double radius) {
  DistanceTexture texture(map);
  const Samples samples = texel_samples(map, surface);
  for (Index f = 0; f < surface.nodes.faces.size(); ++f) {
    for (Index s = samples.face_offsets[f]; s < samples.face_offsets[f + 1]; ++s) {
      const Sample& sample = samples.samples[s];
      const Vec3 b(1.0 - sample.b1 - sample.b2, sample.b1, sample.b2);
      const double d = distance_at(surface.nodes, {f, b}, at_nodes);
      if (d <= radius) texture.take_least(sample.texel, d);
    }
  }
  return texture.finish();
}

std::vector<Image> exact_distance_texture(const TriangleMesh& mesh, const TexelMap& map,
                                          const DistanceSource& source, double radius) {
  DistanceTexture texture(map);
  std::vector<SurfacePoint> points;
  std::vector<Index> texels;
  points.reserve(map.claims.size());
  texels.reserve(map.claims.size());
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    for (Index c = map.face_offsets[f]; c < map.face_offsets[f + 1]; ++c) {
      points.push_back({f, map.barycentric(f, map.claims[c])});
      texels.push_back(map.tile_of(f).texel(map.claims[c]));
    }
  }
  const std::vector<double> distances =
      NearbyGeodesics(mesh, radius).distances(source.point, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!std::isnan(distances[i])) texture.take_least(texels[i], distances[i]);
  }
  return texture.finish();
}

}  // namespace onmesh::tools
