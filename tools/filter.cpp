// onmesh filter: the main job. Reads mesh and textures, filters, writes the textures.

#include <cstdint>
#include <iostream>
#include <nlohmann/json.hpp>
#include <utility>

#include "colour_spaces.h"
#include "destination.h"
#include "filter_options.h"
#include "filter_report.h"
#include "messages.h"
#include "onmesh/filter/map_set.h"
#include "presets.h"
#include "report.h"
#include "shared_options.h"
#include "stopwatch.h"
#include "subcommands.h"
#include "surface_inputs.h"
#include "viewer/filter_page.h"
#include "viewer/page_writer.h"

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
      "  onmesh filter scene.glb --uv-set 1 -t lightmap.exr -o clean.exr --preset lightmap\n"
      "  onmesh filter model.obj -t ao.png -o ao_clean.png --preset ao\n"
      "  onmesh filter model.obj -t albedo=a.png -t rough=r.png@data -o 'out/{map}.{ext}' \\\n"
      "    --guide albedo:0.1\n"
      "  onmesh filter model.obj -o smooth.png --report page.html\n"
      "  onmesh filter model.obj -o smooth.png --dry-run\n";
  auto add = command.options.add_options();
  add("mesh", text());
  add("output,o", text(),
      "what to write: an image (may be the input texture itself), the glTF file with its images "
      "replaced, a folder/ for results under their "
      "own names, or a name with <UDIM>, <UVTILE>, {stem}, {material} or {ext}");
  add_surface_options(command.options);
  add("mask", text(),
      "an image of any size, also with <UDIM>, {stem} or {material} in its name: how much of the "
      "result is taken, from black (none) to white (all)");
  add("strength", text("1"), "how much of the result is taken everywhere, from 0 to 1");
  add("alpha", flag(), "filter alpha as well (default: it stays)");
  add("detail-out", text(),
      "write what the filter took away, too: the texture minus the output, in codes from 0 to 1, "
      "as an EXR or TIFF of 32-bit float; named as --output may be");
  add("detail-gain", text("0"),
      "add what was taken away again, so many times: 1 changes nothing, 2 sharpens");
  add("stop-at", text("none"), "none, or material: colour does not flow across materials");
  add("kind", text("bilateral"), "bilateral (keeps edges) or gaussian (blurs)");
  add("sigma-spatial", text("4tx"), "length: width of the filter on the surface");
  add("sigma-range", text("0.1"),
      "bilateral: width of the filter in colour differences; values run from 0 to 1 (or 25/255); "
      "2n = twice the noise (by its median, 2m by its mean, 9n^2 = 9 times its square)");
  add_range_space_option(command.options);
  add("guide", texts(),
      "NAME[@ROLE][@uvN][:blur=LENGTH]:S, may be given several times: compare this instead of "
      "values, S as --sigma-range (median=LENGTH for a median instead of a blur). NAME is self "
      "(values, blurred perhaps), surface-normal, "
      "surface-position (S is a length), a map given by -t MAP=FILE, or an image; none = blur. "
      "Roles of images: @data, @colour, @normal-gl, @normal-dx, @object-normal");
  add("despike", text(),
      "K: take down values K times as bright as (numbers: K times as far off as) four in five of "
      "those within three texels, before all else");
  add("despike-to", text("median"),
      "median or limit: what colours that are spikes come down to: the median around them, or what "
      "they may be at most");
  add("keep-mean", flag(), "scale results to the mean over the surface of what was summed");
  add("iterations", text("1"), "how often: each time of the last result");
  add("guides-from", text("input"),
      "input or result: whether iterations compare what was read or the last result");
  std::string names;
  for (const Preset& preset : presets())
    names += std::string(names.empty() ? "" : "; ") + preset.name + " (" + preset.purpose +
             "): " + text_of(preset);
  add("preset", text(), ("options under one name; those given explicitly win. " + names).c_str());
  add("radius", text(),
      "length: how far samples count (default: 2.5 sigma bilateral, 3 sigma gaussian)");
  add("distance", text("auto"), "how distances are computed: auto, unfold, heat, cloud or exact");
  add("bridge", text("0"),
      "length: lead on across smaller gaps than this, between parts of the mesh and within them "
      "(default: none; parts do not influence each other)");
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
  add("overlap", text("average"), "texels used by several faces: average, first or error");
  add("gutter", text("2"),
      "rings of texels to fill around charts; 0: only texels whose centre is on a chart change");
  add("threads", text("0"), "0 = all processors");
  add("max-memory", text(),
      "refuse what would take more, such as 8G (default: what there is and what is left)");
  add("dry-run", flag(), "check everything, tell what would be done, write nothing");
  add("report", text(),
      "write a page (.html) to look at in a browser, too: the model before and after, its seams "
      "and "
      "differences, and the numbers of the run");
  add("json", flag(), "print a report as JSON on stdout");
  add("quiet", flag(), "no progress, summary or warnings");
  command.positional.add("mesh", 1);
  return command;
}

namespace {

using nlohmann::json;

void check_page_name(const std::string& path) {
  if (!is_page_name(path)) throw UsageError("--report: " + path + ": a page ends in .html");
  check_writable_file(path);
}

void tell_plan(const Arguments& arguments, const FilterOptions& options, SurfaceInputs& inputs,
               const Destination& to, json out) {
  if (const std::string why = why_nothing(inputs, to.is_gltf()); !why.empty()) {
    inputs.warnings.push_back(why);
    if (!arguments.flag("quiet")) warn(inputs.warnings);
    out["plan"] = nullptr;
    out["warnings"] = inputs.warnings;
    if (arguments.flag("json")) print_report(std::move(out));
    return;
  }
  const FilterPlan plan = working_on(inputs, [&] {
    return plan_maps(inputs.mesh, library_maps(inputs), with_guides(options, inputs));
  });
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

void filter_and_write(const Arguments& arguments, const FilterOptions& options,
                      SurfaceInputs& inputs, Destination& to, json out, Stopwatch& watch) {
  const bool quiet = arguments.flag("quiet");
  FilterReport report;
  std::vector<Image> results =
      make_and_write(inputs, to, quiet, watch, report, [&](const Progress& progress) {
        return filter_maps(inputs.mesh, library_maps(inputs), with_guides(options, inputs), &report,
                           progress);
      });
  if (arguments.has("report")) {
    write_filter_page(arguments.text("report"), arguments, inputs, to, std::move(results), report,
                      watch.total());
  }
  if (!quiet && report.texels > 0) print_summary(report, watch.total(), std::cerr);
  if (arguments.flag("json")) {
    out.update(to_json(report));
    out["warnings"] = inputs.warnings;
    out["seconds"] = watch.total();
    print_report(std::move(out));
  }
}

}  // namespace

int run_filter(const Arguments& given) {
  Arguments arguments = given;
  const Preset* const preset = apply_preset(arguments);
  arguments.argument("mesh");
  const bool dry_run = arguments.flag("dry-run");
  const std::string output = dry_run && !arguments.has("output") ? "" : arguments.text("output");
  const FilterOptions options = filter_options(arguments);

  if (arguments.has("report") && !dry_run) check_page_name(arguments.text("report"));

  Stopwatch watch;
  SurfaceInputs inputs = read_surface(arguments, watch);
  Destination to(arguments, output, inputs);
  json out = start_report("filter", arguments, inputs, to);
  out["dry_run"] = dry_run;
  if (preset != nullptr && dry_run && !arguments.flag("json"))
    std::cout << "preset        " << preset->name << ": " << text_of(*preset) << '\n';
  if (dry_run) {
    tell_plan(arguments, options, inputs, to, std::move(out));
    return 0;
  }
  filter_and_write(arguments, options, inputs, to, std::move(out), watch);
  return 0;
}

}  // namespace onmesh::tools
