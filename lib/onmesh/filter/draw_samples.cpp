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

Colours gather_colours(const SurfaceTextures& textures, bool bilateral,
                       std::vector<float>& packed) {
  const Image& first = *textures.tiles[0].image;
  const std::vector<int> channels = first.range_channels();
  const auto count = static_cast<int>(channels.size());
  if (textures.tiles.size() == 1 && channels.back() == count - 1) {
    return {first.pixels.data(), count, bilateral ? count : 0, first.channels, first.width};
  }
  packed.reserve(std::size_t(textures.values().size()) * channels.size());
  for (const TextureTile& tile : textures.tiles) {
    const auto texels = Index(tile.image->width) * Index(tile.image->height);
    for (Index t = 0; t < texels; ++t) {
      for (const int c : channels) packed.push_back(tile.image->texel(t)[c]);
    }
  }
  return {packed.data(), count, bilateral ? count : 0, count, first.width};
}

}  // namespace onmesh
