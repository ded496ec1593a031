// What the filter tells: before it runs (plan) and afterwards (report).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace onmesh {

/// What a run will do, as far as it is known without running. Lengths in mesh units.
struct FilterPlan {
  double sigma_spatial = 0, radius = 0;
  /// Distance between nodes where the surface is flat, where it is curved and where distances bend.
  double node_spacing = 0, curved_spacing = 0, finest_spacing = 0;
  /// Poisson samples only: the least and the largest, which differ where they follow the texels.
  double sample_spacing = 0, largest_sample_spacing = 0;
  double texel_size = 0;    ///< median: what lengths in "tx" are multiples of
  double diagonal = 0;      ///< of the bounding box: what lengths in "%" are shares of
  double bridge = 0;        ///< 0 = none
  double surface_area = 0;  ///< square mesh units, of all faces that are left once it is clean

  std::uint64_t texels = 0;      ///< targets, each claim of a texel counted
  std::uint64_t overlapped = 0;  ///< texels claimed more than once
  std::uint64_t nodes = 0, samples = 0, memory_bytes = 0;  ///< estimates
  /// What is odd about the mesh, a line each.
  std::vector<std::string> warnings;
};

struct StageTime {
  std::string stage;
  double seconds = 0;                   ///< wall clock
  std::uint64_t peak_memory_bytes = 0;  ///< of the process, up to the stage's end
};

/// What a run did.
struct FilterReport {
  std::string backend;          ///< where distances came from: "unfold", "heat", ...
  std::string backend_reason;   ///< why this one
  std::string instruction_set;  ///< of the kernel: "AVX2", ...
  std::string refinement;       ///< "intrinsic", or "bisection" where parts are bridged

  /// Mesh units, as in FilterPlan.
  double sigma_spatial = 0, radius = 0, node_spacing = 0, texel_size = 0;
  double sample_spacing = 0, largest_sample_spacing = 0;

  std::uint64_t texels = 0;  ///< targets, each claim of a texel that was filtered counted
  std::uint64_t samples = 0, nodes = 0, node_faces = 0, patches = 0;
  std::uint64_t pairs = 0;  ///< (target, sample) pairs summed one by one
  /// Samples within the radius of a target, mean; estimated from some targets where the nodes are
  /// used.
  double taps = 0;
  std::uint64_t table_rows = 0;      ///< nodes that distances were computed from, all patches
  std::uint64_t bridges = 0;         ///< over gaps between components
  std::uint64_t overlapped = 0;      ///< texels claimed more than once
  std::uint64_t gutter = 0;          ///< texels filled around the charts
  std::uint64_t without_sample = 0;  ///< targets that kept their values

  std::string method;                   ///< "direct", "nodes" or "nodes and direct"
  std::uint64_t by_nodes = 0;           ///< targets evaluated on nodes
  std::uint64_t checked = 0;            ///< values among theirs that were compared with direct sums
  double rms_error = 0, max_error = 0;  ///< of the values compared, value units
  int palette = 0;                      ///< most colours of a patch's palette (bilateral)

  double table_cpu_seconds = 0, kernel_cpu_seconds = 0;  ///< summed over threads
  std::vector<StageTime> stages;                         ///< in the order in which they ran
  std::vector<std::string> warnings;                     ///< a line each
};

}  // namespace onmesh
