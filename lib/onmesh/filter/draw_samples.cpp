#include "onmesh/filter/draw_samples.h"

#include <algorithm>

#include "onmesh/poisson/poisson.h"

namespace onmesh {
namespace {

Samples draw_poisson(const FilterSetup& setup, const NodeSurface& surface, std::uint64_t seed,
                     const Progress& progress) {
  PoissonOptions options;
  options.seed = seed;
  options.faces.resize(setup.mesh.faces.size());
  double area = 0;
  for (Index f = 0; f < options.faces.size(); ++f) {
    options.faces[f] = setup.map.texel_area[f] > 0;
    if (options.faces[f]) area += setup.mesh.face_area(f);
  }
  if (setup.graded) {
    const auto samples = texel_poisson_samples(setup.mesh, setup.map, options, progress);
    return sharing_samples(setup.mesh, setup.map, surface, samples.points);
  }
  options.spacing = setup.lengths.sample_spacing;
  const std::vector<SurfacePoint> points = poisson_samples(setup.mesh, options, progress);
  return point_samples(setup.mesh, setup.map, surface, points, area / double(points.size()));
}

}  // namespace

FilterSamples draw_samples(const FilterSetup& setup, const NodeSurface& surface,
                           const FilterOptions& options, const Progress& progress) {
  const bool poisson = options.samples == SampleKind::poisson;
  FilterSamples samples;
  samples.sources = poisson ? draw_poisson(setup, surface, options.seed, progress)
                            : texel_samples(setup.map, surface);
  samples.targets_are_own = poisson || setup.overlap.first_only();
  if (setup.overlap.first_only()) {
    samples.own_targets = texel_samples(first_claims(setup.map), surface);
  } else if (poisson) {
    samples.own_targets = texel_samples(setup.map, surface);
  }
  return samples;
}

float SampleWeights::of(Index texel) const {
  const float weight = of_mask.empty() ? 1 : of_mask[texel];
  if (!by_alpha || codes.alpha_channel() < 0) return weight;
  const float alpha = codes[texel][codes.alpha_channel()];
  return alpha > 0 ? weight * std::min(alpha, 1.F) : 0;  // not a number counts for nothing
}

void weigh_samples(const SampleWeights& weights, FilterSamples& samples) {
  if (weights.are_one()) return;
  const auto& all = samples.sources.samples;
  if (std::all_of(all.begin(), all.end(),
                  [&](const Sample& s) { return weights.of(s.texel) == 1; }))
    return;
  if (!samples.targets_are_own) {
    samples.own_targets = samples.sources;
    samples.targets_are_own = true;
  }
  for (Sample& s : samples.sources.samples) s.area *= weights.of(s.texel);
}

}  // namespace onmesh
