#include "onmesh/filter/setup.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "onmesh/base/error.h"
#include "onmesh/nodes/sizing_field.h"
#include "onmesh/poisson/spacing_field.h"

namespace onmesh {
namespace {

/// Where the surface is nearly flat, the spacing's square times the Gaussian curvature: at sigma 8
/// and radius 20 texels distances are off by less than a hundredth of a texel.
constexpr double kFlatness = 0.0072;
/// So many nodes need some 45 GB.
constexpr double kMostNodes = 5e7;

void require_positive(const char* flag, double value) {
  if (!(value > 0) || !std::isfinite(value)) {
    throw UsageError(std::string(flag) + ": must be positive and finite");
  }
}

void check_options(const TriangleMesh& mesh, const FilterOptions& options) {
  require_positive("--sigma-spatial", options.sigma_spatial.value);
  if (options.kind == FilterKind::bilateral) {
    require_positive("--sigma-range", options.sigma_range);
  }
  if (options.radius) require_positive("--radius", options.radius->value);
  if (options.spacing) require_positive("--spacing", options.spacing->value);
  if (options.r_coef) require_positive("--r-coef", *options.r_coef);
  if (options.node_spacing) require_positive("--node-spacing", options.node_spacing->value);
  require_positive("--tolerance", options.tolerance);
  if (options.bridge) {
    require_positive("--bridge", options.bridge->value);
    if (options.distance == DistanceMethod::exact) {
      throw UsageError("--bridge: exact distances know none, so not with --distance exact");
    }
  }
  if (options.spacing && options.r_coef) {
    throw UsageError("--spacing and --r-coef exclude each other");
  }
  if (options.samples != SampleKind::poisson && (options.spacing || options.r_coef)) {
    throw UsageError(std::string(options.spacing ? "--spacing" : "--r-coef") +
                     ": only with --samples poisson");
  }
  if (options.threads < 0) throw UsageError("--threads: must not be negative");
  if (options.gutter < 0) throw UsageError("--gutter: must not be negative");
  if (!options.faces.empty() && options.faces.size() != mesh.faces.size()) {
    throw UsageError("faces: one entry per face of the mesh is needed");
  }
}

std::string count_text(Index count, const char* one, const char* many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

std::string faces_text(Index count) { return count_text(count, "face", "faces"); }

Index count_unused(const TriangleMesh& mesh) {
  std::vector<bool> used(mesh.positions.size(), false);
  for (const auto& face : mesh.faces) {
    for (const Index v : face) used[v] = true;
  }
  return static_cast<Index>(std::count(used.begin(), used.end(), false));
}

/// Weld and clean; `faces` follows from the mesh as given to the clean one.
TriangleMesh cleaned(const TriangleMesh& mesh, std::vector<bool>& faces, CleanReport& report,
                     std::vector<std::string>& warnings) {
  TriangleMesh clean_mesh = clean(weld(mesh), &report);
  if (!faces.empty()) {
    std::vector<bool> kept(report.kept.size());
    for (std::size_t f = 0; f < kept.size(); ++f) kept[f] = faces[report.kept[f]];
    faces = std::move(kept);
  }
  if (const Index dropped = report.collapsed + report.duplicates + report.fins; dropped > 0) {
    warnings.push_back(faces_text(dropped) +
                       " dropped: repeated vertices, duplicates of other faces, or fins");
  }
  if (report.flat > 0) {
    warnings.push_back(faces_text(report.flat) + " skipped: parts of the mesh without any area");
  }
  if (const Index unused = count_unused(mesh); unused > 0) {
    warnings.push_back(count_text(unused, "vertex", "vertices") + " skipped: no face uses them");
  }
  if (report.separated > 0) {
    warnings.push_back(faces_text(report.separated) +
                       " on the same vertices as others, with texels of their own: filtered as "
                       "sheets of their own");
  }
  if (report.flipped > 0) warnings.push_back(faces_text(report.flipped) + " turned over");
  if (!report.manifold()) {
    warnings.push_back("the mesh is not manifold: " + report.defects() +
                       "; it is filtered across them");
  }
  return clean_mesh;
}

/// Charts beside the image's own tile repeat it, which is meant for tiling textures, but not for
/// UDIM.
void warn_of_tiles(const TriangleMesh& mesh, const TexelMap& map,
                   std::vector<std::string>& warnings) {
  Index outside = 0;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (map.chart_of_face[f] == kNone) continue;
    const auto uvs = mesh.corner_uvs(f);
    const Vec2 centre = (uvs[0] + uvs[1] + uvs[2]) / 3;
    outside += (centre.array() < 0).any() || (centre.array() > 1).any();
  }
  if (outside == 0) return;
  warnings.push_back(faces_text(outside) +
                     " with UVs outside [0,1]: the image is repeated there, or cut off (--wrap)");
}

void require_claims(const TriangleMesh& mesh, const TexelMap& map, const std::vector<bool>& faces) {
  if (!map.claims.empty()) return;
  if (mesh.faces.empty()) throw InputError("the mesh has no faces to filter on");
  bool any_uvs = false, any_uv_area = false, any_face = faces.empty();
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    any_uvs = any_uvs || mesh.has_uvs(f);
    any_uv_area = any_uv_area || (mesh.has_uvs(f) && mesh.uv_area(f) != 0);
    any_face = any_face || faces[f];
  }
  if (!any_uvs) {
    throw InputError("the mesh has no UVs, so no texture can be filtered on it");
  }
  if (!any_uv_area) {
    throw InputError(
        "the UVs of no face have any area (each is a spot or a line in the texture), so there is "
        "nothing to filter");
  }
  throw InputError(any_face ? "no texel of the texture lies on a face with area"
                            : "no face of the mesh carries the texture");
}

void check_overlaps(const TexelMap& map, const std::vector<Index>& overlapped, Overlap overlap,
                    std::vector<std::string>& warnings) {
  if (overlapped.empty()) return;
  const auto width = static_cast<Index>(map.width);
  const std::string what =
      std::to_string(overlapped.size()) + (overlapped.size() == 1 ? " texel is" : " texels are") +
      " claimed by several places of the surface, the first at column " +
      std::to_string(overlapped[0] % width) + ", row " + std::to_string(overlapped[0] / width);
  if (overlap == Overlap::error) throw InputError("--overlap error: " + what);
  warnings.push_back(what + (overlap == Overlap::average
                                 ? "; they get the mean of the results (--overlap average)"
                                 : "; they get the first face's result (--overlap first)"));
}

/// A texel costs its claim, its samples, and its values in two images; a node with its two faces
/// what refinement needs for it at most.
std::uint64_t estimate_memory(const Image& texture, const FilterPlan& plan) {
  constexpr double kBytesPerTexel = 26, kBytesPerSample = 16, kBytesPerNode = 900;
  const double values = 2.0 * double(texture.pixels.size()) * sizeof(float);
  return static_cast<std::uint64_t>(values + kBytesPerTexel * double(plan.texels) +
                                    kBytesPerSample * double(plan.samples) +
                                    kBytesPerNode * double(plan.nodes));
}

}  // namespace

NodeSpacing node_spacing_for(double sigma, double radius, double texel_size,
                             bool depends_on_spacing, bool by_nodes) {
  const double curved = std::max((depends_on_spacing ? 1.0 : 1.5) * sigma,
                                 (depends_on_spacing || by_nodes ? 4 : 10) * texel_size);
  const double finest = std::max(sigma / 4, 2 * texel_size);
  const double flat = depends_on_spacing ? curved : std::clamp(3 * radius, curved, 2 * curved);
  return {flat, curved, std::min(curved, finest)};
}

RefineOptions refinement_for(const FilterSetup& setup) {
  RefineOptions options;
  const FilterPlan& plan = setup.plan;
  options.spacing = plan.node_spacing;
  options.curved = plan.curved_spacing;
  options.finest = plan.finest_spacing;
  options.flatness = kFlatness;
  options.spread = std::numbers::pi * plan.radius * plan.radius;
  // Near bends the spacing follows sigma, however large it is elsewhere.
  options.sharpness = std::max(3.0, 2 * plan.curved_spacing / plan.sigma_spatial);
  options.flat_faces = setup.plan.bridge > 0;
  options.needed.reserve(setup.mesh.faces.size());
  for (const double area : setup.map.texel_area) options.needed.push_back(area > 0);
  // Patches reach three edges beyond the radius, from node faces that reach an edge beyond the
  // texels; some more keep the faces there as small as they are where the spacing is not yet
  // larger.
  options.reach = plan.radius + std::max(9 * plan.curved_spacing, 6 * plan.node_spacing);
  return options;
}

FilterPlan in_mesh_units(FilterPlan plan, double unit) {
  for (double* length :
       {&plan.sigma_spatial, &plan.radius, &plan.node_spacing, &plan.curved_spacing,
        &plan.finest_spacing, &plan.sample_spacing, &plan.largest_sample_spacing, &plan.texel_size,
        &plan.diagonal, &plan.bridge}) {
    *length *= unit;
  }
  plan.surface_area *= unit * unit;
  return plan;
}

FilterSetup set_up_filter(const TriangleMesh& mesh, const Image& texture,
                          const FilterOptions& options) {
  check_options(mesh, options);
  if (texture.range_channels().empty()) {
    throw InputError("the texture has no channel but alpha: nothing to filter");
  }
  FilterSetup setup;
  FilterPlan& plan = setup.plan;
  std::vector<bool> faces = options.faces;
  setup.mesh = cleaned(mesh, faces, setup.cleaning, plan.warnings);
  if (options.distance == DistanceMethod::exact && !setup.cleaning.manifold()) {
    throw InputError("--distance exact: the mesh is not manifold (" + setup.cleaning.defects() +
                     "); use unfold");
  }
  setup.unit = std::exp2(std::ceil(std::log2(std::max(setup.mesh.diagonal(), 1e-300))));
  for (Vec3& p : setup.mesh.positions) p /= setup.unit;
  setup.map = make_texel_map(setup.mesh, texture.width, texture.height, {options.wrap, faces});
  require_claims(setup.mesh, setup.map, faces);
  warn_of_tiles(setup.mesh, setup.map, plan.warnings);
  const std::vector<Index> overlapped = setup.map.overlapped();
  check_overlaps(setup.map, overlapped, options.overlap, plan.warnings);

  plan.texels = setup.map.claims.size();
  plan.overlapped = overlapped.size();
  plan.texel_size = setup.map.median_texel_size();
  plan.diagonal = setup.mesh.diagonal();
  const auto resolved = [&](const Length& length) {
    const double value = resolve(length, plan.texel_size, plan.diagonal);
    return length.unit == Length::Unit::mesh ? value / setup.unit : value;
  };
  plan.sigma_spatial = resolved(options.sigma_spatial);
  require_positive("--sigma-spatial", plan.sigma_spatial);
  plan.radius = options.radius
                    ? resolved(*options.radius)
                    : plan.sigma_spatial * (options.kind == FilterKind::bilateral ? 2.5 : 3.0);
  if (options.bridge) plan.bridge = resolved(*options.bridge);
  const bool depends_on_spacing = options.distance == DistanceMethod::heat ||
                                  options.distance == DistanceMethod::cloud || plan.bridge > 0 ||
                                  options.kind == FilterKind::gaussian;
  const NodeSpacing rule =
      node_spacing_for(plan.sigma_spatial, plan.radius, plan.texel_size, depends_on_spacing,
                       options.method == FilterMethod::nodes);
  plan.node_spacing = options.node_spacing ? resolved(*options.node_spacing) : rule.flat;
  plan.curved_spacing = options.node_spacing ? plan.node_spacing : rule.curved;
  plan.finest_spacing = options.node_spacing ? plan.node_spacing / 4 : rule.finest;

  std::vector<Index> textured;
  for (Index f = 0; f < setup.mesh.faces.size(); ++f) {
    plan.surface_area += setup.mesh.face_area(f);
    if (setup.map.texel_area[f] > 0) textured.push_back(f);
  }
  plan.samples = plan.texels;
  if (options.samples == SampleKind::poisson) {
    setup.graded = !options.spacing && !options.r_coef;
    const SpacingField field = options.spacing ? SpacingField(resolved(*options.spacing))
                               : options.r_coef
                                   ? SpacingField(*options.r_coef * setup.mesh.mean_edge_length())
                                   : SpacingField(setup.mesh, setup.map);
    plan.sample_spacing = field.least();
    plan.largest_sample_spacing = field.largest();
    plan.samples = static_cast<std::uint64_t>(field.expected_samples(setup.mesh, textured));
  }
  // Twice the area of an equilateral triangle per node; refinement stays somewhat below the
  // spacing.
  const RefineOptions refinement = refinement_for(setup);
  const Remoteness remoteness(setup.mesh, refinement);
  double nodes = double(setup.mesh.positions.size());
  for (Index f = 0; f < setup.mesh.faces.size(); ++f) {
    const double spacing = refinement.curved + remoteness({f, Vec3::Constant(1.0 / 3)});
    nodes += 1.2 * setup.mesh.face_area(f) / (spacing * spacing * std::numbers::sqrt3 / 2);
  }
  if (options.node_spacing && nodes > kMostNodes) {
    throw UsageError("--node-spacing: would make about " + std::to_string(std::uint64_t(nodes)) +
                     " nodes, more than fit in memory; choose a larger one");
  }
  plan.nodes = static_cast<std::uint64_t>(nodes);
  plan.memory_bytes = estimate_memory(texture, plan);
  return setup;
}

FilterPlan plan_filter(const TriangleMesh& mesh, const Image& texture,
                       const FilterOptions& options) {
  const FilterSetup setup = set_up_filter(mesh, texture, options);
  return in_mesh_units(setup.plan, setup.unit);
}

}  // namespace onmesh
