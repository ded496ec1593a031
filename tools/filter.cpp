// onmesh filter: the main job. Reads mesh and texture, filters, writes the texture.
#include "onmesh/filter/filter.h"

#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "filter_report.h"
#include "flags.h"
#include "interruption.h"
#include "messages.h"
#include "onmesh/base/process_memory.h"
#include "onmesh/image/image_io.h"
#include "onmesh/mesh_io/read_mesh.h"
#include "report.h"
#include "shared_options.h"
#include "stopwatch.h"
#include "subcommands.h"
#include "texture_choice.h"

namespace onmesh::tools {

Command filter_command() {
  Command command;
  command.name = "filter";
  command.synopsis = "MESH [-t TEXTURE] -o OUT [options]";
  command.summary =
      "Filters a texture on the surface of the mesh: distances are geodesic, so neither seams nor\n"
      "stretching of the atlas shows. Lengths are in mesh units (0.2), in texels (8tx) or in "
      "percent\n"
      "of the bounding box's diagonal (1%).";
  command.examples =
      "  onmesh filter model.obj -o smooth.png\n"
      "  onmesh filter model.obj -t skin.png -o skin.png --sigma-spatial 6tx --sigma-range 30/255\n"
      "  onmesh filter model.obj -o blurred.exr --kind gaussian --sigma-spatial 1%\n"
      "  onmesh filter model.obj -o smooth.png --dry-run\n";
  auto add = command.options.add_options();
  add("mesh", text());
  add("output,o", text(), "the texture to write; may be the input texture itself");
  add("texture,t", text(), "the texture to filter (default: the one the mesh's material names)");
  add("material", text(), "filter on the faces of this material; with -t 'all' = on all faces");
  add("kind", text("bilateral"), "bilateral (keeps edges) or gaussian (blurs)");
  add("sigma-spatial", text("4tx"), "length: width of the filter on the surface");
  add("sigma-range", text("0.1"),
      "bilateral: width of the filter in colour differences; values run from 0 to 1 (or 25/255)");
  add("radius", text(),
      "length: how far samples count (default: 2.5 sigma bilateral, 3 sigma gaussian)");
  add("distance", text("auto"), "how distances are computed: auto, unfold, heat, cloud or exact");
  add("bridge", text("0"),
      "length: lead on across smaller gaps than this, between parts of the mesh and within them "
      "(default: none; parts do not influence each other)");
  add_weld_option(command.options);
  add("method", text("auto"),
      "how the sums are done: direct (pair by pair), nodes (at a cost per texel that does not "
      "depend on sigma), or auto: nodes where that is faster and within the tolerance");
  add("tolerance", text(),
      "auto, nodes: most RMS difference to the direct sums, as a share of the texture's range of "
      "values; measured on some texels of every patch (default: 1/512)");
  add("node-spacing", text(),
      "length between the nodes of the distance table (default: by sigma and curvature)");
  add("samples", text("texel"),
      "texel (every texel once) or poisson (random points, none close to another)");
  add("spacing", text(),
      "poisson: length between samples (default: by the size of the texels, so that each is hit)");
  add("r-coef", text(), "poisson: the same as a multiple of the mesh's mean edge length");
  add("seed", text("1"), "poisson: of the random points");
  add("wrap", text("repeat"), "UVs outside [0,1]: repeat or clamp");
  add("overlap", text("average"), "texels used by several faces: average, first or error");
  add("gutter", text("2"), "rings of texels to fill around charts");
  add("threads", text("0"), "0 = all processors");
  add("max-memory", text(),
      "refuse what would take more, such as 8G (default: what there is and what is left)");
  add("dry-run", flag(), "check everything, tell what would be done, write nothing");
  add("json", flag(), "print a report as JSON on stdout");
  add("quiet", flag(), "no progress, summary or warnings");
  command.positional.add("mesh", 1);
  return command;
}

namespace {

using nlohmann::json;

void refuse_ignored(const Arguments& arguments, const FilterOptions& options) {
  if (options.kind == FilterKind::gaussian && arguments.given("sigma-range")) {
    throw UsageError("--sigma-range: only with --kind bilateral");
  }
  if (options.method == FilterMethod::direct && arguments.given("tolerance")) {
    throw UsageError("--tolerance: not with --method direct");
  }
  for (const char* name : {"spacing", "r-coef", "seed"}) {
    if (options.samples != SampleKind::poisson && arguments.given(name)) {
      throw UsageError(dashed(name) + ": only with --samples poisson");
    }
  }
  arguments.refuse_together("spacing", {"r-coef"});
}

FilterOptions filter_options(const Arguments& arguments) {
  FilterOptions options;
  options.kind = arguments.choice<FilterKind>(
      "kind", {{"bilateral", FilterKind::bilateral}, {"gaussian", FilterKind::gaussian}});
  options.samples = arguments.choice<SampleKind>(
      "samples", {{"texel", SampleKind::texel}, {"poisson", SampleKind::poisson}});
  options.wrap = wrap_of(arguments);
  options.overlap = arguments.choice<Overlap>(
      "overlap",
      {{"average", Overlap::average}, {"first", Overlap::first}, {"error", Overlap::error}});
  options.method = arguments.choice<FilterMethod>("method", {{"auto", FilterMethod::automatic},
                                                             {"direct", FilterMethod::direct},
                                                             {"nodes", FilterMethod::nodes}});
  refuse_ignored(arguments, options);
  options.sigma_spatial = arguments.length("sigma-spatial");
  options.sigma_range = arguments.number("sigma-range");
  if (arguments.has("tolerance")) options.tolerance = arguments.number("tolerance");
  options.radius = arguments.optional_length("radius");
  options.spacing = arguments.optional_length("spacing");
  if (arguments.has("r-coef")) options.r_coef = arguments.number("r-coef");
  options.bridge = bridge_of(arguments);
  options.weld = weld_of(arguments);
  options.node_spacing = arguments.optional_length("node-spacing");
  options.distance = distance_of(arguments);
  options.seed = std::uint64_t(arguments.integer("seed", 0, INT64_MAX));
  options.gutter = int(arguments.integer("gutter", 0, 32768));
  options.threads = int(arguments.integer("threads", 0, 1024));
  if (arguments.has("max-memory")) options.max_memory = arguments.bytes("max-memory");
  return options;
}

/// All options with their values in force.
json options_json(const Arguments& arguments) {
  json options = json::object();
  for (const auto& [name, value] : arguments.values()) {
    if (const auto* text_value = boost::any_cast<std::string>(&value.value())) {
      options[name] = *text_value;
    } else {
      options[name] = arguments.flag(name);
    }
  }
  return options;
}

/// Writing over the texture is fine (it is replaced at the end), over the mesh never.
void check_output(const std::string& output, const std::string& mesh, const Image& texture) {
  std::error_code error;
  if (output == mesh || std::filesystem::equivalent(output, mesh, error)) {
    throw UsageError("--output: " + output + " is the mesh");
  }
  check_writable_image(output, texture);
}

/// Mesh and texture as read, and what is told in the end.
struct FilterInputs {
  std::string mesh_path;
  TriangleMesh mesh;
  TextureChoice choice;
  Image texture;
  std::vector<StageTime> stages;
  std::vector<std::string> warnings;
};

StageTime stage(const char* name, Stopwatch& watch) {
  return {name, watch.lap(), peak_memory_bytes()};
}

FilterInputs read_inputs(const Arguments& arguments, Stopwatch& watch) {
  FilterInputs inputs;
  inputs.mesh_path = arguments.argument("mesh");
  inputs.mesh = read_mesh(inputs.mesh_path, &inputs.warnings);
  inputs.stages.push_back(stage("read mesh", watch));
  check_interrupted();
  inputs.choice = explained_by(inputs.warnings, [&] {
    return choose_texture(inputs.mesh, arguments.optional_text("texture"),
                          arguments.optional_text("material"));
  });
  inputs.texture = read_texture(inputs.choice.path);
  inputs.stages.push_back(stage("read texture", watch));
  check_interrupted();
  return inputs;
}

/// The part of the JSON report that plan and run share.
json report_start(const Arguments& arguments, const FilterInputs& inputs,
                  const std::string& output) {
  json out = new_report("filter");
  out["mesh"] = inputs.mesh_path;
  out["texture"] = {{"path", inputs.choice.path.string()},
                    {"reason", inputs.choice.reason},
                    {"width", inputs.texture.width},
                    {"height", inputs.texture.height},
                    {"channels", inputs.texture.channels}};
  out["output"] = text_or_null(output);
  out["options"] = options_json(arguments);
  out["dry_run"] = arguments.flag("dry-run");
  return out;
}

/// Adds the library's warnings to those of reading, in terms of flags.
void add_warnings(const std::vector<std::string>& more, std::vector<std::string>& warnings) {
  for (const std::string& warning : more) warnings.push_back(in_flags(warning));
}

/// Calls work(), which filters the mesh read; errors name the file and flags.
template <class Work>
auto filtering(const FilterInputs& inputs, Work work) {
  return naming(inputs.mesh_path, [&] { return with_flags(work); });
}

void tell_plan(const Arguments& arguments, const FilterOptions& options, FilterInputs& inputs,
               json out) {
  const FilterPlan plan =
      filtering(inputs, [&] { return plan_filter(inputs.mesh, inputs.texture, options); });
  add_warnings(plan.warnings, inputs.warnings);
  if (plan.memory_bytes > plan.memory_limit) {
    inputs.warnings.push_back("the run will be refused: it takes more memory than may be used");
  }
  if (!arguments.flag("quiet")) warn(inputs.warnings);
  if (!arguments.flag("json")) {
    print_plan(plan, inputs.texture, std::cout);
    return;
  }
  out["plan"] = to_json(plan);
  out["warnings"] = inputs.warnings;
  print_report(std::move(out));
}

void filter_and_write(const Arguments& arguments, const FilterOptions& options,
                      FilterInputs& inputs, const std::string& output, json out, Stopwatch& watch) {
  const bool quiet = arguments.flag("quiet");
  FilterReport report;
  Image result;
  {
    ProgressBar bar(quiet);
    result = filtering(inputs, [&] {
      return filter(inputs.mesh, inputs.texture, options, &report, bar.callback());
    });
  }
  watch.lap();
  check_interrupted();
  add_warnings(report.warnings, inputs.warnings);
  write_image(output, result, {}, &inputs.warnings);
  report.stages.insert(report.stages.begin(), inputs.stages.begin(), inputs.stages.end());
  report.stages.push_back(stage("write texture", watch));
  if (!quiet) {
    warn(inputs.warnings);
    print_summary(report, watch.total(), std::cerr);
  }
  if (arguments.flag("json")) {
    out.update(to_json(report));
    out["warnings"] = inputs.warnings;
    out["seconds"] = watch.total();
    print_report(std::move(out));
  }
}

}  // namespace

int run_filter(const Arguments& arguments) {
  arguments.argument("mesh");
  const bool dry_run = arguments.flag("dry-run");
  const std::string output = dry_run && !arguments.has("output") ? "" : arguments.text("output");
  FilterOptions options = filter_options(arguments);

  Stopwatch watch;
  FilterInputs inputs = read_inputs(arguments, watch);
  options.faces = inputs.choice.faces;
  if (!output.empty()) check_output(output, inputs.mesh_path, inputs.texture);
  json out = report_start(arguments, inputs, output);
  if (dry_run) {
    tell_plan(arguments, options, inputs, std::move(out));
  } else {
    filter_and_write(arguments, options, inputs, output, std::move(out), watch);
  }
  return 0;
}

}  // namespace onmesh::tools
