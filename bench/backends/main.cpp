// onmesh_compare_backends: all distance back ends on the same meshes, nodes and sources.
//
// Per mesh and kernel size, 200 texels are tried. Truth is a closed form or CGAL's exact geodesics,
// from those texels to every texel within the kernel. Every back end fills the tables of the
// filter's own patches between the filter's own nodes (set_up_filter, refine, filter_patches with
// the default spacing rule), and three things are compared with the truth:
//
// - error, in units of sigma: the distances that the kernel sees, from the tried texels to all
//   texels within 2.5 sigma, interpolated from the table. The CSV also has the error of the table's
//   entries alone, from the corners of the tried texels' node faces (node_error).
// - weights wrong: the sum of |g(d) - g(exact)| over the sum of g(exact), g the Gaussian weight.
// - PSNR, peak 1: the values that the filter's kernel gives the tried texels, Gaussian with radius
//   3 sigma and bilateral with 2.5 sigma and sigma_r = 0.2, against the filter's sums in double
//   with true distances. The texture is a checkerboard with noise.
//
// `exact` is a table filled with the truth: what is left is the error of the interpolation (and
// float rounding), the floor for all back ends. `Euclidean` are straight lines without any table.
//
// Times are CPU times on one thread per source node, medians of several runs. Precomputation
// (prepare, part of the time per node) is what a back end does once and per patch whatever the
// number of sources; the difference between tables of few and of all rows tells it. Refinement is
// the same for all; it is in the CSV. Memory is the most by which one patch, its table included,
// raises the resident set.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <iostream>

#include "backends/output.h"
#include "command_line.h"
#include "onmesh/base/error.h"
#include "onmesh/base/file_io.h"

namespace onmesh::bench {
namespace {

struct Options {
  std::vector<std::string> meshes;  ///< files; none = the built-in ones
  std::vector<double> sigmas;       ///< texels
  int size = 1024, texels = 200, repeats = 3;
  bool quick = false;
  std::string csv, markdown;  ///< files; empty = not wanted
};

std::vector<double> parse_sigmas(const std::string& list) {
  std::vector<double> sigmas;
  for (std::size_t begin = 0, comma = 0; begin <= list.size(); begin = comma + 1) {
    comma = std::min(list.find(',', begin), list.size());
    const std::string text = list.substr(begin, comma - begin);
    char* end = nullptr;
    sigmas.push_back(std::strtod(text.c_str(), &end));
    if (end == text.c_str() || *end != '\0' || !(sigmas.back() > 0) || !(sigmas.back() < 1e5))
      throw UsageError("--sigmas: '" + text + "' is not a number between 0 and 100,000");
  }
  return sigmas;
}

void add_options(po::options_description& described, Options& options) {
  const auto count = [](const std::string& option, int& value) {
    return po::value(&value)->default_value(value)->value_name("N")->notifier(counts(option));
  };
  const auto file = [](std::string& path) { return po::value(&path)->value_name("FILE"); };
  auto add = described.add_options();
  add("quick", po::bool_switch(&options.quick),
      "a smoke test of a few seconds: small meshes, sigma 4, 10 texels, times of one run");
  add("sigmas",
      po::value<std::string>()->default_value("4,8,16")->value_name("LIST")->notifier(
          [&](const std::string& list) { options.sigmas = parse_sigmas(list); }),
      "kernel sizes in texels");
  add("size", count("--size", options.size),
      "texels per side of the texture of a mesh from a file");
  add("texels", count("--texels", options.texels), "texels tried per mesh and kernel size");
  add("repeats", count("--repeats", options.repeats), "runs per time");
  add("csv", file(options.csv), "all numbers; 'bench/make_plots backends' draws them");
  add("markdown", file(options.markdown), "two tables: accuracy and cost");
}

/// All rows of one scene.
std::vector<Row> compare(const Subject& subject, double sigma, const Options& options) {
  const Scene scene = make_scene(subject, sigma, std::size_t(options.texels));
  NodeTruth truth;
  std::vector<Row> rows{measure_exact(scene, truth)};
  for (const DistanceMethod method : kComparedMethods)
    rows.push_back(measure_backend(scene, method, truth, options.repeats));
  rows.push_back(measure_euclidean(scene, truth));
  return rows;
}

/// The same; if the subject cannot be compared on, one row that says why.
std::vector<Row> compare_or_skip(const Subject& subject, double sigma, const Options& options) {
  try {
    return compare(subject, sigma, options);
  } catch (const InputError& error) {
    Row row;
    row.mesh = subject.name;
    row.backend = "all";
    row.sigma_texels = sigma;
    row.skipped = error.what();
    return {row};
  }
}

void run(const Options& options) {
  std::vector<Subject> subjects;
  for (const std::string& path : options.meshes)
    subjects.push_back(subject_from_file(path, options.size));
  if (subjects.empty()) subjects = built_in_subjects(options.quick);

  const auto start = std::chrono::steady_clock::now();
  std::vector<Row> rows;
  std::cout << text_header();
  for (const Subject& subject : subjects) {
    for (const double sigma : options.sigmas) {
      for (Row& row : compare_or_skip(subject, sigma, options)) {
        std::cout << text_line(row) << std::flush;
        rows.push_back(std::move(row));
      }
    }
  }
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  std::printf("%.0f s\n", taken.count());
  if (!options.csv.empty()) write_file(options.csv, csv(rows));
  if (!options.markdown.empty()) write_file(options.markdown, markdown(rows));
}

}  // namespace
}  // namespace onmesh::bench

int main(int count, char** arguments) {
  using namespace onmesh::bench;
  Options options;
  Program program;
  program.name = "onmesh_compare_backends";
  program.arguments = "[MESH...] [options]";
  program.summary =
      "Compares the distance back ends on built-in meshes, or on those given (OBJ, PLY, OFF).";
  add_options(program.options, options);
  return run_program(program, count, arguments, [&] {
    options.meshes = program.files;
    if (options.quick) {
      options.sigmas = {4};
      options.texels = 10;
      options.repeats = 1;
    }
    run(options);
  });
}
