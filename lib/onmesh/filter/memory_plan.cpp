#include "onmesh/filter/memory_plan.h"

#include <tbb/info.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "onmesh/base/error.h"
#include "onmesh/base/process_memory.h"
#include "onmesh/filter/working_values.h"

namespace onmesh {
namespace {

/// What places a texel among the nodes.
constexpr double kBytesPerTexel = 18;
constexpr double kBytesPerSample = 16;
/// What their sampler needs for each of them.
constexpr double kBytesPerPoissonSample = 190;
/// With its two faces, what refinement needs at most.
constexpr double kBytesPerNode = 900;
/// Tables and records; rarely so much, more only beside needles.
constexpr double kBytesPerThread = 45e6;

int thread_count(const FilterOptions& options) {
  return options.threads > 0 ? options.threads : tbb::info::default_concurrency();
}

/// What is looked up of masks; of another size they have a texel map of their own meanwhile.
double memory_of_masks(const SurfaceTextures& textures) {
  const double texels = double(textures.values().size());
  bool has_mask = false, has_sample_mask = false;
  double bytes = 0;
  for (const TextureTile& tile : textures.tiles) {
    has_mask |= tile.mask != nullptr;
    has_sample_mask |= tile.sample_mask != nullptr;
    for (const Image* const mask : {tile.mask, tile.sample_mask}) {
      if (mask == nullptr) continue;
      if (mask->width == tile.image->width && mask->height == tile.image->height) continue;
      bytes += (sizeof(TexelClaim) + 5.0) * mask->width * mask->height;
    }
  }
  // A mask of results may make weights of its own.
  return bytes + sizeof(float) * texels * (has_mask ? 2 : 0) +
         sizeof(float) * texels * (has_sample_mask ? 2 : 0);
}

/// What features take meanwhile, of the guide that takes most: another guide's texels with a map
/// and places of their own, neighbours of texels, a copy of what is smoothed.
double memory_of_guides(const SurfaceTextures& textures, const FilterOptions& options) {
  constexpr double kBytesPerPlace = 12, kBytesPerClaimedTexel = sizeof(TexelClaim) + 9.0;
  const double texels = double(textures.values().size());
  double most = 0;
  bool has_median = options.despike > 0;
  for (const Guide& guide : options.guides) {
    has_median |= guide.median.has_value();
    double channels = textures.values().channels(), bytes = 0;
    if (!guide.textures.tiles.empty()) {
      const double own = double(guide.textures.values().size());
      channels = guide.textures.values().channels();
      const bool is_normal = guide.meaning != Guide::Meaning::values;
      bytes = own * (kBytesPerClaimedTexel + kBytesPerPlace +
                     sizeof(float) * (2 * channels + (is_normal ? 3 : 0)));
    }
    if (guide.is_smoothed()) bytes += sizeof(float) * channels * texels;
    most = std::max(most, bytes + kBytesPerPlace * texels);
  }
  return most + (has_median ? (kBytesPerPlace + 1) * texels : 0);
}

void require(std::uint64_t bytes, std::uint64_t limit, const std::string& what) {
  if (bytes <= limit) return;
  throw InputError("would take about " + memory_text(bytes) + " of memory" + what + ", and " +
                   memory_text(limit) +
                   " may be used; choose a larger node spacing or a smaller texture, or allow more "
                   "with max_memory=bytes");
}

}  // namespace

std::uint64_t memory_limit(const FilterOptions& options) {
  if (options.max_memory > 0) return options.max_memory;
  return resident_memory_bytes() + available_memory_bytes();
}

std::uint64_t whole_number(double estimate) {
  constexpr double kMost = 1e18;
  return static_cast<std::uint64_t>(estimate < kMost ? estimate : kMost);
}

std::uint64_t expected_memory(const SurfaceTextures& textures, const FilterPlan& plan,
                              const FilterOptions& options) {
  const ConstTexelValues texels = textures.values();
  // The results and, if they are others than the codes, what is summed.
  const double values = double(texels.size()) * texels.channels() * sizeof(float) +
                        WorkingValues::memory(textures, options);
  // Weighed samples are others than targets.
  const double masks = memory_of_masks(textures);
  const bool weighed = texels.alpha_channel() >= 0 || masks > 0;
  const double per_sample =
      (options.samples == SampleKind::poisson ? kBytesPerPoissonSample : kBytesPerSample) +
      (weighed ? kBytesPerSample : 0);
  return whole_number(double(resident_memory_bytes()) + values + masks +
                      memory_of_guides(textures, options) + kBytesPerTexel * double(plan.texels) +
                      per_sample * double(plan.samples) + kBytesPerNode * double(plan.nodes) +
                      kBytesPerThread * thread_count(options));
}

void require_memory_for_texels(const TriangleMesh& mesh, const SurfaceTextures& textures,
                               const std::vector<Index>& tiles, const FilterOptions& options) {
  constexpr double kBytesPerClaim = sizeof(TexelClaim);
  double texels = 0;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (!mesh.has_uvs(f) || tiles[f] == kNone) continue;
    const TextureTile& tile = textures.tiles[tiles[f]];
    // What is clamped has no more than the image.
    const double area = repeated_area(mesh.corner_uvs(f), mesh.wrap_of(f, tile.wrap)) *
                        tile.image->width * tile.image->height;
    if (std::isfinite(area)) texels += area;
  }
  const double bytes = (kBytesPerClaim + kBytesPerTexel + kBytesPerSample) * texels;
  require(whole_number(bytes), memory_limit(options),
          " for " + std::to_string(whole_number(texels)) + " texels on the surface");
}

void require_memory_to_fill(const SurfaceTextures& textures, std::uint64_t missing,
                            const FilterOptions& options) {
  // Up to 8 links and a row for each texel, vectors of four values, and a third of it again for
  // the coarser levels; places and rows of all texels.
  constexpr double kBytesPerMissing = 400, kBytesPerTexelFilled = 16;
  const ConstTexelValues texels = textures.values();
  const double bytes = double(resident_memory_bytes()) + kBytesPerMissing * double(missing) +
                       kBytesPerTexelFilled * double(texels.size());
  require(whole_number(bytes), memory_limit(options),
          " to fill " + std::to_string(missing) + " texels");
}

void require_memory(const FilterPlan& plan) { require(plan.memory_bytes, plan.memory_limit, ""); }

}  // namespace onmesh
