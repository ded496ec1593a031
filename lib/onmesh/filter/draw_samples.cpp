#include "onmesh/filter/draw_samples.h"

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

Colours gather_colours(const Image& texture, bool bilateral, std::vector<float>& packed) {
  const std::vector<int> channels = texture.range_channels();
  const auto count = static_cast<int>(channels.size());
  if (channels.back() == count - 1) {
    return {texture.pixels.data(), count, bilateral ? count : 0, texture.channels, texture.width};
  }
  const auto texels = std::size_t(texture.width) * std::size_t(texture.height);
  packed.reserve(texels * channels.size());
  for (std::size_t t = 0; t < texels; ++t) {
    for (const int c : channels) packed.push_back(texture.texel(Index(t))[c]);
  }
  return {packed.data(), count, bilateral ? count : 0, count, texture.width};
}

}  // namespace onmesh
