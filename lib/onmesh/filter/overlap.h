// Texels that several places of the surface claim, and the mean of their results: all that depends
// on the policy of `Overlap`.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "onmesh/atlas/texel_map.h"
#include "onmesh/filter/options.h"
#include "onmesh/filter/surface_textures.h"
#include "onmesh/samples/samples.h"

namespace onmesh {

/// What becomes of overlapped texels: which claims are filtered, and what the user is told.
class OverlapPolicy {
 public:
  /// No texel is claimed more than once.
  OverlapPolicy() = default;
  /// \throw InputError with Overlap::error if a texel is claimed more than once
  OverlapPolicy(Overlap overlap, const TexelMap& map, const SurfaceTextures& textures);

  /// Texels claimed more than once, ascending.
  const std::vector<Index>& texels() const { return texels_; }
  /// What to tell the user; empty if there are none.
  std::string warning() const;

  /// Whether only the first claim of every texel is filtered (Overlap::first).
  bool first_only() const { return overlap_ == Overlap::first && !texels_.empty(); }
  /// Whether texels get the mean of several results (Overlap::average).
  bool shares() const { return overlap_ == Overlap::average && !texels_.empty(); }

 private:
  std::string description() const;

  Overlap overlap_ = Overlap::average;
  std::vector<Index> texels_;
  std::string first_;  ///< where the first of them is
};

/// \return the map with only the first claim of every texel (the lowest face's)
TexelMap first_claims(const TexelMap& map);

/// Keeps the results of targets whose texels have several until all are there. Targets that are
/// different may be kept from different threads at once.
class SharedResults {
 public:
  /// \param targets every claim of the map, or the first ones, as OverlapPolicy has it
  SharedResults(const OverlapPolicy& policy, const Samples& targets, std::size_t channels);

  /// The targets concerned, ascending.
  const std::vector<Index>& targets() const { return shared_; }
  /// \param position in targets()
  /// \param values one per channel
  void keep(std::size_t position, const float* values);

  /// Once all are kept: call write(texel, values) for every texel with the mean of its results,
  /// weighted by their areas.
  void merge(const std::function<void(Index texel, const float* values)>& write) const;

 private:
  const Samples& targets_;
  std::size_t channels_;
  std::vector<Index> shared_;
  std::vector<float> values_;
};

}  // namespace onmesh
