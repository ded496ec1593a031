// The samples around each target, for what is no sum: percentiles, medians.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "onmesh/kernel/kernel_input.h"

namespace onmesh {

/// Finds them patch by patch, keeping its buffers. One object per thread.
class NearSamples {
 public:
  /// Called with a target and the texels of the samples near it, without its own.
  using Visit = std::function<void(const Sample& target, std::span<const Index> texels)>;
  /// How far samples of a target may be, in mesh units.
  using RadiusOf = std::function<double(const Sample& target)>;

  /// Visit the targets of the patch's core faces that have a radius above 0.
  /// \param input colours do not matter
  /// \param largest no radius is larger
  /// \param slack factor of radii, for rounding
  void run(const KernelInput& input, double largest, const RadiusOf& radius_of, double slack,
           const Visit& visit);

 private:
  struct Face {
    std::array<Index, 3> corners;
    std::size_t begin, end;  ///< of the samples
  };

  void gather(const KernelInput& input);
  void find_faces(const KernelInput& input, Index core_face, double largest);
  void find_samples(const DistanceTable& table, const std::array<Index, 3>& corners,
                    const Sample& target, double variance, double radius);

  // Of all samples of the patch, by faces.
  std::vector<Face> faces_;
  std::vector<float> b1_, b2_, variance_;
  std::vector<Index> texels_;
  std::vector<float> longest_;  ///< per face: its longest edge

  std::vector<Index> near_;      ///< faces around the targets' face
  std::vector<float> distance_;  ///< of a face's samples, squared
  std::vector<Index> found_;
};

}  // namespace onmesh
