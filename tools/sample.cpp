// onmesh sample: Poisson-disk samples of a mesh, as PLY.
#include <Eigen/Geometry>
#include <chrono>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "command.h"
#include "inputs.h"
#include "onmesh/image.h"
#include "onmesh/length.h"
#include "onmesh/mesh_io.h"
#include "onmesh/ply.h"
#include "onmesh/poisson.h"
#include "onmesh/texel_map.h"

namespace onmesh::tools {
namespace {

Command make_command() {
  Command command;
  command.name = "sample";
  command.synopsis = "MESH -o SAMPLES.ply [--spacing H | --r-coef C] [options]";
  command.summary =
      "Writes Poisson-disk samples of the surface: random points no two of which are closer than "
      "the\n"
      "spacing, so many that no more fit. Sides of a thin sheet don't count as close. Without a "
      "spacing,\n"
      "it follows from the texels (of the mesh's own texture, unless -t or --resolution says which)"
      ".\n"
      "The PLY has x y z, the face's normal nx ny nz, u v where the mesh has them, and the number "
      "of\n"
      "the face in the mesh, counted from 0 after polygons are triangulated.";
  command.examples =
      "  onmesh sample cube.obj -o samples.ply\n"
      "  onmesh sample cube.obj -o samples.ply --r-coef 0.006 --seed 7\n"
      "  onmesh sample scan.ply -o samples.ply --spacing 0.5%\n"
      "  onmesh sample cube.obj -o samples.ply --spacing 2tx --resolution 1024x1024 --json\n";
  auto add = command.options.add_options();
  add("mesh", text());
  add("output,o", text(), "the PLY to write");
  add("spacing", text(), "least distance: mesh units, 2tx (texels) or 1% (of the diagonal)");
  add("r-coef", text(), "the same as a multiple of the mean edge length");
  add("seed", text("1"), "another seed gives other samples");
  add("texture,t", text(), "the texture whose texels count");
  add("resolution", text(), "WxH: count texels of a texture of this size");
  add("json", flag(), "print the report as JSON");
  add("quiet,q", flag(), "print nothing but errors and JSON");
  command.positional.add("mesh", 1);
  return command;
}

void refuse_together(const po::variables_map& values, const std::string& a, const std::string& b) {
  if (has(values, a) && has(values, b))
    throw UsageError("--" + a + " and --" + b + " exclude each other");
}

struct Size {
  int width = 0, height = 0;
};

Size parse_resolution(const std::string& text) {
  const std::size_t x = text.find('x');
  Size size;
  for (int* side : {&size.width, &size.height}) {
    const bool first = side == &size.width;
    const std::string digits = x == std::string::npos ? ""
                               : first                ? text.substr(0, x)
                                                      : text.substr(x + 1);
    if (digits.empty() || digits.size() > 5 ||
        digits.find_first_not_of("0123456789") != std::string::npos)
      throw UsageError("--resolution: '" + text + "' is not of the form 1024x512");
    *side = std::stoi(digits);
    if (*side < 1 || *side > 32768)
      throw UsageError("--resolution: '" + text + "' is not within 1x1 and 32768x32768");
  }
  return size;
}

// Of the texture given, or of the only one that the mesh's faces use.
Size texture_size(const po::variables_map& values, const TriangleMesh& mesh) {
  if (has(values, "resolution")) return parse_resolution(text_of(values, "resolution"));
  std::set<std::string> textures;
  if (has(values, "texture")) {
    textures = {text_of(values, "texture")};
  } else {
    for (const Index m : mesh.face_materials)
      if (m != kNone && !mesh.materials[m].texture.empty())
        textures.insert(mesh.materials[m].texture);
  }
  if (textures.size() != 1)
    throw UsageError(
        "the mesh names " +
        (textures.empty() ? "no texture" : std::to_string(textures.size()) + " textures") +
        " to take the size of texels from: give --texture or --resolution, or a "
        "--spacing in other units, or --r-coef");
  const Image image = read_image(*textures.begin());
  return {image.width, image.height};
}

double resolve_spacing(const po::variables_map& values, const TriangleMesh& mesh) {
  if (has(values, "r-coef"))
    return number_of(values, "r-coef", 1e-9, 1e9) * mesh.mean_edge_length();
  Length length;
  if (has(values, "spacing")) {
    length = parse_length("--spacing", text_of(values, "spacing"));
    if (length.unit != Length::Unit::texel) return resolve(length, 0, mesh.diagonal());
  }
  const Size size = texture_size(values, mesh);
  const TexelMap map = make_texel_map(mesh, size.width, size.height);
  if (map.claims.empty()) throw InputError("no texel lies on the surface: the mesh has no UVs");
  return has(values, "spacing") ? resolve(length, map.median_texel_size(), 0)
                                : default_poisson_spacing(mesh, map);
}

std::vector<PlyColumn> columns(const TriangleMesh& mesh, const std::vector<SurfacePoint>& samples) {
  std::vector<PlyColumn> result;
  const auto add = [&](const char* name) -> std::vector<double>& {
    result.push_back({});
    result.back().name = name;
    result.back().values.reserve(samples.size());
    return result.back().values;
  };
  for (const int k : {0, 1, 2}) {
    auto& column = add(k == 0 ? "x" : k == 1 ? "y" : "z");
    for (const SurfacePoint& s : samples) column.push_back(mesh.position(s)[k]);
  }
  for (const int k : {0, 1, 2}) {
    auto& column = add(k == 0 ? "nx" : k == 1 ? "ny" : "nz");
    for (const SurfacePoint& s : samples) {
      const auto t = mesh.corners(s.face);
      column.push_back((t[1] - t[0]).cross(t[2] - t[0]).normalized()[k]);
    }
  }
  for (const int k : {0, 1}) {
    if (mesh.uvs.empty()) break;
    auto& column = add(k == 0 ? "u" : "v");
    for (const SurfacePoint& s : samples)
      column.push_back(mesh.has_uvs(s.face) ? mesh.uv(s)[k] : std::nan(""));
  }
  auto& column = add("face");
  for (const SurfacePoint& s : samples) column.push_back(s.face);
  result.back().integer = true;
  return result;
}

}  // namespace

int run_sample(const std::vector<std::string>& arguments) {
  const Command command = make_command();
  po::variables_map values;
  if (!parse(command, arguments, values)) return 0;
  const std::string path = argument_of(command, values, "mesh");
  const std::string output = text_of(values, "output");
  check_writable_file(output);
  refuse_together(values, "spacing", "r-coef");
  refuse_together(values, "texture", "resolution");
  if (has(values, "resolution")) parse_resolution(text_of(values, "resolution"));
  PoissonOptions options;
  options.seed = std::uint64_t(integer_of(values, "seed", 0, INT64_MAX));
  const bool quiet = flag_of(values, "quiet");

  std::vector<std::string> warnings;
  const TriangleMesh mesh = weld(read_mesh(path, &warnings));
  if (!quiet) warn(warnings);
  check_interrupted();
  options.spacing = naming(path, [&] { return resolve_spacing(values, mesh); });
  check_interrupted();

  const auto start = std::chrono::steady_clock::now();
  std::vector<SurfacePoint> samples;
  {
    ProgressBar bar(quiet);
    samples = naming(path, [&] { return poisson_samples(mesh, options, bar.callback()); });
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  const double least = least_sample_distance(mesh, samples, options.spacing);
  check_interrupted();
  std::ostringstream comment;
  comment << "onmesh Poisson-disk samples, spacing " << options.spacing;
  write_ply(output, columns(mesh, samples), {}, {comment.str()});

  double area = 0;
  for (Index f = 0; f < Index(mesh.faces.size()); ++f) area += mesh.face_area(f);
  if (flag_of(values, "json")) {
    nlohmann::json report = new_report(command.name);
    report["mesh"] = path;
    report["output"] = output;
    report["seed"] = options.seed;
    report["spacing"] = options.spacing;
    report["samples"] = samples.size();
    report["area"] = area;
    report["area_per_sample"] = area / double(samples.size());
    report["least_distance"] = least;
    report["seconds"] = seconds.count();
    print_report(report);
  } else if (!quiet) {
    std::cout << "samples          " << format_count(samples.size()) << " in "
              << format_seconds(seconds.count()) << "\n"
              << "spacing          " << options.spacing << "\n"
              << "least distance   " << least << "\n"
              << "area per sample  " << area / double(samples.size()) << "\n";
  }
  return 0;
}

}  // namespace onmesh::tools
