#include "onmesh/filter/setup.h"

#include <utility>

#include "onmesh/base/error.h"
#include "onmesh/base/text.h"
#include "onmesh/filter/check_options.h"
#include "onmesh/filter/memory_plan.h"
#include "onmesh/filter/node_spacing.h"
#include "onmesh/nodes/expected_nodes.h"
#include "onmesh/poisson/spacing_field.h"

namespace onmesh {
namespace {

/// So many nodes need some 45 GB.
constexpr double kMostNodes = 5e7;

/// In working units.
/// \throw OptionError if it is too small or too large beside the mesh for single precision
/// \throw InputError if it is in texels, and these are what is too large
double resolve_for(const PreparedMesh& prepared, const WorkingPlan& plan, const char* option,
                   const Length& length) {
  const double value = resolve(length, plan.texel_size, plan.diagonal);
  const double working = length.unit == Length::Unit::mesh ? value / prepared.unit : value;
  require_positive(option, value);
  constexpr double kLeast = 1e-12, kLargest = 1e12;  // working units
  if (working > kLargest && length.unit == Length::Unit::texel && plan.texel_size > plan.diagonal) {
    throw InputError("the UVs cover hardly anything of the texture: a texel is " +
                     number_text(plan.texel_size / plan.diagonal) + " times as wide as the mesh");
  }
  if (working < kLeast || working > kLargest) {
    throw OptionError(option, "is too " + std::string(working < kLeast ? "small" : "large") +
                                  " beside the mesh and its texels for single precision");
  }
  return working;
}

/// All lengths but those of the Poisson samples.
WorkingPlan plan_lengths(const PreparedMesh& prepared, const FilterOptions& options) {
  WorkingPlan plan;
  plan.texel_size = prepared.map.median_texel_size();
  plan.diagonal = prepared.mesh.diagonal();
  const auto resolved = [&](const char* option, const Length& length) {
    return resolve_for(prepared, plan, option, length);
  };
  plan.sigma_spatial = resolved("sigma_spatial", options.sigma_spatial);
  plan.radius = options.radius
                    ? resolved("radius", *options.radius)
                    : plan.sigma_spatial * (options.kind == FilterKind::bilateral ? 2.5 : 3.0);
  if (options.bridge) plan.bridge = resolved("bridge", *options.bridge);
  const bool depends_on_spacing = options.distance == DistanceMethod::heat ||
                                  options.distance == DistanceMethod::cloud || plan.bridge > 0 ||
                                  options.kind == FilterKind::gaussian;
  const NodeSpacing rule =
      node_spacing_for(plan.sigma_spatial, plan.radius, plan.texel_size, depends_on_spacing,
                       options.method == FilterMethod::nodes);
  plan.node_spacing =
      options.node_spacing ? resolved("node_spacing", *options.node_spacing) : rule.flat;
  plan.curved_spacing = options.node_spacing ? plan.node_spacing : rule.curved;
  plan.finest_spacing = options.node_spacing ? plan.node_spacing / 4 : rule.finest;
  for (Index f = 0; f < prepared.mesh.faces.size(); ++f) {
    plan.surface_area += prepared.mesh.face_area(f);
  }
  return plan;
}

/// The spacings of Poisson samples.
/// \return about how many samples there will be
std::uint64_t plan_poisson(const PreparedMesh& prepared, const FilterOptions& options,
                           WorkingPlan& plan) {
  const SpacingField field =
      options.spacing  ? SpacingField(resolve_for(prepared, plan, "spacing", *options.spacing))
      : options.r_coef ? SpacingField(*options.r_coef * prepared.mesh.mean_edge_length())
                       : SpacingField(prepared.mesh, prepared.map);
  plan.sample_spacing = field.least();
  plan.largest_sample_spacing = field.largest();
  std::vector<Index> textured;
  for (Index f = 0; f < prepared.mesh.faces.size(); ++f) {
    if (prepared.map.texel_area[f] > 0) textured.push_back(f);
  }
  return whole_number(field.expected_samples(prepared.mesh, textured));
}

std::uint64_t plan_nodes(const PreparedMesh& prepared, const RefineOptions& refinement,
                         const FilterOptions& options) {
  const double nodes = expected_nodes(prepared.mesh, refinement);
  if (options.node_spacing && nodes > kMostNodes) {
    throw OptionError("node_spacing", "would make about " + std::to_string(whole_number(nodes)) +
                                          " nodes, more than fit in memory; choose a larger one");
  }
  return whole_number(nodes);
}

/// Texels of one of several tiles that are wider than sigma hardly have neighbours that count.
void warn_of_wide_texels(const FilterSetup& setup, const SurfaceTextures& textures,
                         std::vector<std::string>& warnings) {
  const TexelMap& map = setup.map;
  for (Index i = 0; map.tiles.size() > 1 && i < map.tiles.size(); ++i) {
    const double texel = map.median_texel_size(i);
    if (texel <= setup.lengths.sigma_spatial) continue;
    warnings.push_back(textures.tiles[i].name + ": is hardly filtered, its texels are " +
                       number_text(texel * setup.unit) + " wide and sigma_spatial is " +
                       number_text(setup.lengths.sigma_spatial * setup.unit));
  }
}

}  // namespace

FilterSetup set_up_filter(const TriangleMesh& mesh, const SurfaceTextures& textures,
                          const FilterOptions& options) {
  check_arrays(mesh);
  check_options(options, mesh.faces.size());
  check_textures(textures, mesh.faces.size(),
                 options.kind == FilterKind::bilateral && options.guides.empty()
                     ? options.range_space
                     : RangeSpace::code);
  for (const Guide& guide : options.guides)
    if (guide.kind == Guide::Kind::images) check_textures(guide.textures, mesh.faces.size());
  if (options.filter_alpha) check_alpha(textures);
  FilterSetup setup{prepare_mesh(mesh, textures, options), {}, {}, {}, false, {}};
  std::vector<std::string> names;
  for (const TextureTile& tile : textures.tiles) names.push_back(tile.name);
  setup.overlap = OverlapPolicy(options.overlap, setup.map, names);
  if (!setup.overlap.texels().empty()) setup.warnings.push_back(setup.overlap.warning());

  const bool poisson = options.samples == SampleKind::poisson;
  setup.graded = poisson && !options.spacing && !options.r_coef;
  setup.lengths = plan_lengths(setup, options);
  warn_of_wide_texels(setup, textures, setup.warnings);
  const std::uint64_t texels = setup.map.claims.size();
  const std::uint64_t samples = poisson ? plan_poisson(setup, options, setup.lengths) : texels;
  setup.refinement = refinement_for(setup, setup.lengths);
  setup.refinement.any_shape =
      options.distance == DistanceMethod::automatic || options.distance == DistanceMethod::unfold;
  const std::uint64_t nodes = plan_nodes(setup, setup.refinement, options);

  FilterPlan& plan = setup.mesh_plan;
  plan = in_mesh_units(setup.lengths, setup.unit);
  plan.joined_edges = setup.joining.joined_edges;
  plan.t_junctions = setup.joining.t_junctions;
  plan.near_edges = setup.near.edges;
  plan.texels = texels;
  plan.overlapped = setup.overlap.texels().size();
  plan.samples = samples;
  plan.nodes = nodes;
  plan.memory_bytes = expected_memory(textures, plan, options);
  plan.memory_limit = memory_limit(options);
  plan.warnings = std::move(setup.warnings);
  return setup;
}

}  // namespace onmesh
