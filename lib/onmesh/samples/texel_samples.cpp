#include <oneapi/tbb/parallel_for.h>

#include "onmesh/samples/piece_finder.h"
#include "onmesh/samples/run_sampler.h"
#include "onmesh/samples/samples.h"

namespace onmesh {

Samples texel_samples(const TexelMap& map, const NodeSurface& surface) {
  const Overlay& overlay = surface.overlay;
  const auto faces = static_cast<Index>(map.face_offsets.size() - 1);
  LargeArray<Index> piece_of(map.claims.size());
  std::vector<Index> counts(overlay.pieces.size(), 0);
  oneapi::tbb::parallel_for(
      Index{0}, faces, [&](Index f) { PieceFinder(map, overlay, f, piece_of.data()).run(counts); });
  Samples out;
  SamplePlaces places(overlay, counts, static_cast<Index>(surface.nodes.faces.size()),
                      out.face_offsets);
  out.samples.resize(map.claims.size());
  oneapi::tbb::parallel_for(Index{0}, faces, [&](Index f) {
    RunSampler(map, overlay, f).run(piece_of, places, out.samples.data());
  });
  return out;
}

}  // namespace onmesh
