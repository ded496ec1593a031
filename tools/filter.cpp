// onmesh filter: the main job. Reads mesh and texture, filters, writes the texture.
#include <chrono>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "command.h"
#include "inputs.h"
#include "onmesh/filter/filter.h"
#include "onmesh/image/image_io.h"
#include "onmesh/mesh_io/read_mesh.h"
#include "texture_choice.h"

namespace onmesh::tools {
namespace {

using nlohmann::json;

Command make_command() {
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
      "length: join parts of the mesh across smaller gaps than this (default: none; parts do not "
      "influence each other)");
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
  add("dry-run", flag(), "check everything, tell what would be done, write nothing");
  add("json", flag(), "print a report as JSON on stdout");
  add("quiet", flag(), "no progress, summary or warnings");
  command.positional.add("mesh", 1);
  return command;
}

bool given(const po::variables_map& values, const char* name) {
  return has(values, name) && !values[name].defaulted();
}

/// The enumerator whose name was given.
template <typename Enum>
Enum choice(const po::variables_map& values, const std::string& name,
            const std::vector<std::pair<std::string, Enum>>& known) {
  const std::string value = text_of(values, name);
  std::string names;
  for (const auto& [known_name, enumerator] : known) {
    if (value == known_name) return enumerator;
    names += (names.empty() ? "" : ", ") + known_name;
  }
  throw UsageError("--" + name + ": '" + value + "' is not one of " + names);
}

void refuse_ignored(const po::variables_map& values, const FilterOptions& options) {
  if (options.kind == FilterKind::gaussian && given(values, "sigma-range")) {
    throw UsageError("--sigma-range: only with --kind bilateral");
  }
  if (options.method == FilterMethod::direct && given(values, "tolerance")) {
    throw UsageError("--tolerance: not with --method direct");
  }
  for (const char* name : {"spacing", "r-coef", "seed"}) {
    if (options.samples != SampleKind::poisson && given(values, name)) {
      throw UsageError(std::string("--") + name + ": only with --samples poisson");
    }
  }
}

FilterOptions filter_options(const po::variables_map& values) {
  FilterOptions options;
  options.kind = choice<FilterKind>(
      values, "kind", {{"bilateral", FilterKind::bilateral}, {"gaussian", FilterKind::gaussian}});
  options.samples = choice<SampleKind>(
      values, "samples", {{"texel", SampleKind::texel}, {"poisson", SampleKind::poisson}});
  options.wrap = choice<Wrap>(values, "wrap", {{"repeat", Wrap::repeat}, {"clamp", Wrap::clamp}});
  options.overlap = choice<Overlap>(
      values, "overlap",
      {{"average", Overlap::average}, {"first", Overlap::first}, {"error", Overlap::error}});
  options.method = choice<FilterMethod>(values, "method",
                                        {{"auto", FilterMethod::automatic},
                                         {"direct", FilterMethod::direct},
                                         {"nodes", FilterMethod::nodes}});
  refuse_ignored(values, options);
  const auto length = [&](const std::string& name) {
    return parse_length("--" + name, text_of(values, name));
  };
  options.sigma_spatial = length("sigma-spatial");
  options.sigma_range = parse_number("--sigma-range", text_of(values, "sigma-range"));
  if (has(values, "tolerance")) {
    options.tolerance = parse_number("--tolerance", text_of(values, "tolerance"));
  }
  if (has(values, "radius")) options.radius = length("radius");
  if (has(values, "spacing")) options.spacing = length("spacing");
  if (has(values, "r-coef")) options.r_coef = parse_number("--r-coef", text_of(values, "r-coef"));
  options.bridge = bridge_of(values);
  if (has(values, "node-spacing")) options.node_spacing = length("node-spacing");
  try {
    options.distance = distance_method(text_of(values, "distance"));
  } catch (const UsageError& error) {
    throw UsageError(std::string("--distance: ") + error.what());
  }
  options.seed = std::uint64_t(integer_of(values, "seed", 0, INT64_MAX));
  options.gutter = int(integer_of(values, "gutter", 0, 32768));
  options.threads = int(integer_of(values, "threads", 0, 1024));
  return options;
}

/// All options with their values in force.
json options_json(const po::variables_map& values) {
  json options = json::object();
  for (const auto& [name, value] : values) {
    if (const auto* text_value = boost::any_cast<std::string>(&value.value())) {
      options[name] = *text_value;
    } else {
      options[name] = flag_of(values, name);
    }
  }
  return options;
}

json plan_json(const FilterPlan& plan) {
  return {{"sigma_spatial", plan.sigma_spatial},
          {"sigma_texels", plan.sigma_spatial / plan.texel_size},
          {"radius", plan.radius},
          {"texel_size", plan.texel_size},
          {"node_spacing", plan.node_spacing},
          {"curved_node_spacing", plan.curved_spacing},
          {"finest_node_spacing", plan.finest_spacing},
          {"bridge", plan.bridge > 0 ? json(plan.bridge) : json()},
          {"sample_spacing", plan.sample_spacing > 0 ? json(plan.sample_spacing) : json()},
          {"largest_sample_spacing",
           plan.sample_spacing > 0 ? json(plan.largest_sample_spacing) : json()},
          {"surface_area", plan.surface_area},
          {"texels", plan.texels},
          {"overlapped_texels", plan.overlapped},
          {"estimated_samples", plan.samples},
          {"estimated_nodes", plan.nodes},
          {"estimated_memory_bytes", plan.memory_bytes}};
}

json report_json(const FilterReport& report) {
  json stages = json::array();
  for (const StageTime& stage : report.stages) {
    stages.push_back({{"stage", stage.stage},
                      {"seconds", stage.seconds},
                      {"peak_memory_bytes", stage.peak_memory_bytes}});
  }
  return {
      {"backend", {{"name", report.backend}, {"reason", report.backend_reason}}},
      {"method",
       {{"name", report.method},
        {"texels_by_nodes", report.by_nodes},
        {"palette", report.palette},
        {"checked_values", report.checked},
        {"rms_error", report.rms_error},
        {"max_error", report.max_error}}},
      {"instruction_set", report.instruction_set},
      {"refinement", report.refinement},
      {"lengths",
       {{"sigma_spatial", report.sigma_spatial},
        {"radius", report.radius},
        {"texel_size", report.texel_size},
        {"node_spacing", report.node_spacing},
        {"sample_spacing", report.sample_spacing > 0 ? json(report.sample_spacing) : json()},
        {"largest_sample_spacing",
         report.sample_spacing > 0 ? json(report.largest_sample_spacing) : json()}}},
      {"counts",
       {{"texels", report.texels},
        {"samples", report.samples},
        {"nodes", report.nodes},
        {"node_faces", report.node_faces},
        {"bridges", report.bridges},
        {"patches", report.patches},
        {"table_rows", report.table_rows},
        {"pairs", report.pairs},
        {"taps_per_texel", report.taps},
        {"overlapped_texels", report.overlapped},
        {"gutter_texels", report.gutter},
        {"texels_without_sample", report.without_sample}}},
      {"cpu_seconds", {{"table", report.table_cpu_seconds}, {"kernel", report.kernel_cpu_seconds}}},
      {"stages", stages}};
}

std::string number_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::string length_text(double length, double texel_size) {
  return number_text(length) + " (" + number_text(length / texel_size) + " texels)";
}

void print_plan(const FilterPlan& plan, const Image& texture, std::ostream& out) {
  out << "texture       " << texture.width << " x " << texture.height << ", " << texture.channels
      << " channels; " << format_count(plan.texels) << " texels on the surface, one is "
      << number_text(plan.texel_size) << " wide\n"
      << "sigma         " << length_text(plan.sigma_spatial, plan.texel_size) << '\n'
      << "radius        " << length_text(plan.radius, plan.texel_size) << '\n'
      << "nodes         about " << format_count(plan.nodes) << ", "
      << length_text(plan.node_spacing, plan.texel_size) << " apart";
  if (plan.curved_spacing < plan.node_spacing) {
    out << ", " << length_text(plan.curved_spacing, plan.texel_size)
        << " where the surface is curved";
  }
  out << ", " << length_text(plan.finest_spacing, plan.texel_size) << " where distances bend\n";
  if (plan.sample_spacing > 0) {
    out << "samples       about " << format_count(plan.samples) << ", "
        << length_text(plan.sample_spacing, plan.texel_size);
    if (plan.largest_sample_spacing > plan.sample_spacing) {
      out << " ... " << length_text(plan.largest_sample_spacing, plan.texel_size);
    }
    out << " apart\n";
  }
  out << "memory        about " << format_bytes(plan.memory_bytes) << '\n';
}

void print_summary(const FilterReport& report, double seconds, std::ostream& out) {
  out << format_count(report.texels) << " texels filtered in " << format_seconds(seconds) << '\n'
      << "sigma " << length_text(report.sigma_spatial, report.texel_size) << ", radius "
      << length_text(report.radius, report.texel_size) << "; " << format_count(report.nodes)
      << " nodes in " << format_count(report.patches) << " patches, distances: " << report.backend
      << " (" << report.backend_reason << ")\n";
  const std::uint64_t direct = report.texels - report.by_nodes;
  if (direct > 0) {
    out << format_count(direct) << " texels by " << format_count(std::uint64_t(report.taps + 0.5))
        << " samples each on average\n";
  }
  if (report.by_nodes > 0) {
    out << format_count(report.by_nodes) << " texels by nodes";
    if (report.palette > 0) out << ", at most " << report.palette << " colours";
    out << "; of " << format_count(report.checked) << " values checked, RMS error "
        << number_text(report.rms_error) << ", largest " << number_text(report.max_error) << '\n';
  }
  if (report.bridges > 0) out << format_count(report.bridges) << " bridges between parts\n";
  for (const StageTime& stage : report.stages) {
    out << "  " << stage.stage
        << std::string(14 - std::min<std::size_t>(stage.stage.size(), 13), ' ')
        << format_seconds(stage.seconds) << '\n';
  }
  if (report.without_sample > 0) {
    out << format_count(report.without_sample) << " texels found no sample and keep their values\n";
  }
}

/// Writing over the texture is fine (it is replaced at the end), over the mesh never.
void check_output(const std::string& output, const std::string& mesh, const Image& texture) {
  std::error_code error;
  if (output == mesh || std::filesystem::equivalent(output, mesh, error)) {
    throw UsageError("--output: " + output + " is the mesh");
  }
  check_writable_image(output, texture);
}

/// Times the reading and writing around the filter as stages of the report.
class Clock {
 public:
  StageTime stage(const char* name) {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return {name, seconds, peak_memory_bytes()};
  }
  double total() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now(), last_ = start_;
};

}  // namespace

int run_filter(const std::vector<std::string>& arguments) {
  const Command command = make_command();
  po::variables_map values;
  if (!parse(command, arguments, values)) return 0;
  const std::string mesh_path = argument_of(command, values, "mesh");
  const bool dry_run = flag_of(values, "dry-run"), as_json = flag_of(values, "json");
  const bool quiet = flag_of(values, "quiet");
  const std::string output = dry_run && !has(values, "output") ? "" : text_of(values, "output");
  FilterOptions options = filter_options(values);

  Clock clock;
  std::vector<StageTime> before;
  std::vector<std::string> warnings;
  TriangleMesh mesh = read_mesh(mesh_path, &warnings);
  before.push_back(clock.stage("read mesh"));
  check_interrupted();
  const TextureChoice texture_choice =
      choose_texture(mesh, optional_text(values, "texture"), optional_text(values, "material"));
  options.faces = texture_choice.faces;
  const Image texture = read_image(texture_choice.path);
  before.push_back(clock.stage("read texture"));
  check_interrupted();
  if (!output.empty()) check_output(output, mesh_path, texture);

  json out = new_report("filter");
  out["mesh"] = mesh_path;
  out["texture"] = {{"path", texture_choice.path.string()},
                    {"reason", texture_choice.reason},
                    {"width", texture.width},
                    {"height", texture.height},
                    {"channels", texture.channels}};
  out["output"] = output.empty() ? json() : json(output);
  out["options"] = options_json(values);
  out["dry_run"] = dry_run;

  if (dry_run) {
    const FilterPlan plan = naming(mesh_path, [&] { return plan_filter(mesh, texture, options); });
    warnings.insert(warnings.end(), plan.warnings.begin(), plan.warnings.end());
    if (!quiet) warn(warnings);
    out["plan"] = plan_json(plan);
    out["warnings"] = warnings;
    if (as_json) print_report(out);
    if (!as_json) print_plan(plan, texture, std::cout);
    return 0;
  }

  FilterReport report;
  Image result;
  {
    ProgressBar bar(quiet);
    result =
        naming(mesh_path, [&] { return filter(mesh, texture, options, &report, bar.callback()); });
  }
  clock.stage("filter");
  check_interrupted();
  warnings.insert(warnings.end(), report.warnings.begin(), report.warnings.end());
  write_image(output, result, {}, &warnings);
  report.stages.insert(report.stages.begin(), before.begin(), before.end());
  report.stages.push_back(clock.stage("write texture"));
  if (!quiet) warn(warnings);
  if (!quiet) print_summary(report, clock.total(), std::cerr);
  if (as_json) {
    out.update(report_json(report));
    out["warnings"] = warnings;
    out["seconds"] = clock.total();
    print_report(out);
  }
  return 0;
}

}  // namespace onmesh::tools
