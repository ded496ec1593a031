// The whole filter: mesh and texture in, filtered texture out.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "onmesh/atlas/texel_map.h"
#include "onmesh/base/progress.h"
#include "onmesh/distance/backend.h"
#include "onmesh/filter/length.h"
#include "onmesh/image/image.h"

namespace onmesh {

enum class FilterKind { bilateral, gaussian };
enum class SampleKind { texel, poisson };
/// How the sums are evaluated: sample by sample, or on the nodes (node_kernel.h), or on the nodes
/// wherever that is faster and within the tolerance.
enum class FilterMethod { automatic, direct, nodes };
enum class Overlap { average, first, error };

struct FilterOptions {
  FilterKind kind = FilterKind::bilateral;
  Length sigma_spatial{4, Length::Unit::texel};  ///< > 0
  double sigma_range = 0.1;                      ///< value units, > 0; bilateral only
  std::optional<Length> radius;  ///< default 2.5 sigma (bilateral), 3 sigma (Gaussian)
  DistanceMethod distance = DistanceMethod::automatic;
  FilterMethod method = FilterMethod::automatic;
  /// Most RMS difference to the direct sum where the nodes are used, as a share of the texture's
  /// range of values, > 0.
  double tolerance = 1.0 / 512;
  SampleKind samples = SampleKind::texel;
  std::optional<Length> spacing;       ///< Poisson spacing; default: by texel, all are hit
  std::optional<double> r_coef;        ///< Poisson spacing in mean edge lengths, > 0
  std::optional<Length> node_spacing;  ///< default: the spacing rule
  std::optional<Length> bridge;        ///< > 0: join components across smaller gaps (bridge.h)
  std::uint64_t seed = 1;              ///< of the Poisson samples
  int threads = 0;                     ///< 0 = all
  int gutter = 2;                      ///< rings of 8-neighbours, >= 0
  Overlap overlap = Overlap::average;
  Wrap wrap = Wrap::repeat;
  std::vector<bool> faces;  ///< faces that carry the texture (as given); empty = all with UVs
};

/// What a run will do, as far as it is known without running. Lengths in mesh units.
struct FilterPlan {
  double sigma_spatial = 0, radius = 0;
  double node_spacing = 0, curved_spacing = 0, finest_spacing = 0;
  /// Poisson mode only: the least and the largest, which differ where they follow the texels.
  double sample_spacing = 0, largest_sample_spacing = 0;
  double texel_size = 0, diagonal = 0, surface_area = 0;
  double bridge = 0;             ///< 0 = none
  std::uint64_t texels = 0;      ///< targets, each claim of a texel counted
  std::uint64_t overlapped = 0;  ///< texels claimed more than once
  std::uint64_t nodes = 0, samples = 0, memory_bytes = 0;  ///< estimates
  std::vector<std::string> warnings;
};

struct StageTime {
  std::string stage;
  double seconds = 0;
  std::uint64_t peak_memory_bytes = 0;  ///< of the process, up to the stage's end
};

struct FilterReport {
  std::string backend, backend_reason, instruction_set;
  std::string refinement;  ///< "intrinsic", or "bisection" where parts are bridged
  /// Mesh units; sample spacings in Poisson mode only.
  double sigma_spatial = 0, radius = 0, node_spacing = 0, texel_size = 0;
  double sample_spacing = 0, largest_sample_spacing = 0;
  std::uint64_t texels = 0, samples = 0, nodes = 0, node_faces = 0, patches = 0;
  std::uint64_t pairs = 0;  ///< (target, sample) pairs summed one by one
  /// Samples within the radius of a target, mean; estimated from some targets where the nodes are
  /// used.
  double taps = 0;
  std::uint64_t table_rows = 0;      ///< nodes that distances were computed from, all patches
  std::uint64_t bridges = 0;         ///< over gaps between components
  std::uint64_t overlapped = 0;      ///< texels claimed more than once
  std::uint64_t gutter = 0;          ///< texels filled around the charts
  std::uint64_t without_sample = 0;  ///< targets that kept their values
  /// "direct", "nodes" or "nodes and direct", and what the check of the nodes found.
  std::string method;
  std::uint64_t by_nodes = 0;           ///< targets evaluated on nodes
  std::uint64_t checked = 0;            ///< values among theirs that were compared with direct sums
  int palette = 0;                      ///< most colours of a patch's palette (bilateral)
  double rms_error = 0, max_error = 0;  ///< of the values compared, value units
  double table_cpu_seconds = 0, kernel_cpu_seconds = 0;  ///< summed over threads
  std::vector<StageTime> stages;
  std::vector<std::string> warnings;
};

/// Filter `texture` on the surface of `mesh` (DESIGN: definition of the filter in README).
/// Same input and options give identical values for any thread count.
/// Any triangles will do: edges with many faces, bow ties and one-sided parts are filtered across;
/// components do not influence each other unless they are bridged.
/// \pre mesh is as read; it is welded and cleaned here
/// \throw InputError if no face carries a texel, exact distances are asked for on a mesh that is
/// not
///   manifold or would take more than an hour, or (Overlap::error) a texel is claimed twice
/// \throw UsageError for options outside their domain or ignored by the mode chosen
Image filter(const TriangleMesh& mesh, const Image& texture, const FilterOptions& options,
             FilterReport* report = nullptr, const Progress& progress = {});

/// Check everything that filter() checks before its work starts, and tell what it would do.
/// \throw as filter()
FilterPlan plan_filter(const TriangleMesh& mesh, const Image& texture,
                       const FilterOptions& options);

}  // namespace onmesh
