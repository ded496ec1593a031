// onmesh sample: Poisson-disk samples of a mesh, as PLY.
#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "command.h"
#include "inputs.h"
#include "onmesh/atlas/claim_lookup.h"
#include "onmesh/atlas/texel_map.h"
#include "onmesh/filter/length.h"
#include "onmesh/mesh_io/read_mesh.h"
#include "onmesh/mesh_io/write_ply.h"
#include "onmesh/poisson/poisson.h"

namespace onmesh::tools {
namespace {

Command make_command() {
  Command command;
  command.name = "sample";
  command.synopsis = "MESH -o SAMPLES.ply [--spacing H | --r-coef C] [options]";
  command.summary =
      "Writes Poisson-disk samples of the surface: random points no two of which are closer than\n"
      "the spacing, so many that no more fit. Sides of a thin sheet don't count as close. Without "
      "a\n"
      "spacing, it follows the size of the texels (of the mesh's own texture, unless -t or\n"
      "--resolution says which), and every texel is hit. The PLY has x y z, the face's normal\n"
      "nx ny nz, u v where the mesh has them, the number of the face in the mesh, counted from 0 "
      "after\n"
      "polygons are triangulated, and the sample's spacing where it follows the texels.";
  command.examples =
      "  onmesh sample cube.obj -o samples.ply\n"
      "  onmesh sample cube.obj -o samples.ply --r-coef 0.006 --seed 7\n"
      "  onmesh sample scan.ply -o samples.ply --spacing 0.5%\n"
      "  onmesh sample cube.obj -o samples.ply --spacing 2tx --resolution 1024x1024 --json\n";
  command.options.add_options()("mesh", text());
  command.options.add_options()("output,o", text(), "the PLY to write");
  add_atlas_options(command.options);
  auto add = command.options.add_options();
  add("spacing", text(),
      "least distance, the same everywhere: mesh units, 2tx (texels) or 1% (of the diagonal)");
  add("r-coef", text(), "the same as a multiple of the mean edge length");
  add("seed", text("1"), "another seed gives other samples");
  add("json", flag(), "print the report as JSON");
  add("quiet,q", flag(), "print nothing but errors and JSON");
  command.positional.add("mesh", 1);
  return command;
}

// What to sample, and the texels that the samples are to hit, if there are any.
struct Plan {
  PoissonOptions options;
  std::optional<TexelMap> map;
  bool graded = false;  // the spacing follows the texels
};

Plan make_plan(const po::variables_map& values, const TriangleMesh& mesh) {
  Plan plan;
  plan.options.seed = std::uint64_t(integer_of(values, "seed", 0, INT64_MAX));
  std::optional<Length> length;
  if (has(values, "spacing")) length = parse_length("--spacing", text_of(values, "spacing"));
  const bool by_texels = length ? length->unit == Length::Unit::texel : !has(values, "r-coef");
  if (by_texels || has_atlas_option(values) || has(values, "material")) {
    const Atlas atlas = read_atlas(values, mesh);
    plan.options.faces = atlas.map.faces;
    plan.map = make_texel_map(mesh, atlas.width, atlas.height, atlas.map);
    if (plan.map->claims.empty()) {
      throw InputError(mesh.uvs.empty() ? "the mesh has no UVs, so there are no texels to hit"
                                        : "no texel lies on a face with area");
    }
  }
  if (length) {
    const double texel_size = plan.map ? plan.map->median_texel_size() : 0;
    plan.options.spacing = resolve(*length, texel_size, mesh.diagonal());
  } else if (has(values, "r-coef")) {
    plan.options.spacing = number_of(values, "r-coef", 1e-9, 1e9) * mesh.mean_edge_length();
  } else {
    plan.graded = true;
  }
  return plan;
}

GradedSamples draw(const TriangleMesh& mesh, const Plan& plan, const Progress& progress) {
  if (plan.graded) return texel_poisson_samples(mesh, *plan.map, plan.options, progress);
  GradedSamples samples;
  samples.points = poisson_samples(mesh, plan.options, progress);
  samples.spacings.assign(samples.points.size(), plan.options.spacing);
  return samples;
}

// How many of the covered texels have a sample in their square, on a chart that claims them.
struct Hits {
  std::uint64_t hit = 0, covered = 0;
};

Hits count_hits(const TriangleMesh& mesh, const TexelMap& map,
                const std::vector<SurfacePoint>& samples) {
  const ClaimLookup hits_of(map);
  std::vector<bool> is_hit(map.coverage.size(), false);
  for (const SurfacePoint& s : samples) {
    if (map.chart_of_face[s.face] == kNone) continue;
    const Index claim = hits_of.find(s.face, mesh.uv(s));
    if (claim != kNone) is_hit[map.texel(map.claims[claim])] = true;
  }
  Hits hits;
  for (std::size_t t = 0; t < is_hit.size(); ++t) {
    if (map.coverage[t] != Coverage::covered) continue;
    ++hits.covered;
    hits.hit += is_hit[t];
  }
  return hits;
}

std::vector<PlyColumn> columns(const TriangleMesh& mesh, const std::vector<SurfacePoint>& samples,
                               const std::vector<double>* spacings) {
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
  if (spacings) add("spacing") = *spacings;
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
  if (has(values, "spacing") && has(values, "r-coef"))
    throw UsageError("--spacing and --r-coef exclude each other");
  const bool quiet = flag_of(values, "quiet");

  std::vector<std::string> warnings;
  const TriangleMesh mesh = weld(read_mesh(path, &warnings));
  if (!quiet) warn(warnings);
  check_interrupted();
  const Plan plan = naming(path, [&] { return make_plan(values, mesh); });
  const PoissonOptions& options = plan.options;
  check_interrupted();

  const auto start = std::chrono::steady_clock::now();
  GradedSamples samples;
  {
    ProgressBar bar(quiet);
    samples = naming(path, [&] { return draw(mesh, plan, bar.callback()); });
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  check_interrupted();
  const auto count = samples.points.size();
  const double least_distance = least_sample_distance(mesh, samples);
  check_interrupted();
  const auto [least, largest] =
      std::minmax_element(samples.spacings.begin(), samples.spacings.end());
  std::ostringstream spacing;
  spacing << *least;
  if (plan.graded) spacing << " ... " << *largest;
  write_ply(output, columns(mesh, samples.points, plan.graded ? &samples.spacings : nullptr), {},
            {"onmesh Poisson-disk samples, spacing " + spacing.str()});

  double area = 0;
  for (Index f = 0; f < Index(mesh.faces.size()); ++f) {
    if (options.faces.empty() || options.faces[f]) area += mesh.face_area(f);
  }
  const Hits hits = plan.map ? count_hits(mesh, *plan.map, samples.points) : Hits{};
  if (flag_of(values, "json")) {
    nlohmann::json report = new_report(command.name);
    report["mesh"] = path;
    report["output"] = output;
    report["seed"] = options.seed;
    report["spacing"] = *least;
    report["largest_spacing"] = *largest;
    report["samples"] = count;
    report["area"] = area;
    report["area_per_sample"] = area / double(count);
    report["least_distance"] = least_distance;
    report["texels"] = nullptr;
    if (plan.map) report["texels"] = {{"covered", hits.covered}, {"hit", hits.hit}};
    report["seconds"] = seconds.count();
    print_report(report);
  } else if (!quiet) {
    std::cout << "samples          " << format_count(count) << " in "
              << format_seconds(seconds.count()) << "\n"
              << "spacing          " << spacing.str() << "\n"
              << "least distance   " << least_distance << "\n"
              << "area per sample  " << area / double(count) << "\n";
    if (plan.map) {
      std::cout << "texels hit       " << format_count(hits.hit) << " of "
                << format_count(hits.covered) << "\n";
    }
  }
  return 0;
}

}  // namespace onmesh::tools
