// onmesh refine: the nodes that distances are computed between, as PLY with statistics.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

#include "format.h"
#include "inputs.h"
#include "interruption.h"
#include "messages.h"
#include "onmesh/mesh_io/write_ply.h"
#include "onmesh/nodes/refine.h"
#include "report.h"
#include "shared_options.h"
#include "subcommands.h"

namespace onmesh::tools {

Command refine_command() {
  Command command;
  command.name = "refine";
  command.synopsis = "MESH [-o NODES.ply] [options]";
  command.summary =
      "Refines the mesh's intrinsic triangulation: Delaunay flips, then circumcentres until every "
      "face is\n"
      "small and round enough. A mesh that is not manifold is cut into manifold pieces, "
      "which\n"
      "are put together again; faces so thin that this fails are bisected. The input's vertices "
      "stay;\n"
      "the surface does not change at all.";
  command.examples =
      "  onmesh refine cube.obj --spacing 0.1 -o nodes.ply\n"
      "  onmesh refine scan.obj --spacing 1% --json\n";
  auto add = command.options.add_options();
  add("mesh", text());
  add("output,o", text(), "PLY to write: nodes with x y z u v and their triangles");
  add("spacing", text("2%"), "distance between nodes, mesh units or % of the diagonal");
  add("finest", text(), "spacing at cones, creases and reflex corners (default: a quarter)");
  add("growth", text("0.25"), "growth of the spacing away from them, per unit of distance");
  add("min-angle", text("25"), "smallest angle to leave, degrees, 0 to 30");
  add_weld_option(command.options);
  add_confine_option(command.options);
  add("json", flag(), "statistics as JSON on stdout");
  add("quiet", flag(), "no summary");
  command.positional.add("mesh", 1);
  return command;
}

namespace {

double length_of(const Arguments& arguments, const std::string& name, double diagonal) {
  const Length length = arguments.length(name);
  if (length.unit == Length::Unit::texel) {
    throw UsageError("--" + name + ": refine knows no texture; use mesh units or %");
  }
  return resolve(length, 0, diagonal);
}

RefineOptions refine_options(const Arguments& arguments) {
  RefineOptions options;
  options.growth = arguments.number("growth", 1e-6, 100);
  options.min_angle_degrees = arguments.number("min-angle", 0, 30);
  return options;
}

void set_lengths(const Arguments& arguments, double diagonal, RefineOptions& options) {
  options.spacing = length_of(arguments, "spacing", diagonal);
  if (!arguments.has("finest")) return;
  options.finest = length_of(arguments, "finest", diagonal);
  if (options.finest > options.spacing) {
    throw UsageError("--finest: must not be larger than --spacing");
  }
}

void write_nodes(const std::string& path, const TriangleMesh& mesh, const NodeMesh& nodes) {
  std::vector<PlyColumn> columns{{"x", {}}, {"y", {}}, {"z", {}}, {"u", {}}, {"v", {}}};
  for (PlyColumn& column : columns) column.values.reserve(nodes.nodes.size());
  for (const SurfacePoint& node : nodes.nodes) {
    const Vec3 p = mesh.position(node);
    const Vec2 uv = mesh.has_uvs(node.face) ? mesh.uv(node) : Vec2::Zero();
    const double row[] = {p.x(), p.y(), p.z(), uv.x(), uv.y()};
    for (std::size_t k = 0; k < columns.size(); ++k) columns[k].values.push_back(row[k]);
  }
  write_ply(path, columns, nodes.faces, {"nodes of a refined triangulation by onmesh"});
}

/// What the refinement comes to.
struct Statistics {
  double area = 0, mean_edge = 0, longest_edge = 0;
};

Statistics statistics(const NodeMesh& nodes) {
  Statistics found;
  double edges = 0;
  for (Index f = 0; f < nodes.faces.size(); ++f) {
    found.area += nodes.face_area(f);
    for (const double l : nodes.lengths[f]) edges += l / 3;
  }
  found.mean_edge = edges / double(std::max<std::size_t>(1, nodes.faces.size()));
  found.longest_edge = nodes.longest_edge();
  return found;
}

void print_json(const std::string& path, const RefineOptions& options, const RefineReport& report,
                const Statistics& found) {
  nlohmann::json json = new_report("refine");
  json.update({{"mesh", path},
               {"spacing", options.spacing},
               {"input_vertices", report.input_vertices},
               {"nodes", report.nodes},
               {"faces", report.faces},
               {"refinement", report.bisected ? "bisection" : "intrinsic"},
               {"flips", report.flips},
               {"insertions", report.insertions},
               {"smallest_angle_degrees", report.smallest_angle_degrees},
               {"mean_edge", found.mean_edge},
               {"longest_edge", found.longest_edge},
               {"area", found.area}});
  print_report(std::move(json));
}

}  // namespace

int run_refine(const Arguments& arguments) {
  const std::string path = arguments.argument("mesh");
  if (arguments.has("output")) check_writable_file(arguments.text("output"));
  RefineOptions options = refine_options(arguments);

  const InputMesh input = read_input_mesh(path, arguments);
  const TriangleMesh& mesh = input.cleaned;
  warn(input.read.warnings);
  set_lengths(arguments, mesh.diagonal(), options);
  check_node_count(mesh, options);
  check_interrupted();
  RefineReport report;
  const NodeSurface surface =
      naming(input, [&] { return refine(mesh, input.cleaning, options, &report); });
  check_interrupted();
  if (arguments.has("output")) write_nodes(arguments.text("output"), mesh, surface.nodes);

  const Statistics found = statistics(surface.nodes);
  if (arguments.flag("json")) {
    print_json(path, options, report, found);
  } else if (!arguments.flag("quiet")) {
    std::cerr << path << ": " << format_count(report.input_vertices) << " vertices refined to "
              << format_count(report.nodes) << " nodes, " << format_count(report.faces)
              << " faces (spacing " << options.spacing << ", mean edge " << found.mean_edge
              << ", smallest angle " << report.smallest_angle_degrees << " degrees, "
              << format_count(report.flips) << " flips" << (report.bisected ? ", by bisection" : "")
              << ")\n";
  }
  return 0;
}

}  // namespace onmesh::tools
