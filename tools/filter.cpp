// onmesh filter: the main job. Reads mesh and texture, filters, writes the texture.
#include "onmesh/filter/filter.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "atlas.h"
#include "colour_spaces.h"
#include "filter_report.h"
#include "filtered_channels.h"
#include "flags.h"
#include "gltf_results.h"
#include "inputs.h"
#include "interruption.h"
#include "messages.h"
#include "onmesh/base/atomic_file.h"
#include "onmesh/base/process_memory.h"
#include "onmesh/image/image_io.h"
#include "onmesh/mesh_io/write_gltf.h"
#include "output_names.h"
#include "report.h"
#include "shared_options.h"
#include "stopwatch.h"
#include "subcommands.h"
#include "texture_set.h"

namespace onmesh::tools {

Command filter_command() {
  Command command;
  command.name = "filter";
  command.synopsis = "MESH [-t TEXTURE]... -o OUT [options]";
  command.summary =
      "Filters the textures on the surface of the mesh: distances are geodesic, so neither seams "
      "nor\n"
      "stretching of the atlas shows. Textures of several materials and UDIM tiles are one "
      "surface.\n"
      "Lengths are in mesh units (0.2), in texels (8tx) or in percent of the bounding box's "
      "diagonal\n"
      "(1%).";
  command.examples =
      "  onmesh filter model.obj -o smooth.png\n"
      "  onmesh filter model.obj -t skin.png -o skin.png --sigma-spatial 6tx --sigma-range 30/255\n"
      "  onmesh filter model.obj -o blurred.exr --kind gaussian --sigma-spatial 1%\n"
      "  onmesh filter figure.obj -o smooth/ --material skin\n"
      "  onmesh filter figure.obj -t 'skin.<UDIM>.png' -o 'smooth.<UDIM>.png' --only 1001,1002\n"
      "  onmesh filter scene.glb -o smooth.glb\n"
      "  onmesh filter scene.glb --uv-set 1 -t lightmap.exr -o lightmap_smooth.exr\n"
      "  onmesh filter model.obj -o smooth.png --dry-run\n";
  auto add = command.options.add_options();
  add("mesh", text());
  add("output,o", text(),
      "what to write: an image (may be the input texture itself), the glTF file with its images "
      "replaced, a folder/ for results under their "
      "own names, or a name with <UDIM>, <UVTILE>, {stem}, {material} or {ext}");
  add("texture,t", texts(),
      "a texture to filter, also with <UDIM>, <UVTILE> or {material} in its name; may be given "
      "several times (default: those that the mesh's materials name)");
  add("material", text(),
      "write the texture of this material only, the others are context; with one -t the faces that "
      "carry it, 'all' = all faces");
  add("layer", text(),
      "filter another layer of the images' channels, as in diffuse.R (default: R G B or Y; all "
      "other channels stay as they are)");
  add("only", text(), "write these UDIM tiles only, the others are context, such as 1001,1003");
  add("stop-at", text("none"), "none, or material: colour does not flow across materials");
  add("kind", text("bilateral"), "bilateral (keeps edges) or gaussian (blurs)");
  add("sigma-spatial", text("4tx"), "length: width of the filter on the surface");
  add("sigma-range", text("0.1"),
      "bilateral: width of the filter in colour differences; values run from 0 to 1 (or 25/255)");
  add_range_space_option(command.options);
  add_colour_space_options(command.options);
  add("radius", text(),
      "length: how far samples count (default: 2.5 sigma bilateral, 3 sigma gaussian)");
  add("distance", text("auto"), "how distances are computed: auto, unfold, heat, cloud or exact");
  add("bridge", text("0"),
      "length: lead on across smaller gaps than this, between parts of the mesh and within them "
      "(default: none; parts do not influence each other)");
  add_weld_option(command.options);
  add_gltf_options(command.options);
  add_confine_option(command.options);
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
  add_wrap_option(command.options);
  add("overlap", text("average"), "texels used by several faces: average, first or error");
  add("gutter", text("2"),
      "rings of texels to fill around charts; 0: only texels whose centre is on a chart change");
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
  for (const char* name : {"sigma-range", "range-space"}) {
    if (options.kind == FilterKind::gaussian && arguments.given(name))
      throw UsageError(dashed(name) + ": only with --kind bilateral");
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
  options.sigma_range = arguments.number("sigma-range");
  options.range_space = range_space_of(arguments);
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
    } else if (const auto* list = boost::any_cast<std::vector<std::string>>(&value.value())) {
      options[name] = list->size() == 1 ? json(list->front()) : json(*list);
    } else {
      options[name] = arguments.flag(name);
    }
  }
  return options;
}

/// Mesh and textures as read, and what is told in the end.
struct FilterInputs {
  std::string mesh_path;
  TriangleMesh mesh;
  TextureSet set;
  std::vector<Image> images;              ///< per texture of the set
  std::vector<ColourSpaceChoice> spaces;  ///< of those
  FilteredChannels filtered;              ///< what of them is filtered
  Wrap wrap = Wrap::repeat;
  std::vector<StageTime> stages;
  std::vector<std::string> warnings;

  SurfaceTextures textures() const {
    SurfaceTextures textures =
        surface_textures(set, filtered.parts.empty() ? images : filtered.parts, wrap);
    for (std::size_t i = 0; i < images.size(); ++i) {
      textures.tiles[i].space = spaces[i].space;
      textures.tiles[i].premultiplied =
          is_premultiplied(images[i]) && textures.tiles[i].image->alpha_channel >= 0;
    }
    return textures;
  }
};

/// Writing over a texture is fine (it is replaced at the end), over the mesh never.
void check_outputs(const OutputNames& outputs, const FilterInputs& inputs) {
  for (std::size_t i = 0; i < outputs.paths.size(); ++i) {
    const std::filesystem::path& output = outputs.paths[i];
    if (output.empty()) continue;
    std::error_code error;
    if (output == inputs.mesh_path ||
        std::filesystem::equivalent(output, inputs.mesh_path, error)) {
      throw UsageError("--output: " + output.string() + " is the mesh");
    }
    check_writable_image(output, inputs.images[i]);
  }
}

StageTime stage(const char* name, Stopwatch& watch) {
  return {name, watch.lap(), peak_memory_bytes()};
}

/// "1001,1003"
std::vector<int> tiles_of(const Arguments& arguments) {
  std::vector<int> tiles;
  if (!arguments.has("only")) return tiles;
  const std::string list = arguments.text("only");
  const auto count = std::size_t(std::count(list.begin(), list.end(), ',')) + 1;
  for (const double number : arguments.numbers("only", count)) {
    if (number != std::floor(number) || number < 1001 || number > 9999) {
      throw UsageError("--only: " + list + ": UDIM tiles are 1001 to 9999");
    }
    tiles.push_back(int(number));
  }
  return tiles;
}

FilterInputs read_inputs(const Arguments& arguments, Stopwatch& watch) {
  FilterInputs inputs;
  inputs.mesh_path = arguments.argument("mesh");
  inputs.wrap = wrap_of(arguments);
  TextureRequest request{{}, arguments.optional_text("material"), tiles_of(arguments)};
  // A glTF file with nothing to filter is written as it is, unless a slot was asked for.
  request.may_be_none =
      arguments.has("output") && is_gltf_name(arguments.text("output")) && !arguments.given("slot");
  if (arguments.has("texture")) {
    request.files = arguments.texts("texture");
  } else {
    request.confined_to = confining_folder(arguments);
  }
  const TextureSlot slot = slot_of(arguments);
  if (slot == TextureSlot::normal) {
    throw UsageError(
        "--slot: normal maps are not filtered yet: the mean of their codes is no normal");
  }
  ReadReport read;
  inputs.mesh = read_mesh_file(inputs.mesh_path, arguments, read);
  inputs.warnings = read.warnings;
  inputs.stages.push_back(stage("read mesh", watch));
  check_interrupted();
  inputs.set = explained_by(inputs.warnings, [&] {
    return naming(inputs.mesh_path, [&] { return choose_textures(inputs.mesh, request); });
  });
  inputs.warnings.insert(inputs.warnings.end(), inputs.set.warnings.begin(),
                         inputs.set.warnings.end());
  ColourSpaceRequest spaces = colour_space_request(
      arguments, slot, is_gltf_name(inputs.mesh_path) && !arguments.has("texture"));
  for (const SetTexture& texture : inputs.set.textures) {
    inputs.images.push_back(read_texture(texture, inputs.warnings));
    refuse_image_bombs(inputs.set, inputs.images);
    Image& image = inputs.images.back();
    spaces.role = texture.role;
    inputs.spaces.push_back(choose_colour_space(image, spaces));
    if (inputs.spaces.back().has_no_alpha) image.alpha_channel = -1;
    check_interrupted();
  }
  std::vector<std::string> names;
  for (const SetTexture& texture : inputs.set.textures) names.push_back(texture.path.string());
  inputs.filtered =
      choose_channels(slot, inputs.images, names,
                      arguments.has("layer") ? arguments.text("layer") : "", inputs.warnings);
  inputs.stages.push_back(stage("read texture", watch));
  return inputs;
}

json texture_json(const FilterInputs& inputs, std::size_t i) {
  const SetTexture& file = inputs.set.textures[i];
  const Image& image = inputs.images[i];
  return {{"path", file.path.string()},
          {"reason", inputs.set.reason},
          {"width", image.width},
          {"height", image.height},
          {"channels", image.channels},
          {"colour_space", inputs.spaces[i].name},
          {"colour_space_reason", inputs.spaces[i].reason}};
}

/// The part of the JSON report that plan and run share.
json report_start(const Arguments& arguments, const FilterInputs& inputs,
                  const OutputNames& outputs) {
  json out = new_report("filter");
  out["mesh"] = inputs.mesh_path;
  out["options"] = options_json(arguments);
  out["dry_run"] = arguments.flag("dry-run");
  out["textures"] = json::array();
  for (std::size_t i = 0; i < inputs.images.size(); ++i) {
    json one = texture_json(inputs, i);
    const SetTexture& file = inputs.set.textures[i];
    one["udim"] = file.udim > 0 ? json(file.udim) : json();
    one["material"] = text_or_null(file.material);
    one["output"] = text_or_null(outputs.paths.empty() ? "" : outputs.paths[i].string());
    out["textures"].push_back(std::move(one));
  }
  // As long as there is only one.
  out["texture"] = inputs.images.size() == 1 ? texture_json(inputs, 0) : json();
  out["output"] = text_or_null(arguments.has("output") ? arguments.text("output") : "");
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

/// A warning if there is nothing to filter in a glTF file, which is then written as it is.
std::string why_nothing(const FilterInputs& inputs, const Arguments& arguments) {
  constexpr const char* kAllStay = ": all images stay as they are";
  if (!is_gltf_name(arguments.has("output") ? arguments.text("output") : "")) return {};
  if (inputs.set.textures.empty()) {
    return inputs.mesh_path + ": no material has a base colour texture (see --slot)" + kAllStay;
  }
  for (Index f = 0; f < inputs.mesh.faces.size(); ++f) {
    const bool has_texels = inputs.set.tile_of_face[f] != kNone && inputs.mesh.has_uvs(f) &&
                            inputs.mesh.uv_area(f) != 0;
    if (has_texels) return {};
  }
  // They may all be spots in a palette.
  return inputs.mesh_path + ": the UVs of no face have any area" + kAllStay;
}

void tell_plan(const Arguments& arguments, const FilterOptions& options, FilterInputs& inputs,
               json out) {
  if (const std::string why = why_nothing(inputs, arguments); !why.empty()) {
    inputs.warnings.push_back(why);
    if (!arguments.flag("quiet")) warn(inputs.warnings);
    out["plan"] = nullptr;
    out["warnings"] = inputs.warnings;
    if (arguments.flag("json")) print_report(std::move(out));
    return;
  }
  const FilterPlan plan =
      filtering(inputs, [&] { return plan_filter(inputs.mesh, inputs.textures(), options); });
  add_warnings(plan.warnings, inputs.warnings);
  if (plan.memory_bytes > plan.memory_limit) {
    inputs.warnings.push_back("the run will be refused: it takes more memory than may be used");
  }
  if (!arguments.flag("quiet")) warn(inputs.warnings);
  if (!arguments.flag("json")) {
    print_plan(plan, inputs.images, std::cout);
    return;
  }
  out["plan"] = to_json(plan);
  out["warnings"] = inputs.warnings;
  print_report(std::move(out));
}

void write_results(const std::string& output, const OutputNames& outputs,
                   const std::vector<Image>& results, FilterInputs& inputs) {
  if (is_gltf_name(output)) {
    write_into_gltf(output, inputs.mesh_path, inputs.set, inputs.images, results, inputs.warnings);
    return;
  }
  std::vector<ImageFile> files;
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (!outputs.paths[i].empty()) files.push_back({outputs.paths[i], &results[i]});
  }
  write_images(files, {}, &inputs.warnings);
}

void filter_and_write(const Arguments& arguments, const FilterOptions& options,
                      FilterInputs& inputs, const OutputNames& outputs, json out,
                      Stopwatch& watch) {
  const bool quiet = arguments.flag("quiet");
  FilterReport report;
  std::vector<Image> results;
  if (const std::string why = why_nothing(inputs, arguments); !why.empty()) {
    inputs.warnings.push_back(why);
    results = inputs.images;
  } else {
    ProgressBar bar(quiet);
    results = filtering(inputs, [&] {
      return filter(inputs.mesh, inputs.textures(), options, &report, bar.callback());
    });
    put_together(inputs.filtered, inputs.images, results);
  }
  watch.lap();
  check_interrupted();
  add_warnings(report.warnings, inputs.warnings);
  write_results(arguments.text("output"), outputs, results, inputs);
  report.stages.insert(report.stages.begin(), inputs.stages.begin(), inputs.stages.end());
  report.stages.push_back(stage("write texture", watch));
  if (!quiet) {
    warn(inputs.warnings);
    if (report.texels > 0) print_summary(report, watch.total(), std::cerr);
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
  const FilterOptions options = filter_options(arguments);

  Stopwatch watch;
  FilterInputs inputs = read_inputs(arguments, watch);
  const bool into_gltf = is_gltf_name(output);
  const OutputNames outputs =
      output.empty() ? OutputNames{}
      : into_gltf    ? name_gltf_outputs(inputs.set, inputs.mesh, inputs.mesh_path, output)
                     : name_outputs(inputs.set, output);
  std::optional<AtomicFolder> folder;
  if (!outputs.folder.empty()) folder.emplace(outputs.folder);
  if (!into_gltf) check_outputs(outputs, inputs);
  json out = report_start(arguments, inputs, outputs);
  if (dry_run) {
    tell_plan(arguments, options, inputs, std::move(out));
    return 0;
  }
  filter_and_write(arguments, options, inputs, outputs, std::move(out), watch);
  if (folder) folder->keep();
  return 0;
}

}  // namespace onmesh::tools
