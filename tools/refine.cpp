// onmesh refine: the nodes that distances are computed between, as PLY with statistics.
#include "onmesh/nodes/refine.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

#include "command.h"
#include "inputs.h"
#include "onmesh/filter/length.h"
#include "onmesh/mesh_io/read_mesh.h"
#include "onmesh/mesh_io/write_ply.h"

namespace onmesh::tools {
namespace {

Command make_command() {
  Command command;
  command.name = "refine";
  command.synopsis = "MESH [-o NODES.ply] [options]";
  command.summary =
      "Refines the mesh's intrinsic triangulation: Delaunay flips, then circumcentres until every "
      "face is\n"
      "small and round enough. A mesh that is not manifold is cut into manifold pieces, "
      "which\n"
      "are put together again. The input's vertices stay; the surface does not change at all.";
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
  add("json", flag(), "statistics as JSON on stdout");
  add("quiet", flag(), "no summary");
  command.positional.add("mesh", 1);
  return command;
}

double length_of(const po::variables_map& values, const std::string& name, double diagonal) {
  const Length length = parse_length("--" + name, text_of(values, name));
  if (length.unit == Length::Unit::texel) {
    throw UsageError("--" + name + ": refine knows no texture; use mesh units or %");
  }
  return resolve(length, 0, diagonal);
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

}  // namespace

int run_refine(const std::vector<std::string>& arguments) {
  const Command command = make_command();
  po::variables_map values;
  if (!parse(command, arguments, values)) return 0;
  const std::string path = argument_of(command, values, "mesh");
  if (has(values, "output")) check_writable_file(text_of(values, "output"));
  RefineOptions options;
  options.growth = number_of(values, "growth", 0, 100);
  options.min_angle_degrees = number_of(values, "min-angle", 0, 30);

  std::vector<std::string> warnings;
  const TriangleMesh read = weld(read_mesh(path, &warnings));
  CleanReport cleaning;
  const TriangleMesh mesh = clean(read, &cleaning);
  warn(warnings);
  options.spacing = length_of(values, "spacing", mesh.diagonal());
  if (has(values, "finest")) {
    options.finest = length_of(values, "finest", mesh.diagonal());
    if (options.finest > options.spacing) {
      throw UsageError("--finest: must not be larger than --spacing");
    }
  }
  check_interrupted();
  RefineReport report;
  const NodeSurface surface =
      naming(path, [&] { return refine(mesh, cleaning, options, &report); });
  check_interrupted();
  if (has(values, "output")) write_nodes(text_of(values, "output"), mesh, surface.nodes);

  double area = 0, edges = 0;
  for (Index f = 0; f < surface.nodes.faces.size(); ++f) {
    area += surface.nodes.face_area(f);
    for (const double l : surface.nodes.lengths[f]) edges += l / 3;
  }
  const double mean_edge = edges / double(std::max<std::size_t>(1, surface.nodes.faces.size()));
  if (flag_of(values, "json")) {
    nlohmann::json json = new_report("refine");
    json["mesh"] = path;
    json["spacing"] = options.spacing;
    json["input_vertices"] = report.input_vertices;
    json["nodes"] = report.nodes;
    json["faces"] = report.faces;
    json["refinement"] = "intrinsic";
    json["flips"] = report.flips;
    json["insertions"] = report.insertions;
    json["smallest_angle_degrees"] = report.smallest_angle_degrees;
    json["mean_edge"] = mean_edge;
    json["longest_edge"] = surface.nodes.longest_edge();
    json["area"] = area;
    print_report(json);
  } else if (!flag_of(values, "quiet")) {
    std::cerr << path << ": " << format_count(report.input_vertices) << " vertices refined to "
              << format_count(report.nodes) << " nodes, " << format_count(report.faces)
              << " faces (spacing " << options.spacing << ", mean edge " << mean_edge
              << ", smallest angle " << report.smallest_angle_degrees << " degrees, "
              << format_count(report.flips) << " flips)\n";
  }
  return 0;
}

}  // namespace onmesh::tools
