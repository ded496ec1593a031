// onmesh fill: values for texels that have none, from the surface around them.
#include "onmesh/filter/fill.h"

#include <cstdint>
#include <iostream>
#include <nlohmann/json.hpp>
#include <utility>

#include "destination.h"
#include "filter_report.h"
#include "format.h"
#include "onmesh/mesh_io/write_gltf.h"
#include "report.h"
#include "shared_options.h"
#include "stopwatch.h"
#include "subcommands.h"
#include "surface_inputs.h"

namespace onmesh::tools {

Command fill_command() {
  Command command;
  command.name = "fill";
  command.synopsis = "MESH [-t TEXTURE]... -o OUT [options]";
  command.summary =
      "Fills texels that have no value from the surface around them: faces that no photo saw, "
      "texels\n"
      "that a bake left out. They get the smoothest surface that the texels around the hole span,\n"
      "over seams and however large the hole is. Missing is what is not finite, what is 0 in\n"
      "--mask-samples, and with --missing alpha what has alpha 0. All other texels stay as they "
      "are.";
  command.examples =
      "  onmesh fill scan.obj -t photo.png -o filled.png --missing alpha\n"
      "  onmesh fill room.obj -t lightmap.exr -o filled.exr --mask-samples valid.png\n"
      "  onmesh fill figure.obj -t 'skin.<UDIM>.exr' -o 'filled.<UDIM>.exr'\n";
  auto add = command.options.add_options();
  add("mesh", text());
  add("output,o", text(),
      "what to write: an image (may be the input texture itself), the glTF file with its images "
      "replaced, a folder/ for results under their own names, or a name with <UDIM>, <UVTILE>, "
      "{stem}, {material} or {ext}");
  add("missing", text("nan"),
      "what has no value: nan (what is not finite), or alpha (that, and what has alpha 0; alpha is "
      "filled, too)");
  add_surface_options(command.options);
  add("gutter", text("2"), "rings of texels to fill around charts; 0: none");
  add("threads", text("0"), "0 = all processors");
  add("max-memory", text(),
      "refuse what would take more, such as 8G (default: what there is and what is left)");
  add("json", flag(), "print a report as JSON on stdout");
  add("quiet", flag(), "no progress, summary or warnings");
  command.positional.add("mesh", 1);
  return command;
}

namespace {

using nlohmann::json;

FillOptions fill_options(const Arguments& arguments) {
  FillOptions options;
  options.clear_is_missing = arguments.choice<bool>("missing", {{"nan", false}, {"alpha", true}});
  options.gutter = int(arguments.integer("gutter", 0, 32768));
  options.weld = weld_of(arguments);
  options.threads = int(arguments.integer("threads", 0, 1024));
  if (arguments.has("max-memory")) options.max_memory = arguments.bytes("max-memory");
  return options;
}

/// Of several maps.
void add(const FillReport& more, FillReport& report) {
  report.texels += more.texels;
  report.missing += more.missing;
  report.left += more.left;
  report.gutter += more.gutter;
  report.stages.insert(report.stages.end(), more.stages.begin(), more.stages.end());
  report.warnings.insert(report.warnings.end(), more.warnings.begin(), more.warnings.end());
}

void print_summary(const FillReport& report, double seconds) {
  std::cerr << format_count(report.missing - report.left) << " of " << format_count(report.texels)
            << " texels on the surface filled in " << format_seconds(seconds) << '\n';
}

}  // namespace

int run_fill(const Arguments& arguments) {
  arguments.argument("mesh");
  const std::string output = arguments.text("output");
  const FillOptions options = fill_options(arguments);
  const bool quiet = arguments.flag("quiet");

  Stopwatch watch;
  SurfaceInputs inputs = read_surface(arguments, watch);
  Destination to(arguments, output, inputs);
  json out = start_report("fill", arguments, inputs, to);
  FillReport report;
  make_and_write(inputs, to, quiet, watch, report, [&](const Progress& progress) {
    std::vector<std::vector<Image>> results;
    for (std::size_t m = 0; m < inputs.maps.size(); ++m) {
      if (!inputs.maps[m].is_filtered) continue;
      FillReport own;
      results.push_back(
          fill(inputs.mesh_of(inputs.maps[m]), inputs.textures(m), options, &own, progress));
      add(own, report);
    }
    return results;
  });
  if (!quiet) print_summary(report, watch.total());
  if (arguments.flag("json")) {
    out["counts"] = {{"texels", report.texels},
                     {"missing", report.missing},
                     {"left", report.left},
                     {"gutter_texels", report.gutter}};
    out["stages"] = stages_json(report.stages);
    out["warnings"] = inputs.warnings;
    out["seconds"] = watch.total();
    print_report(std::move(out));
  }
  return 0;
}

}  // namespace onmesh::tools
