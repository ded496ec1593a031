#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <utility>

#include "onmesh/atlas/claim_lookup.h"
#include "onmesh/base/face_error.h"
#include "onmesh/nodes/overlay_lookup.h"
#include "onmesh/samples/make_sample.h"

namespace onmesh {
namespace {

// Sort located samples into node faces, keeping their order within a face: a counting sort of
// chunks, whose number does not show in the result.
Samples sort_into_faces(std::vector<Sample> located, const std::vector<Index>& face_of,
                        Index node_faces) {
  constexpr std::size_t kLeastChunk = 1 << 18;
  const std::size_t size = located.size();
  const std::size_t chunks = std::clamp<std::size_t>(
      size / kLeastChunk, 1,
      std::size_t(std::min(8, oneapi::tbb::this_task_arena::max_concurrency())));
  const auto first = [&](std::size_t chunk) { return size * chunk / chunks; };
  // Per chunk and face: how many there are, then where the next one goes.
  std::vector<std::vector<Index>> places(chunks);
  oneapi::tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t c) {
    places[c].assign(node_faces, 0);
    for (std::size_t i = first(c); i < first(c + 1); ++i) ++places[c][face_of[i]];
  });
  Samples out;
  out.face_offsets.resize(node_faces + 1);
  Index next = 0;
  for (Index f = 0; f < node_faces; ++f) {
    out.face_offsets[f] = next;
    for (auto& place : places) next += std::exchange(place[f], next);
  }
  out.face_offsets[node_faces] = next;
  out.samples.resize(size);
  oneapi::tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t c) {
    for (std::size_t i = first(c); i < first(c + 1); ++i)
      out.samples[places[c][face_of[i]]++] = located[i];
  });
  return out;
}

NodePoint locate(const OverlayLookup& overlay, const SurfacePoint& point) {
  NodePoint at = overlay.locate(point);
  if (at.face == kNone) {
    throw FaceError<NumericError>(point.face, "it is too thin to be laid out between the nodes");
  }
  return at;
}

}  // namespace

Samples point_samples(const TriangleMesh& mesh, const TexelMap& map, const NodeSurface& surface,
                      const std::vector<SurfacePoint>& points, double area) {
  const OverlayLookup overlay(surface.overlay);
  std::vector<Sample> located(points.size());
  std::vector<Index> face_of(points.size());
  oneapi::tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
    const NodePoint at = locate(overlay, points[i]);
    face_of[i] = at.face;
    located[i] =
        make_sample(map.tile_of(points[i].face).texel_at(mesh.uv(points[i])), at.barycentric, area);
  });
  return sort_into_faces(std::move(located), face_of,
                         static_cast<Index>(surface.nodes.faces.size()));
}

Samples sharing_samples(const TriangleMesh& mesh, const TexelMap& map, const NodeSurface& surface,
                        const std::vector<SurfacePoint>& points) {
  const ClaimLookup lookup(map);
  std::vector<Index> claim_of(points.size());
  oneapi::tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
    const Index face = points[i].face;
    claim_of[i] = map.chart_of_face[face] == kNone ? kNone : lookup.find(face, mesh.uv(points[i]));
  });
  std::vector<Index> sharers(map.claims.size(), 0);
  std::vector<SurfacePoint> kept;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (claim_of[i] == kNone) continue;
    ++sharers[claim_of[i]];
    claim_of[kept.size()] = claim_of[i];
    kept.push_back(points[i]);
  }
  // Claims that another one leads give their area to it.
  std::vector<double> areas(map.claims.size(), 0.0);
  for (Index claim = 0; claim < areas.size(); ++claim)
    areas[lookup.leader(claim)] += map.texel_area[lookup.face_of(claim)];

  const OverlayLookup overlay(surface.overlay);
  std::vector<Sample> located(kept.size());
  std::vector<Index> face_of(kept.size());
  oneapi::tbb::parallel_for(std::size_t{0}, kept.size(), [&](std::size_t i) {
    const Index claim = claim_of[i];
    const NodePoint at = locate(overlay, kept[i]);
    face_of[i] = at.face;
    located[i] = make_sample(map.tile_of(lookup.face_of(claim)).texel(map.claims[claim]),
                             at.barycentric, areas[claim] / sharers[claim]);
  });
  return sort_into_faces(std::move(located), face_of,
                         static_cast<Index>(surface.nodes.faces.size()));
}

}  // namespace onmesh
