#include "filter_options.h"

#include <cstdint>

#include "flags.h"
#include "guides.h"
#include "shared_options.h"

namespace onmesh::tools {
namespace {

void refuse_ignored(const Arguments& arguments, const FilterOptions& options) {
  for (const char* name : {"sigma-range", "range-space", "guide"}) {
    if (options.kind == FilterKind::gaussian && arguments.given(name))
      throw UsageError(dashed(name) + ": only with --kind bilateral");
  }
  if (arguments.has("guide")) {
    if (arguments.given("sigma-range"))
      throw UsageError("--sigma-range: --guide has widths of its own (self:S for own values)");
    if (arguments.given("guide") && arguments.given("kind") && arguments.text("kind") == "gaussian")
      throw UsageError("--guide: only with --kind bilateral");
    for (const std::string& guide : arguments.texts("guide")) parse_guide(guide);
  }
  if (arguments.given("despike-to") && !arguments.has("despike"))
    throw UsageError("--despike-to: only with --despike");
  if (arguments.given("guides-from") && arguments.text("iterations") == "1")
    throw UsageError("--guides-from: only with --iterations of 2 or more");
  if (options.method == FilterMethod::direct && arguments.given("tolerance")) {
    throw UsageError("--tolerance: not with --method direct");
  }
  for (const char* name : {"spacing", "r-coef", "seed"}) {
    if (options.samples != SampleKind::poisson && arguments.given(name)) {
      throw UsageError(dashed(name) + ": only with --samples poisson");
    }
  }
  arguments.refuse_together("spacing", {"r-coef"});
  arguments.refuse_together("detail-out", {"detail-gain"});
}

}  // namespace

FilterOptions filter_options(const Arguments& arguments) {
  FilterOptions options;
  options.kind = arguments.choice<FilterKind>(
      "kind", {{"bilateral", FilterKind::bilateral}, {"gaussian", FilterKind::gaussian}});
  options.samples = arguments.choice<SampleKind>(
      "samples", {{"texel", SampleKind::texel}, {"poisson", SampleKind::poisson}});
  options.wrap = wrap_of(arguments);
  options.stop_at_materials =
      arguments.choice<bool>("stop-at", {{"none", false}, {"material", true}});
  options.overlap = arguments.choice<Overlap>(
      "overlap",
      {{"average", Overlap::average}, {"first", Overlap::first}, {"error", Overlap::error}});
  options.method = arguments.choice<FilterMethod>("method", {{"auto", FilterMethod::automatic},
                                                             {"direct", FilterMethod::direct},
                                                             {"nodes", FilterMethod::nodes}});
  refuse_ignored(arguments, options);
  options.sigma_spatial = arguments.length("sigma-spatial");
  options.sigma_range = arguments.width("sigma-range");
  if (arguments.has("despike")) options.despike = arguments.number("despike", 1, 1e6);
  options.despike_to_limit =
      arguments.choice<bool>("despike-to", {{"median", false}, {"limit", true}});
  options.keep_mean = arguments.flag("keep-mean");
  options.iterations = int(arguments.integer("iterations", 1, 100));
  options.guides_from_result =
      arguments.choice<bool>("guides-from", {{"input", false}, {"result", true}});
  options.range_space = range_space_of(arguments);
  if (arguments.has("tolerance")) options.tolerance = arguments.number("tolerance");
  options.radius = arguments.optional_length("radius");
  options.spacing = arguments.optional_length("spacing");
  if (arguments.has("r-coef")) options.r_coef = arguments.number("r-coef");
  options.bridge = bridge_of(arguments);
  options.weld = weld_of(arguments);
  options.strength = arguments.number("strength");
  options.detail_gain = arguments.number("detail-gain");
  options.filter_alpha = arguments.flag("alpha");
  options.node_spacing = arguments.optional_length("node-spacing");
  options.distance = distance_of(arguments);
  options.seed = std::uint64_t(arguments.integer("seed", 0, INT64_MAX));
  options.gutter = int(arguments.integer("gutter", 0, 32768));
  options.threads = int(arguments.integer("threads", 0, 1024));
  if (arguments.has("max-memory")) options.max_memory = arguments.bytes("max-memory");
  return options;
}

std::vector<SurfaceMap> library_maps(const SurfaceInputs& inputs) {
  std::vector<SurfaceMap> maps;
  for (std::size_t m = 0; m < inputs.maps.size(); ++m) {
    const InputMap& map = inputs.maps[m];
    SurfaceMap& out = maps.emplace_back();
    out.name = map.name;
    out.textures = inputs.textures(m);
    if (map.has_own_uvs) out.mesh = map.mesh.get();
    out.is_filtered = map.is_filtered;
    if (!map.is_filtered)
      out.meaning =
          map.slot == TextureSlot::normal ? Guide::Meaning::normal_gl : meaning_of(map.role);
  }
  return maps;
}

FilterOptions with_guides(FilterOptions options, const SurfaceInputs& inputs) {
  for (const InputGuide& guide : inputs.guides) {
    if (guide.is_off) options.kind = FilterKind::gaussian;
    if (!guide.is_off) options.guides.push_back(guide.guide);
  }
  return options;
}

}  // namespace onmesh::tools
