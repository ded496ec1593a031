// The whole filter: mesh and texture in, filtered texture out.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "onmesh/distance.h"
#include "onmesh/image.h"
#include "onmesh/length.h"
#include "onmesh/progress.h"
#include "onmesh/texel_map.h"

namespace onmesh {

enum class FilterKind { bilateral, gaussian };
enum class SampleKind { texel, poisson };
enum class Overlap { average, first, error };

struct FilterOptions {
  FilterKind kind = FilterKind::bilateral;
  Length sigma_spatial{4, Length::Unit::texel};  ///< > 0
  double sigma_range = 0.1;                      ///< value units, > 0; bilateral only
  std::optional<Length> radius;        ///< default 2.5 sigma (bilateral), 3 sigma (Gaussian)
  DistanceMethod distance = DistanceMethod::automatic;
  SampleKind samples = SampleKind::texel;
  std::optional<Length> spacing;       ///< Poisson spacing; default: every texel is hit
  std::optional<double> r_coef;        ///< Poisson spacing in mean edge lengths, > 0
  std::optional<Length> node_spacing;  ///< default: the spacing rule
  std::uint64_t seed = 1;
  int threads = 0;                     ///< 0 = all
  int gutter = 2;                      ///< rings of 8-neighbours, >= 0
  Overlap overlap = Overlap::average;
  Wrap wrap = Wrap::repeat;
  std::vector<bool> faces;             ///< faces that carry the texture (as given); empty = all with UVs
};

struct StageTime {
  std::string stage;
  double seconds = 0;
};

struct FilterReport {
  std::string backend, backend_reason;
  double sigma_spatial = 0, radius = 0, node_spacing = 0, sample_spacing = 0, texel_size = 0;  ///< mesh units
  std::uint64_t texels = 0, samples = 0, nodes = 0, node_faces = 0, patches = 0, pairs = 0;
  std::uint64_t overlapped = 0, gutter = 0, without_sample = 0;
  std::vector<StageTime> stages;
  std::vector<std::string> warnings;
};

/// Filter `texture` on the surface of `mesh` (DESIGN: definition of the filter in README).
/// Same input and options give identical values for any thread count.
/// \pre mesh is as read; it is welded and cleaned here
/// \throw InputError if no face carries a texel, the mesh is not manifold, or (Overlap::error) a texel
///   is claimed twice; UsageError for options outside their domain
Image filter(const TriangleMesh& mesh, const Image& texture, const FilterOptions& options,
             FilterReport* report = nullptr, const Progress& progress = {});

}  // namespace onmesh
