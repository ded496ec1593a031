// onmesh distance: geodesic distances from one point, per vertex and per texel.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "atlas.h"
#include "distance_compare.h"
#include "distance_request.h"
#include "format.h"
#include "interruption.h"
#include "messages.h"
#include "onmesh/base/atomic_file.h"
#include "onmesh/base/text.h"
#include "onmesh/distance/make_backend.h"
#include "onmesh/image/image_io.h"
#include "onmesh/measure/nearby_geodesics.h"
#include "onmesh/mesh_io/write_ply.h"
#include "onmesh/nodes/bridge.h"
#include "output_names.h"
#include "report.h"
#include "stopwatch.h"
#include "subcommands.h"

namespace onmesh::tools {

Command distance_command() {
  Command command;
  command.name = "distance";
  command.synopsis = "MESH (--vertex N | --uv U,V | --point X,Y,Z) [-o OUT.ply] [options]";
  command.summary =
      "Computes geodesic distances from one point of the surface. What lies beyond the radius or\n"
      "on another component (unless --bridge joins it) gets NaN. The back ends unfold, heat and\n"
      "cloud compute between the nodes of a refinement (see onmesh refine) and interpolate; exact\n"
      "follows every path on the mesh.";
  command.examples =
      "  onmesh distance cube.obj --vertex 0 -o distance.ply\n"
      "  onmesh distance cube.obj --uv 0.2,0.6 --radius 20% --compare exact\n"
      "  onmesh distance cube.obj --uv 0.2,0.6 --radius 20% --compare all --sigma 5%\n"
      "  onmesh distance cube.obj --point 0,0,1 --distance heat --texture d.exr -t cube.png\n"
      "  onmesh view cube.obj --distance-ply distance.ply -o picture.png\n";
  auto add = command.options.add_options();
  add("mesh", text());
  add("vertex", text(), "start at this vertex of the file, counted from 0");
  add("uv", text(), "start where the atlas has these UVs (the first face that has)");
  add("point", text(), "start at the surface's closest point to this one");
  add("distance", text("auto"), "auto, unfold, heat, cloud or exact");
  add("radius", text(), "largest distance: mesh units, % of the diagonal or tx (default: none)");
  add("spacing", text(),
      "distance between nodes, likewise (default: the mean edge, 1% or a fifth of the radius, "
      "whichever is least)");
  add("compare", text(),
      "exact: print the error at all nodes within the radius; all: that of every back end, side by "
      "side, and of straight lines");
  add("sigma", text(),
      "with --compare, the Gaussian that errors are put in relation to: a length (default: the "
      "radius / 2.5, as the bilateral filter has it)");
  add("bridge", text("0"),
      "length: lead on to other parts across smaller gaps than this (default: none)");
  add_weld_option(command.options);
  add_gltf_options(command.options);
  add_confine_option(command.options);
  add("output,o", text(), "PLY to write: the welded mesh with a distance per vertex");
  add("nodes-ply", text(), "PLY to write: the nodes with a distance each");
  // As with the other commands, -t is the texture that is there; --texture is the result.
  add("texture", text(),
      "EXR or TIFF to write: a distance per texel of the atlas; of several textures a folder/ or a "
      "name with <UDIM>, {stem}, ...");
  add("atlas,t", texts(),
      "a texture whose texels are meant, may be given several times (default: what the materials "
      "name)");
  add("resolution", text(), "size of the atlas instead, such as 1024x1024");
  add("material", text(), "only texels of this material's faces; all = every face with UVs");
  add_wrap_option(command.options);
  add("json", flag(), "statistics as JSON on stdout");
  add("quiet", flag(), "no summary");
  command.positional.add("mesh", 1);
  return command;
}

namespace {

/// The nodes that distances run between; empty if none are needed.
struct Nodes {
  NodeSurface surface;
  bool bisected = false;
  Index bridges = 0;
};

Nodes make_nodes(const InputMesh& input, const DistanceLengths& lengths) {
  RefineOptions options;
  options.spacing = lengths.spacing;
  options.flat_faces = lengths.bridge > 0;
  check_node_count(input.cleaned, options);
  Nodes nodes;
  RefineReport refined;
  nodes.surface =
      naming(input, [&] { return refine(input.cleaned, input.cleaning, options, &refined); });
  nodes.bisected = refined.bisected;
  if (lengths.bridge > 0) {
    nodes.bridges = add_bridges(input.cleaned, lengths.bridge, nodes.surface);
    if (nodes.bridges == 0) warn("--bridge: nothing was bridged, no gap is so narrow");
  }
  return nodes;
}

/// Everything that is told in the end.
struct DistanceResult {
  DistanceSource source;
  std::string backend;
  std::vector<double> distances;  ///< per node, or per vertex if there are no nodes
  std::size_t reached = 0;        ///< vertices
  double farthest = 0;
  std::optional<DistanceError> error;  ///< of the distances
  std::vector<ComparedBackend> compared;
  nlohmann::json seconds;  ///< of the steps
};

/// Distances at the nodes, which start with the mesh's vertices, or at the vertices alone.
std::vector<double> exact_distances(const TriangleMesh& mesh, const NodeSurface& surface,
                                    const DistanceSource& source, double radius) {
  const std::vector<SurfacePoint>& nodes = surface.nodes.nodes;
  return NearbyGeodesics(mesh, radius)
      .distances(source.point, nodes.empty() ? make_node_mesh(mesh).nodes : nodes);
}

/// Sets what the request wants to know about errors.
void compare(const DistanceRequest& request, const TriangleMesh& mesh, const NodeSurface& surface,
             const DistanceLengths& lengths, DistanceResult& result) {
  const std::vector<double> truth =
      request.exact() ? result.distances
                      : exact_distances(mesh, surface, result.source, lengths.radius);
  if (!request.exact()) result.error = distance_error(truth, result.distances, lengths.sigma);
  if (request.compare_all) {
    result.compared =
        compare_backends(mesh, surface, result.source, truth, lengths.radius, lengths.sigma);
  }
}

/// \param names where the tiles' images go
void write_textures(const OutputNames& names, const std::vector<Image>& images) {
  check_interrupted();
  std::vector<ImageFile> files;
  for (std::size_t i = 0; i < images.size(); ++i) files.push_back({names.paths[i], &images[i]});
  std::vector<std::string> warnings;
  write_images(files, {}, &warnings);
  warn(warnings);
}

void write_vertices(const std::string& path, const InputMesh& input,
                    const std::vector<double>& at_cleaned) {
  std::vector<PlyColumn> columns{{"x", {}}, {"y", {}}, {"z", {}}, {"distance", {}}};
  for (const Vec3& p : input.welded.positions) {
    for (std::size_t k = 0; k < 3; ++k) columns[k].values.push_back(p[Eigen::Index(k)]);
  }
  columns[3].values = at_welded_vertices(input, at_cleaned);
  write_ply(path, columns, input.welded.faces, {"geodesic distances by onmesh"});
}

void write_nodes(const std::string& path, const TriangleMesh& mesh, const NodeMesh& nodes,
                 const std::vector<double>& distances) {
  std::vector<PlyColumn> columns{{"x", {}}, {"y", {}}, {"z", {}}, {"distance", distances}};
  for (const SurfacePoint& node : nodes.nodes) {
    const Vec3 p = mesh.position(node);
    for (std::size_t k = 0; k < 3; ++k) columns[k].values.push_back(p[Eigen::Index(k)]);
  }
  write_ply(path, columns, nodes.faces, {"nodes with geodesic distances by onmesh"});
}

void write_plys(const Arguments& arguments, const InputMesh& input, const NodeSurface& surface,
                const std::vector<double>& distances) {
  if (arguments.has("nodes-ply"))
    write_nodes(arguments.text("nodes-ply"), input.cleaned, surface.nodes, distances);
  if (arguments.has("output")) write_vertices(arguments.text("output"), input, distances);
}

void count_reached(std::size_t vertices, DistanceResult& result) {
  for (std::size_t i = 0; i < result.distances.size(); ++i) {
    if (std::isnan(result.distances[i])) continue;
    result.reached += i < vertices;
    result.farthest = std::max(result.farthest, result.distances[i]);
  }
}

nlohmann::json source_json(const DistanceSource& source, const TriangleMesh& mesh) {
  const Vec3 p = mesh.position(source.point), b = source.point.barycentric;
  nlohmann::json json;
  json["position"] = {p.x(), p.y(), p.z()};
  json["barycentric"] = {b.x(), b.y(), b.z()};
  json["off_surface"] = source.off_surface;
  return json;
}

void print_json(const DistanceRequest& request, const InputMesh& input, const Nodes& nodes,
                const DistanceLengths& lengths, const DistanceResult& result) {
  const auto if_nodes = [&](const nlohmann::json& value) {
    return request.needs_nodes ? value : nlohmann::json();
  };
  nlohmann::json json = new_report("distance");
  json["mesh"] = input.path;
  json["source"] = source_json(result.source, input.cleaned);
  json["source"]["face"] = input.cleaning.kept[result.source.point.face];
  json["distance"] = name_of(request.method);
  json["backend"] = result.backend;
  json["radius"] = lengths.radius;
  json["spacing"] = if_nodes(lengths.spacing);
  json["nodes"] = nodes.surface.nodes.nodes.size();
  json["refinement"] = if_nodes(nodes.bisected ? "bisection" : "intrinsic");
  json["bridges"] = nodes.bridges;
  json["vertices"] = input.cleaned.positions.size();
  json["vertices_reached"] = result.reached;
  json["farthest"] = result.farthest;
  json["compare"] = result.error ? to_json(*result.error, lengths.sigma) : nlohmann::json();
  json["compare_all"] =
      request.compare_all ? to_json(result.compared, lengths.sigma) : nlohmann::json();
  json["seconds"] = result.seconds;
  print_report(std::move(json));
}

void print_summary(const DistanceRequest& request, const InputMesh& input, const Nodes& nodes,
                   const DistanceLengths& lengths, const DistanceResult& result) {
  const Vec3 p = input.cleaned.position(result.source.point);
  std::cerr << input.path << ": distances from (" << format_number(p.x()) << ", "
            << format_number(p.y()) << ", " << format_number(p.z()) << ") by " << result.backend;
  if (request.needs_nodes)
    std::cerr << " between " << format_count(nodes.surface.nodes.nodes.size()) << " nodes, spacing "
              << format_number(lengths.spacing) << (nodes.bisected ? ", by bisection" : "");
  if (nodes.bridges > 0) std::cerr << " and " << format_count(nodes.bridges) << " bridges";
  std::cerr << ": " << format_count(result.reached) << " of "
            << format_count(input.cleaned.positions.size()) << " vertices reached, farthest "
            << format_number(result.farthest) << '\n';
  if (result.source.off_surface > 0)
    std::cerr << "the point asked for is " << format_number(result.source.off_surface)
              << " away from the surface\n";
}

void print_errors(const DistanceRequest& request, const DistanceLengths& lengths,
                  const DistanceResult& result) {
  const ErrorScale scale{lengths.sigma, (request.sigma ? "sigma = " : "sigma = radius / 2.5 = ") +
                                            format_number(lengths.sigma)};
  if (request.compare_all) {
    print_table(result.compared, scale);
  } else if (result.error) {
    print_error(*result.error, result.backend, scale);
  }
}

}  // namespace

int run_distance(const Arguments& arguments) {
  const std::string path = arguments.argument("mesh");
  const DistanceRequest request = read_distance_request(arguments);
  const InputMesh input = read_input_mesh(path, arguments);
  warn(input.read.warnings);
  const TriangleMesh& mesh = input.cleaned;
  if ((request.exact() || request.compare) && !input.cleaning.manifold())
    throw InputError(path + ": exact distances need a manifold mesh: " + input.cleaning.defects());
  DistanceResult result;
  result.source = find_source(arguments, input);
  check_interrupted();

  std::optional<TexelMap> map;
  OutputNames textures;
  std::optional<AtomicFolder> folder;
  if (request.needs_atlas) {
    const Atlas atlas = read_atlas(arguments, mesh, "atlas");
    warn(atlas.set.warnings);
    warn(atlas.warnings);
    map = covered_map(input, atlas);
    if (arguments.has("texture")) {
      textures = name_outputs(atlas.set, arguments.text("texture"), ".exr");
      if (!textures.folder.empty()) folder.emplace(textures.folder);
      for (const std::filesystem::path& file : textures.paths) check_distance_texture(file);
    }
  }
  const DistanceLengths lengths =
      resolve_lengths(request, mesh, map ? map->median_texel_size() : 0);
  check_interrupted();

  Stopwatch watch;
  Nodes nodes;
  if (request.needs_nodes) {
    nodes = make_nodes(input, lengths);
    result.seconds["refine"] = watch.lap();
    check_interrupted();
  }
  const NodeSurface& surface = nodes.surface;
  result.distances = naming(input, [&] {
    return request.exact()
               ? exact_distances(mesh, surface, result.source, lengths.radius)
               : node_distances(mesh, surface, result.source, request.method, lengths.radius);
  });
  result.seconds["distance"] = watch.lap();
  check_interrupted();
  if (request.compare) {
    compare(request, mesh, surface, lengths, result);
    result.seconds["compare"] = watch.lap();
  }
  check_interrupted();
  if (arguments.has("texture")) {
    write_textures(textures,
                   request.exact()
                       ? exact_distance_texture(mesh, *map, result.source, lengths.radius)
                       : distance_texture(*map, surface, result.distances, lengths.radius));
    if (folder) folder->keep();
    result.seconds["texture"] = watch.lap();
  }
  forget_beyond(lengths.radius, result.distances);
  write_plys(arguments, input, surface, result.distances);
  count_reached(mesh.positions.size(), result);
  result.backend =
      request.exact() ? "exact" : make_backend(request.method, mesh, surface.nodes)->name();

  if (arguments.flag("json")) {
    print_json(request, input, nodes, lengths, result);
    return 0;
  }
  if (!arguments.flag("quiet")) print_summary(request, input, nodes, lengths, result);
  print_errors(request, lengths, result);
  return 0;
}

}  // namespace onmesh::tools
