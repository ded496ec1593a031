// onmesh sample: Poisson-disk samples of a mesh, as PLY.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

#include "atlas.h"
#include "format.h"
#include "interruption.h"
#include "messages.h"
#include "onmesh/atlas/claim_lookup.h"
#include "onmesh/mesh_io/write_ply.h"
#include "onmesh/poisson/poisson.h"
#include "report.h"
#include "shared_options.h"
#include "stopwatch.h"
#include "subcommands.h"

namespace onmesh::tools {

Command sample_command() {
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
  add_weld_option(command.options);
  add_confine_option(command.options);
  add("json", flag(), "print the report as JSON");
  add("quiet,q", flag(), "print nothing but errors and JSON");
  command.positional.add("mesh", 1);
  return command;
}

namespace {

// What to sample, and the texels that the samples are to hit, if there are any.
struct Plan {
  PoissonOptions options;
  std::optional<TexelMap> map;
  TriangleMesh mesh;    // what the map is of: with UVs of each face's own tile
  bool graded = false;  // the spacing follows the texels
};

Plan make_plan(const Arguments& arguments, const TriangleMesh& mesh) {
  Plan plan;
  plan.options.seed = std::uint64_t(arguments.integer("seed", 0, INT64_MAX));
  const std::optional<Length> length = arguments.optional_length("spacing");
  const bool by_texels = length ? length->unit == Length::Unit::texel : !arguments.has("r-coef");
  if (by_texels || has_atlas_option(arguments) || arguments.has("material")) {
    Atlas atlas = read_atlas(arguments, mesh);
    warn(atlas.set.warnings);
    warn(atlas.warnings);
    for (const Index tile : atlas.set.tile_of_face) plan.options.faces.push_back(tile != kNone);
    plan.map = atlas.map();
    plan.mesh = std::move(atlas.mesh);
    if (plan.map->claims.empty()) {
      throw InputError(mesh.uvs.empty() ? "the mesh has no UVs, so there are no texels to hit"
                                        : "no texel lies on a face with area");
    }
  }
  if (length) {
    const double texel_size = plan.map ? plan.map->median_texel_size() : 0;
    plan.options.spacing = resolve(*length, texel_size, mesh.diagonal());
  } else if (arguments.has("r-coef")) {
    plan.options.spacing = arguments.number("r-coef", 1e-9, 1e9) * mesh.mean_edge_length();
  } else {
    plan.graded = true;
  }
  return plan;
}

GradedSamples draw(const TriangleMesh& mesh, const Plan& plan, const Progress& progress) {
  if (plan.graded) return texel_poisson_samples(plan.mesh, *plan.map, plan.options, progress);
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
    if (claim != kNone) is_hit[map.tile_of(hits_of.face_of(claim)).texel(map.claims[claim])] = true;
  }
  Hits hits;
  for (std::size_t t = 0; t < is_hit.size(); ++t) {
    if (map.coverage[t] != Coverage::covered) continue;
    ++hits.covered;
    hits.hit += is_hit[t];
  }
  return hits;
}

Vec3 normal(const TriangleMesh& mesh, Index face) {
  const auto t = mesh.corners(face);
  return (t[1] - t[0]).cross(t[2] - t[0]).normalized();
}

/// \param spacings a column of them, unless null
/// \param file_face per face of the mesh its number in the file
std::vector<PlyColumn> columns(const TriangleMesh& mesh, const std::vector<Index>& file_face,
                               const std::vector<SurfacePoint>& samples,
                               const std::vector<double>* spacings) {
  std::vector<PlyColumn> result;
  const auto add = [&](std::string name, const auto& value_of) {
    result.push_back({});
    result.back().name = std::move(name);
    result.back().values.reserve(samples.size());
    for (const SurfacePoint& s : samples) result.back().values.push_back(value_of(s));
  };
  for (const int k : {0, 1, 2}) {
    add(k == 0   ? "x"
        : k == 1 ? "y"
                 : "z",
        [&](const SurfacePoint& s) { return mesh.position(s)[k]; });
  }
  for (const int k : {0, 1, 2}) {
    add(k == 0   ? "nx"
        : k == 1 ? "ny"
                 : "nz",
        [&](const SurfacePoint& s) { return normal(mesh, s.face)[k]; });
  }
  for (const int k : {0, 1}) {
    if (mesh.uvs.empty()) break;
    add(k == 0 ? "u" : "v",
        [&](const SurfacePoint& s) { return mesh.has_uvs(s.face) ? mesh.uv(s)[k] : std::nan(""); });
  }
  add("face", [&](const SurfacePoint& s) { return file_face[s.face]; });
  result.back().integer = true;
  if (spacings != nullptr) {
    result.push_back({});
    result.back().name = "spacing";
    result.back().values = *spacings;
  }
  return result;
}

/// What was drawn.
struct Findings {
  std::size_t samples = 0;
  double least_spacing = 0, largest_spacing = 0;
  double least_distance = 0;
  double area = 0;  ///< of the faces sampled
  std::optional<Hits> hits;
  double seconds = 0;  ///< for the drawing
};

/// "0.1", or "0.1 ... 0.2" if the spacing follows the texels.
std::string spacing_text(const Findings& found, const Plan& plan) {
  std::ostringstream text;
  text << found.least_spacing;
  if (plan.graded) text << " ... " << found.largest_spacing;
  return text.str();
}

Findings examine(const TriangleMesh& mesh, const Plan& plan, const GradedSamples& samples) {
  Findings found;
  found.samples = samples.points.size();
  found.least_distance = least_sample_distance(mesh, samples);
  check_interrupted();
  const auto [least, largest] =
      std::minmax_element(samples.spacings.begin(), samples.spacings.end());
  found.least_spacing = *least;
  found.largest_spacing = *largest;
  const std::vector<bool>& faces = plan.options.faces;
  for (Index f = 0; f < Index(mesh.faces.size()); ++f) {
    if (faces.empty() || faces[f]) found.area += mesh.face_area(f);
  }
  if (plan.map) found.hits = count_hits(plan.mesh, *plan.map, samples.points);
  return found;
}

void print_json(const Arguments& arguments, const Plan& plan, const Findings& found) {
  nlohmann::json report = new_report("sample");
  report.update({{"mesh", arguments.argument("mesh")},
                 {"output", arguments.text("output")},
                 {"seed", plan.options.seed},
                 {"spacing", found.least_spacing},
                 {"largest_spacing", found.largest_spacing},
                 {"samples", found.samples},
                 {"area", found.area},
                 {"area_per_sample", found.area / double(found.samples)},
                 {"least_distance", found.least_distance},
                 {"texels", nullptr},
                 {"seconds", found.seconds}});
  if (found.hits) report["texels"] = {{"covered", found.hits->covered}, {"hit", found.hits->hit}};
  print_report(std::move(report));
}

void print_text(const Plan& plan, const Findings& found) {
  std::cout << "samples          " << format_count(found.samples) << " in "
            << format_seconds(found.seconds) << "\n"
            << "spacing          " << spacing_text(found, plan) << "\n"
            << "least distance   " << found.least_distance << "\n"
            << "area per sample  " << found.area / double(found.samples) << "\n";
  if (found.hits) {
    std::cout << "texels hit       " << format_count(found.hits->hit) << " of "
              << format_count(found.hits->covered) << "\n";
  }
}

}  // namespace

int run_sample(const Arguments& arguments) {
  const std::string path = arguments.argument("mesh"), output = arguments.text("output");
  check_writable_file(output);
  arguments.refuse_together("spacing", {"r-coef"});
  const bool quiet = arguments.flag("quiet");

  ReadReport read;
  const std::optional<Length> weld = weld_of(arguments);
  JoinReport joining;
  const TriangleMesh mesh = weld_and_join(read_mesh_file(path, arguments, read), weld, joining);
  if (!quiet) warn(read.warnings);
  check_interrupted();
  const Plan plan = naming(path, [&] { return make_plan(arguments, mesh); });
  check_interrupted();

  Stopwatch watch;
  GradedSamples samples;
  {
    ProgressBar bar(quiet);
    samples = naming(path, [&] { return draw(mesh, plan, bar.callback()); });
  }
  const double seconds = watch.lap();
  check_interrupted();
  Findings found = examine(mesh, plan, samples);
  found.seconds = seconds;
  write_ply(output,
            columns(mesh, joining.face, samples.points, plan.graded ? &samples.spacings : nullptr),
            {}, {"onmesh Poisson-disk samples, spacing " + spacing_text(found, plan)});
  if (arguments.flag("json")) {
    print_json(arguments, plan, found);
  } else if (!quiet) {
    print_text(plan, found);
  }
  return 0;
}

}  // namespace onmesh::tools
