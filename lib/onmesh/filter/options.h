// What the filter can be told.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "onmesh/atlas/overlap.h"
#include "onmesh/atlas/texel_map.h"
#include "onmesh/distance/backend.h"
#include "onmesh/filter/guide.h"
#include "onmesh/filter/length.h"
#include "onmesh/filter/range_width.h"

namespace onmesh {

enum class FilterKind {
  bilateral,  ///< weights by distance and by difference of colour: keeps edges
  gaussian,   ///< weights by distance alone: blurs
};

/// What the range weight compares.
enum class RangeSpace {
  code,    ///< codes as the file has them: sigma_range keeps its meaning
  linear,  ///< linear light
  log,     ///< log(1 + .72 light / its log-average) per channel: scaled light gives the same
  oklab,   ///< as colours look; three channels of Rec. 709 primaries
};

/// What is summed over.
enum class SampleKind {
  texel,    ///< every texel on the surface once, weighted by its area
  poisson,  ///< random points of the surface, none close to another
};

/// How the sums are evaluated.
enum class FilterMethod {
  automatic,  ///< on the nodes where that is faster and within the tolerance, else directly
  direct,     ///< sample by sample
  nodes,      ///< on the nodes (kernel/splat), at a cost that does not depend on sigma
};

/// Values outside the ranges below are refused with an OptionError that names the field.
struct FilterOptions {
  FilterKind kind = FilterKind::bilateral;  ///< with or without a range weight
  /// Width of the filter on the surface: standard deviation of the spatial weight; > 0.
  Length sigma_spatial{4, Length::Unit::texel};
  /// Bilateral only, without guides: standard deviation of the range weight, in the units of
  /// range_space; > 0.
  RangeWidth sigma_range = 0.1;
  RangeSpace range_space = RangeSpace::code;  ///< bilateral only: what sigma_range is in
  /// Bilateral only: what range weights compare; empty = own values with sigma_range.
  std::vector<Guide> guides;
  /// Values that stick out of those within three texels so many times are taken down to them before
  /// all else, see despike(); 0 = none, else [1, 1e6].
  double despike = 0;
  /// Colours that are spikes come down to the limit itself, rather than to the median around them:
  /// where light is noisy, that is nearer to what they would be on average.
  bool despike_to_limit = false;
  /// Results are scaled so that each map's mean over the surface is that of what was summed.
  bool keep_mean = false;
  /// How often the sums are done, each time of the last result; [1, 100].
  int iterations = 1;
  /// Range weights of all but the first of them compare the last result, where they compare what is
  /// filtered; else the input.
  bool guides_from_result = false;
  /// How far samples count; > 0. Default: 2.5 sigma_spatial (bilateral) or 3 (Gaussian).
  std::optional<Length> radius;

  /// How distances are computed; `automatic` = unfold.
  DistanceMethod distance = DistanceMethod::automatic;
  /// Components, and boundaries of one component that face each other, are joined across smaller
  /// gaps than this; > 0, not with exact distances. Default: none.
  std::optional<Length> bridge;
  /// Boundary edges that differ by no more than this are one, and edges are split at vertices no
  /// farther from them, see join_boundaries(); >= 0, not in texels. Default: two steps of the
  /// coordinates as they were stored; 0 = only what is equal bit by bit.
  std::optional<Length> weld;
  /// Between the nodes of the distance tables; > 0. Default: see node_spacing_for().
  std::optional<Length> node_spacing;

  /// How much of the result is taken: in + strength (filtered - in), in linear light; [0, 1].
  /// Texels without a value get the filtered one whatever this and the mask say.
  double strength = 1;
  /// How much of what was taken away is added again, in codes: out + detail_gain (in - out), within
  /// the codes that the file has; [-100, 100].
  double detail_gain = 0;
  /// Alpha is filtered like colours, with the same weights; else it stays.
  bool filter_alpha = false;

  FilterMethod method = FilterMethod::automatic;  ///< how the sums are done
  /// Where the nodes are used: most RMS difference to the direct sums of codes, as a share of the
  /// textures' robust range (without one in a thousand at either end); > 0.
  double tolerance = 1.0 / 512;

  SampleKind samples = SampleKind::texel;  ///< what is summed over
  /// Poisson only: least distance of samples; > 0. Default: by the size of the texels, so that each
  /// is hit.
  std::optional<Length> spacing;
  /// Poisson only: the same as a multiple of the mesh's mean edge length; > 0, excludes `spacing`.
  std::optional<double> r_coef;
  std::uint64_t seed = 1;  ///< of the Poisson samples, any

  /// One texture: how UVs outside [0,1] are read where materials do not say (Material::wrap).
  Wrap wrap = Wrap::repeat;
  Overlap overlap = Overlap::average;  ///< texels that several places of the surface claim
  /// Rings of texels filled around the charts, [0, 32768]; 0 = nothing is filled, not even texels
  /// that a chart merely touches.
  int gutter = 2;
  /// One texture, per face of the mesh as given: whether it carries it. Empty = all faces with UVs.
  std::vector<bool> faces;
  /// Colour does not flow from faces of one material to those of another.
  bool stop_at_materials = false;
  int threads = 0;  ///< >= 0; 0 = as many as there are processors
  /// Runs that would take more memory are refused, bytes; 0 = what there is and what is left.
  std::uint64_t max_memory = 0;
};

}  // namespace onmesh
