// Results with the mean of what was summed.
#pragma once

#include <vector>

#include "onmesh/filter/results.h"
#include "onmesh/filter/working_values.h"
#include "onmesh/samples/samples.h"

namespace onmesh {

/// Means over the surface, weighted as samples are: of the luminance of colours, of all channels of
/// data. What is compared by its own noise is pulled towards what is frequent, and noisy light is
/// mostly dark: its mean gets lost.
class SurfaceMeans {
 public:
  /// Of the values as they are now.
  /// \pre both outlive this
  SurfaceMeans(const WorkingValues& working, const Samples& samples);

  /// Scale each map's results so that they have these means, within the range that they may have.
  void give_to(const TexelValues& results, const ValueRange& range) const;

 private:
  /// \param values_of the straight colours of a texel
  template <class ValuesOf>
  std::vector<double> means(const ValuesOf& values_of) const;

  const WorkingValues& working_;
  const Samples& samples_;
  std::vector<double> means_;  ///< per map
};

}  // namespace onmesh
