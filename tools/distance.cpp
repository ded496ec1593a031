// onmesh distance: geodesic distances from one point, per vertex and per texel.
#include "onmesh/distance/backend.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <limits>
#include <nlohmann/json.hpp>

#include "command.h"
#include "distance_compare.h"
#include "inputs.h"
#include "onmesh/distance/make_backend.h"
#include "onmesh/filter/length.h"
#include "onmesh/mesh_io/write_ply.h"
#include "onmesh/nodes/bridge.h"

namespace onmesh::tools {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Command make_command() {
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
  add("output,o", text(), "PLY to write: the welded mesh with a distance per vertex");
  add("nodes-ply", text(), "PLY to write: the nodes with a distance each");
  // As with the other commands, -t is the texture that is there; --texture is the result.
  add("texture", text(), "EXR or TIFF to write: a distance per texel of the atlas");
  add("atlas,t", text(), "the texture whose texels are meant (default: what the materials name)");
  add("resolution", text(), "size of the atlas instead, such as 1024x1024");
  add("material", text(), "only texels of this material's faces; all = every face with UVs");
  add("wrap", text("repeat"), "what UVs outside [0,1] mean: repeat or clamp");
  add("json", flag(), "statistics as JSON on stdout");
  add("quiet", flag(), "no summary");
  command.positional.add("mesh", 1);
  return command;
}

std::vector<double> parse_numbers(const po::variables_map& values, const std::string& name,
                                  std::size_t count) {
  const std::string whole = text_of(values, name);
  std::vector<double> numbers;
  std::size_t begin = 0;
  for (std::size_t comma = 0; comma != std::string::npos; begin = comma + 1) {
    comma = whole.find(',', begin);
    numbers.push_back(parse_number(name, whole.substr(begin, comma - begin)));
  }
  if (numbers.size() != count)
    throw UsageError("--" + name + ": '" + whole + "' is not " + std::to_string(count) +
                     " numbers with commas between them");
  return numbers;
}

// What was asked for, checked as far as that goes without the mesh.
struct Request {
  DistanceMethod method = DistanceMethod::automatic;
  std::optional<Length> radius, spacing, sigma, bridge;
  bool compare = false, compare_all = false, needs_nodes = false, needs_atlas = false;
};

Request read_request(const po::variables_map& values) {
  if (has(values, "vertex") + has(values, "uv") + has(values, "point") != 1)
    throw UsageError("give one of --vertex, --uv and --point");
  Request request;
  try {
    request.method = distance_method(text_of(values, "distance"));
  } catch (const UsageError& error) {
    throw UsageError(std::string("--distance: ") + error.what());
  }
  const bool exact = request.method == DistanceMethod::exact;
  if (has(values, "compare")) {
    const std::string with = text_of(values, "compare");
    if (with != "exact" && with != "all")
      throw UsageError("--compare: '" + with + "' is neither exact nor all");
    request.compare_all = with == "all";
    if (exact && !request.compare_all)
      throw UsageError("--compare exact needs another back end than --distance exact");
    request.compare = true;
  }
  request.bridge = bridge_of(values);
  if (request.bridge) {
    if (request.compare)
      throw UsageError("--bridge: exact distances know none, so not with --compare");
    if (exact)
      throw UsageError("--bridge: exact distances know none, so not with --distance exact");
    request.needs_atlas |= request.bridge->unit == Length::Unit::texel;
  }
  request.needs_nodes = !exact || request.compare || has(values, "nodes-ply");
  const std::pair<const char*, std::optional<Length>*> lengths[] = {
      {"radius", &request.radius}, {"spacing", &request.spacing}, {"sigma", &request.sigma}};
  for (const auto& [name, length] : lengths) {
    if (!has(values, name)) continue;
    *length = parse_length(std::string("--") + name, text_of(values, name));
    request.needs_atlas |= (*length)->unit == Length::Unit::texel;
  }
  if (request.spacing && !request.needs_nodes)
    throw UsageError("--spacing: --distance exact needs no nodes, unless --nodes-ply writes them");
  if (request.sigma && !request.compare) throw UsageError("--sigma is of use only with --compare");
  request.needs_atlas |= has(values, "texture");
  const bool has_size = has(values, "atlas") || has(values, "resolution");
  if (has_size && !request.needs_atlas)
    throw UsageError(std::string(has(values, "atlas") ? "-t" : "--resolution") +
                     " is of use only with --texture or lengths in tx");
  for (const char* name : {"output", "nodes-ply"}) {
    if (has(values, name)) check_writable_file(text_of(values, name));
  }
  if (has(values, "texture")) {
    const std::string path = text_of(values, "texture");
    const std::string extension = lower_extension(path);
    if (extension != ".exr" && extension != ".tif" && extension != ".tiff")
      throw UsageError("--texture: " + path +
                       " must end in .exr or .tif, other formats hold no distances");
    check_writable_image(path, make_image(1, 1, 1));
  }
  wrap_of(values);
  return request;
}

DistanceSource find_source(const po::variables_map& values, const InputMesh& input) {
  if (has(values, "vertex")) {
    return source_at_vertex(input, integer_of(values, "vertex", 0, INT64_MAX));
  }
  if (has(values, "uv")) {
    const auto uv = parse_numbers(values, "uv", 2);
    return source_at_uv(input.cleaned, {uv[0], uv[1]});
  }
  const auto p = parse_numbers(values, "point", 3);
  return naming(input.path, [&] { return source_at_point(input.cleaned, {p[0], p[1], p[2]}); });
}

void write_vertices(const std::string& path, const InputMesh& input,
                    const std::vector<double>& at_cleaned) {
  std::vector<PlyColumn> columns{{"x", {}}, {"y", {}}, {"z", {}}, {"distance", {}}};
  for (const Vec3& p : input.welded.positions) {
    for (std::size_t k = 0; k < 3; ++k) columns[k].values.push_back(p[Eigen::Index(k)]);
  }
  columns[3].values.assign(input.welded.positions.size(), std::numeric_limits<double>::quiet_NaN());
  const std::vector<Index> welded = welded_vertices(input);
  for (Index v = 0; v < welded.size(); ++v) columns[3].values[welded[v]] = at_cleaned[v];
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

class Stopwatch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(now - std::exchange(last_, now)).count();
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

nlohmann::json to_json(const DistanceSource& source, const TriangleMesh& mesh) {
  const Vec3 p = mesh.position(source.point), b = source.point.barycentric;
  nlohmann::json json;
  json["position"] = {p.x(), p.y(), p.z()};
  json["barycentric"] = {b.x(), b.y(), b.z()};
  json["off_surface"] = source.off_surface;
  return json;
}

}  // namespace

int run_distance(const std::vector<std::string>& arguments) {
  const Command command = make_command();
  po::variables_map values;
  if (!parse(command, arguments, values)) return 0;
  const std::string path = argument_of(command, values, "mesh");
  const Request request = read_request(values);
  const InputMesh input = read_input_mesh(path);
  warn(input.warnings);
  const TriangleMesh& mesh = input.cleaned;
  const bool exact = request.method == DistanceMethod::exact;
  if ((exact || request.compare) && !input.cleaning.manifold())
    throw InputError(path + ": exact distances need a manifold mesh: " + input.cleaning.defects());
  const DistanceSource source = find_source(values, input);
  check_interrupted();

  std::optional<TexelMap> map;
  if (request.needs_atlas) {
    const Atlas atlas = read_atlas(values, mesh, "atlas");
    map = naming(path, [&] { return make_texel_map(mesh, atlas.width, atlas.height, atlas.map); });
    if (map->claims.empty()) throw InputError(path + ": no texel is covered; has the mesh UVs?");
  }
  const double texel = map ? map->median_texel_size() : 0;
  const double radius =
      request.radius ? resolve(*request.radius, texel, mesh.diagonal()) : kInfinity;
  const double spacing = request.spacing ? resolve(*request.spacing, texel, mesh.diagonal())
                                         : default_spacing(mesh, radius);
  check_interrupted();

  nlohmann::json seconds;
  Stopwatch watch;
  NodeSurface surface;
  RefineReport refined;
  Index bridges = 0;
  if (request.needs_nodes) {
    RefineOptions options;
    options.spacing = spacing;
    options.flat_faces = request.bridge.has_value();
    check_spacing(mesh, spacing);
    surface = naming(path, [&] { return refine(mesh, input.cleaning, options, &refined); });
    if (request.bridge)
      bridges = add_bridges(mesh, resolve(*request.bridge, texel, mesh.diagonal()), surface);
    seconds["refine"] = watch.lap();
    check_interrupted();
  }
  // Nodes start with the mesh's vertices.
  std::vector<SurfacePoint> places = surface.nodes.nodes;
  if (exact && !request.needs_nodes) places = make_node_mesh(mesh).nodes;
  const auto exact_distances = [&] {
    return NearbyGeodesics(mesh, radius).distances(source.point, places);
  };
  auto distances =
      exact ? exact_distances() : node_distances(mesh, surface, source, request.method, radius);
  seconds["distance"] = watch.lap();
  check_interrupted();
  const double sigma =
      request.sigma ? resolve(*request.sigma, texel, mesh.diagonal()) : radius / 2.5;
  std::optional<DistanceError> error;
  std::vector<ComparedBackend> compared;
  if (request.compare) {
    const std::vector<double> truth = exact ? distances : exact_distances();
    if (!exact) error = distance_error(truth, distances, sigma);
    if (request.compare_all)
      compared = compare_backends(mesh, surface, source, truth, radius, sigma);
    seconds["compare"] = watch.lap();
  }
  check_interrupted();
  if (has(values, "texture")) {
    const Image image = exact ? exact_distance_texture(mesh, *map, source, radius)
                              : distance_texture(*map, surface, distances, radius);
    check_interrupted();
    std::vector<std::string> warnings;
    write_image(text_of(values, "texture"), image, {}, &warnings);
    warn(warnings);
    seconds["texture"] = watch.lap();
  }
  forget_beyond(radius, distances);
  if (has(values, "nodes-ply"))
    write_nodes(text_of(values, "nodes-ply"), mesh, surface.nodes, distances);
  if (has(values, "output")) write_vertices(text_of(values, "output"), input, distances);

  const std::string backend(exact ? "exact"
                                  : make_backend(request.method, mesh, surface.nodes)->name());
  const std::size_t vertices = mesh.positions.size();
  std::size_t reached = 0;
  double farthest = 0;
  for (std::size_t i = 0; i < distances.size(); ++i) {
    if (std::isnan(distances[i])) continue;
    reached += i < vertices;
    farthest = std::max(farthest, distances[i]);
  }
  if (flag_of(values, "json")) {
    nlohmann::json json = new_report("distance");
    json["mesh"] = path;
    json["source"] = to_json(source, mesh);
    json["source"]["face"] = input.cleaning.kept[source.point.face];
    json["distance"] = name_of(request.method);
    json["backend"] = backend;
    json["radius"] = radius;
    json["spacing"] = request.needs_nodes ? nlohmann::json(spacing) : nlohmann::json();
    json["nodes"] = surface.nodes.nodes.size();
    json["refinement"] = !request.needs_nodes
                             ? nlohmann::json()
                             : nlohmann::json(refined.bisected ? "bisection" : "intrinsic");
    json["bridges"] = bridges;
    json["vertices"] = vertices;
    json["vertices_reached"] = reached;
    json["farthest"] = farthest;
    json["compare"] = error ? to_json(*error, sigma) : nlohmann::json();
    json["compare_all"] = request.compare_all ? to_json(compared, sigma) : nlohmann::json();
    json["seconds"] = seconds;
    print_report(std::move(json));
    return 0;
  }
  if (!flag_of(values, "quiet")) {
    const Vec3 p = mesh.position(source.point);
    std::cerr << path << ": distances from (" << format_number(p.x()) << ", "
              << format_number(p.y()) << ", " << format_number(p.z()) << ") by " << backend;
    if (request.needs_nodes)
      std::cerr << " between " << format_count(surface.nodes.nodes.size()) << " nodes, spacing "
                << format_number(spacing) << (refined.bisected ? ", by bisection" : "");
    if (bridges > 0) std::cerr << " and " << format_count(bridges) << " bridges";
    std::cerr << ": " << format_count(reached) << " of " << format_count(vertices)
              << " vertices reached, farthest " << format_number(farthest) << '\n';
    if (source.off_surface > 0)
      std::cerr << "the point asked for is " << format_number(source.off_surface)
                << " away from the surface\n";
  }
  const ErrorScale scale{
      sigma, (request.sigma ? "sigma = " : "sigma = radius / 2.5 = ") + format_number(sigma)};
  if (request.compare_all) {
    print_table(compared, scale);
  } else if (error) {
    print_error(*error, backend, scale);
  }
  return 0;
}

}  // namespace onmesh::tools
