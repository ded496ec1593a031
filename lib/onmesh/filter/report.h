// What the filter tells: before it runs (plan) and afterwards (report).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace onmesh {

/// What a run will do, as far as it is known without running. Lengths in mesh units.
struct FilterPlan {
  double sigma_spatial = 0;           ///< width of the filter
  double radius = 0;                  ///< how far samples count
  double node_spacing = 0;            ///< between nodes where the surface is flat
  double curved_spacing = 0;          ///< where it is curved
  double finest_spacing = 0;          ///< where distances bend
  double sample_spacing = 0;          ///< Poisson samples only: the least
  double largest_sample_spacing = 0;  ///< the same; differs where spacings follow the texels
  double texel_size = 0;              ///< median: what lengths in "tx" are multiples of
  double diagonal = 0;                ///< of the bounding box: what lengths in "%" are shares of
  double bridge = 0;                  ///< 0 = none
  double surface_area = 0;  ///< square mesh units, of all faces that are left once it is clean

  std::uint64_t joined_edges = 0;  ///< pairs of boundary edges that differ by rounding only
  std::uint64_t t_junctions = 0;   ///< boundary edges split at vertices on them
  std::uint64_t near_edges = 0;    ///< boundary edges within a texel of others, yet apart
  std::uint64_t texels = 0;        ///< targets, each claim of a texel counted
  std::uint64_t overlapped = 0;    ///< texels claimed more than once
  std::uint64_t nodes = 0;         ///< estimate
  std::uint64_t samples = 0;       ///< estimate
  std::uint64_t memory_bytes = 0;  ///< estimate of the largest resident set
  std::uint64_t memory_limit = 0;  ///< bytes that may be resident
  /// What is odd about the mesh, a line each.
  std::vector<std::string> warnings;
};

/// What a stage took.
struct StageTime {
  std::string stage;                    ///< its name, as Progress has it
  double seconds = 0;                   ///< wall clock
  std::uint64_t peak_memory_bytes = 0;  ///< of the process, up to the stage's end
};

/// What a run did.
struct FilterReport {
  std::string backend;          ///< where distances came from: "unfold", "heat", ...
  std::string backend_reason;   ///< why this one
  std::string instruction_set;  ///< of the kernel: "AVX2", ...
  std::string refinement;       ///< "intrinsic", or "bisection" with bridges or very thin faces

  double sigma_spatial = 0;           ///< mesh units, as in FilterPlan
  double radius = 0;                  ///< the same
  double node_spacing = 0;            ///< the same
  double texel_size = 0;              ///< the same
  double sample_spacing = 0;          ///< the same
  double largest_sample_spacing = 0;  ///< the same

  std::uint64_t texels = 0;      ///< targets, each claim of a texel that was filtered counted
  std::uint64_t samples = 0;     ///< what was summed over
  std::uint64_t nodes = 0;       ///< that distances were computed between
  std::uint64_t node_faces = 0;  ///< triangles between them
  std::uint64_t patches = 0;     ///< pieces of work
  std::uint64_t pairs = 0;       ///< (target, sample) pairs summed one by one
  /// Samples within the radius of a target, mean; estimated from some targets where the nodes are
  /// used.
  double taps = 0;
  std::uint64_t table_rows = 0;      ///< nodes that distances were computed from, all patches
  std::uint64_t bridges = 0;         ///< over gaps
  std::uint64_t joined_edges = 0;    ///< as in FilterPlan
  std::uint64_t t_junctions = 0;     ///< the same
  std::uint64_t near_edges = 0;      ///< the same
  std::uint64_t overlapped = 0;      ///< texels claimed more than once
  std::uint64_t gutter = 0;          ///< texels filled around the charts
  std::uint64_t without_sample = 0;  ///< targets that kept their values
  std::uint64_t missing = 0;         ///< texels on the surface without a value
  std::uint64_t left_out = 0;        ///< those of them that the mask of samples leaves out

  double range_width = 0;    ///< of the first range weight, in its features' unit; 0 = none
  double noise = 0;          ///< of own values in range space, where a width is a multiple of it
  std::uint64_t spikes = 0;  ///< texels that were taken down
  double mean_before = 0;    ///< over the surface, of luminance or data, before that was done
  double mean_after = 0;     ///< the same afterwards

  std::string method;          ///< "direct", "nodes" or "nodes and direct"
  std::uint64_t by_nodes = 0;  ///< targets evaluated on nodes
  std::uint64_t checked = 0;   ///< values among theirs that were compared with direct sums
  double rms_error = 0;        ///< of the values compared, value units
  double max_error = 0;        ///< the same
  int palette = 0;             ///< most colours of a patch's palette (bilateral)

  double table_cpu_seconds = 0;       ///< for distances, summed over threads
  double kernel_cpu_seconds = 0;      ///< for the sums, likewise
  std::vector<StageTime> stages;      ///< in the order in which they ran
  std::vector<std::string> warnings;  ///< a line each
};

}  // namespace onmesh
