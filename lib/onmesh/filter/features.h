// What range weights compare, made ready for the sums.
#pragma once

#include <vector>

#include "onmesh/distance/backend.h"
#include "onmesh/filter/draw_samples.h"
#include "onmesh/filter/near_texels.h"
#include "onmesh/filter/report.h"
#include "onmesh/filter/setup.h"
#include "onmesh/filter/working_values.h"

namespace onmesh {

/// What passes over the surface need.
struct SurfaceWork {
  const TriangleMesh& mesh;         ///< as given
  const SurfaceTextures& textures;  ///< the same
  const FilterSetup& setup;
  const FilterOptions& options;
  const NodeMesh& nodes;
  const DistanceBackend& backend;
  const FilterSamples& samples;
  const FaceNeighbours* neighbours;  ///< null: nothing asks, or samples are no texels

  NearWork near() const { return {nodes, backend, samples.sources, samples.targets(), neighbours}; }
};

/// The features of a run: in range space, smoothed, and scaled so that one width serves all.
class Features {
 public:
  /// Make them from the values as they are now.
  /// \pre all outlive this
  /// \param report receives noise, widths and warnings
  Features(const SurfaceWork& work, WorkingValues& working, FilterReport& report);

  /// Make those of own values again, after WorkingValues::take_results().
  void renew();

  /// Standard deviation of the weight by the features' differences; 0 without range weights.
  double width() const { return width_; }

 private:
  /// \param again only those of own values
  void smooth(bool again);
  /// Smooth a slot's features, given as they are before that, elsewhere than in the slot.
  void smooth(const FeatureSlot& slot, const Colours& features);
  void smooth_in_place(const FeatureSlot& slot);
  void scale(bool again);
  double width_of(const FeatureSlot& slot, FilterReport& report);

  const SurfaceWork work_;
  WorkingValues& working_;
  /// Of own values.
  struct Noise {
    RangeWidth::Unit unit;
    int first_channel, channels;
    double value;
  };
  std::vector<Noise> known_noise_;
  std::vector<double> widths_;  ///< per slot
  double width_ = 0;
};

}  // namespace onmesh
