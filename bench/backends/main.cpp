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
// 3
//   sigma and bilateral with 2.5 sigma and sigma_r = 0.2, against the filter's sums in double with
//   true distances. The texture is a checkerboard with noise.
//
// `exact` is a table filled with the truth: what is left is the error of the interpolation (and
// float rounding), the floor for all back ends. `Euclidean` are straight lines without any table.
//
// Times are CPU times on one thread per source node, medians of several runs. Precomputation
// (prepare, part of the time per node) is what a back end does once and per patch whatever the
// number of sources; the difference between tables of few and of all rows tells it. Refinement is
// the same for all; it is in the CSV. Memory is the most by which one patch, its table included,
// raises the resident set.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>

#include "backends/output.h"
#include "onmesh/base/error.h"
#include "onmesh/base/file_io.h"

namespace onmesh::compare {
namespace {

const char* const kUsage =
    "usage: onmesh_compare_backends [MESH...] [options]\n"
    "\n"
    "Compares the distance back ends on built-in meshes, or on those given (OBJ, PLY, OFF).\n"
    "\n"
    "  --quick           a smoke test of a few seconds\n"
    "  --sigmas LIST     kernel sizes in texels (default: 4,8,16)\n"
    "  --size N          texels per side of the texture of a mesh from a file (default: 1024)\n"
    "  --texels N        texels tried per mesh and kernel size (default: 200)\n"
    "  --repeats N       runs per time (default: 3)\n"
    "  --csv FILE        all numbers\n"
    "  --markdown FILE   the tables of the README\n"
    "  --plots FOLDER    backend-errors.svg, backend-psnr.svg, backend-times.svg\n";

struct Options {
  std::vector<std::string> meshes;
  std::vector<double> sigmas;
  int size = 1024, texels = 0, repeats = 0;
  bool quick = false, help = false;
  std::string csv, markdown, plots;
};

double positive(const std::string& option, const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (end == text.c_str() || *end != '\0' || !(value > 0) || !(value < 1e5))
    throw UsageError(option + ": '" + text + "' is not a number between 0 and 100,000");
  return value;
}

int whole(const std::string& option, const std::string& text) {
  const double value = positive(option, text);
  if (value != std::floor(value)) throw UsageError(option + ": '" + text + "' is not whole");
  return int(value);
}

Options parse(const std::vector<std::string>& arguments) {
  Options options;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& name = arguments[i];
    const auto value = [&]() -> const std::string& {
      if (i + 1 == arguments.size()) throw UsageError(name + ": needs a value");
      return arguments[++i];
    };
    if (name == "--quick") {
      options.quick = true;
    } else if (name == "--help" || name == "-h") {
      options.help = true;
    } else if (name == "--sigmas") {
      const std::string list = value() + ',';
      for (std::size_t begin = 0, comma = 0; begin < list.size(); begin = comma + 1) {
        comma = list.find(',', begin);
        options.sigmas.push_back(positive(name, list.substr(begin, comma - begin)));
      }
    } else if (name == "--size") {
      options.size = whole(name, value());
    } else if (name == "--texels") {
      options.texels = whole(name, value());
    } else if (name == "--repeats") {
      options.repeats = whole(name, value());
    } else if (name == "--csv") {
      options.csv = value();
    } else if (name == "--markdown") {
      options.markdown = value();
    } else if (name == "--plots") {
      options.plots = value();
    } else if (name.starts_with("-")) {
      throw UsageError("unknown option '" + name + "'");
    } else {
      options.meshes.push_back(name);
    }
  }
  if (options.sigmas.empty()) options.sigmas = {4, 8, 16};
  if (options.quick) options.sigmas = {4};
  if (options.texels == 0) options.texels = options.quick ? 10 : 200;
  if (options.repeats == 0) options.repeats = options.quick ? 1 : 3;
  return options;
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

int run(const std::vector<std::string>& arguments) {
  const Options options = parse(arguments);
  if (options.help) {
    std::cout << kUsage;
    return 0;
  }
  std::vector<Subject> subjects;
  for (const std::string& path : options.meshes)
    subjects.push_back(subject_from_file(path, options.size));
  if (subjects.empty()) subjects = built_in_subjects(options.quick);

  const auto start = std::chrono::steady_clock::now();
  std::vector<Row> rows;
  std::cout << text_header();
  for (const Subject& subject : subjects) {
    for (const double sigma : options.sigmas) {
      try {
        for (Row& row : compare(subject, sigma, options)) {
          std::cout << text_line(row) << std::flush;
          rows.push_back(std::move(row));
        }
      } catch (const InputError& error) {
        Row row;
        row.mesh = subject.name;
        row.backend = "all";
        row.sigma_texels = sigma;
        row.skipped = error.what();
        std::cout << text_line(row) << std::flush;
        rows.push_back(std::move(row));
      }
    }
  }
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  std::printf("%.0f s\n", taken.count());
  if (!options.csv.empty()) write_file(options.csv, csv(rows));
  if (!options.markdown.empty()) write_file(options.markdown, markdown(rows));
  if (!options.plots.empty()) write_plots(options.plots, rows);
  return 0;
}

}  // namespace
}  // namespace onmesh::compare

int main(int count, char** arguments) {
  try {
    return onmesh::compare::run({arguments + 1, arguments + count});
  } catch (const onmesh::UsageError& error) {
    std::cerr << "onmesh_compare_backends: " << error.what() << '\n';
    return 2;
  } catch (const onmesh::FileError& error) {
    std::cerr << "onmesh_compare_backends: " << error.what() << '\n';
    return 4;
  } catch (const std::exception& error) {
    std::cerr << "onmesh_compare_backends: " << error.what() << '\n';
    return 3;
  }
}
