#include "distance_compare.h"

#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

#include "format.h"
#include "interruption.h"
#include "stopwatch.h"

namespace onmesh::tools {
namespace {

ComparedBackend measure(const std::string& name, const std::vector<double>& exact, double sigma,
                        const FoundDistances& tell,
                        const std::function<std::vector<double>()>& distances) {
  check_interrupted();
  ComparedBackend result;
  result.name = name;
  Stopwatch watch;
  try {
    const std::vector<double> found = distances();
    result.seconds = watch.lap();
    result.error = distance_error(exact, found, sigma);
    if (tell) tell(name, found);
  } catch (const InputError& error) {
    result.skipped = error.what();
  } catch (const NumericError& error) {
    result.skipped = error.what();
  }
  return result;
}

std::string padded(std::string text, std::size_t width) {
  if (text.size() < width) text.resize(width, ' ');
  return text + "  ";
}

}  // namespace

std::vector<ComparedBackend> compare_backends(const TriangleMesh& mesh, const NodeSurface& surface,
                                              const DistanceSource& source,
                                              const std::vector<double>& exact, double radius,
                                              double sigma, const FoundDistances& found) {
  std::vector<ComparedBackend> backends;
  for (const DistanceMethod method : kComparedMethods) {
    backends.push_back(measure(std::string(name_of(method)), exact, sigma, found, [&] {
      return node_distances(mesh, surface, source, method, radius);
    }));
  }
  backends.push_back(measure("euclidean", exact, sigma, found, [&] {
    const Vec3 start = mesh.position(source.point);
    std::vector<double> straight;
    for (const SurfacePoint& node : surface.nodes.nodes)
      straight.push_back((mesh.position(node) - start).norm());
    return straight;
  }));
  return backends;
}

void print_error(const DistanceError& error, const std::string& backend, const ErrorScale& scale) {
  std::cout << "error of " << backend << " against exact at " << format_count(error.points)
            << " nodes";
  if (error.missed > 0) std::cout << " (" << format_count(error.missed) << " more not reached)";
  std::cout << '\n';
  const bool scaled = std::isfinite(scale.sigma);
  const std::pair<const char*, double> rows[] = {
      {"mean", error.mean}, {"p99", error.p99}, {"max", error.max}};
  for (const auto& [name, value] : rows) {
    std::string line = "  " + padded(name, 4);
    line += scaled
                ? padded(format_number(value), 12) + format_number(value / scale.sigma) + " sigma"
                : format_number(value);
    std::cout << line << '\n';
  }
  if (!scaled) return;
  std::cout << "  wrong share of a Gaussian's weights: " << format_percent(error.weight) << '\n'
            << "with " << scale.meaning << '\n';
}

void print_table(const std::vector<ComparedBackend>& backends, const ErrorScale& scale) {
  const bool scaled = std::isfinite(scale.sigma);
  std::size_t points = 0;
  for (const ComparedBackend& b : backends) points = std::max(points, b.error.points);
  std::cout << "errors against exact at " << format_count(points) << " nodes, in "
            << (scaled ? scale.meaning : "mesh units") << '\n';
  std::vector<std::string> header{"back end", "mean", "p99", "max", "missed", "time"};
  if (scaled) header.insert(header.end() - 2, "wrong weights");
  const std::size_t width = 13;
  std::string line = "  ";
  for (const std::string& name : header) line += padded(name, width);
  std::cout << line.substr(0, line.find_last_not_of(' ') + 1) << '\n';
  for (const ComparedBackend& b : backends) {
    line = "  " + padded(b.name, width);
    if (b.skipped.empty()) {
      for (const double value : {b.error.mean, b.error.p99, b.error.max})
        line += padded(format_number(scaled ? value / scale.sigma : value), width);
      if (scaled) line += padded(format_percent(b.error.weight), width);
      line += padded(format_count(b.error.missed), width) + format_seconds(b.seconds);
    } else {
      line += "skipped: " + b.skipped;
    }
    std::cout << line << '\n';
  }
}

nlohmann::json to_json(const DistanceError& error, double sigma) {
  const bool scaled = std::isfinite(sigma);
  nlohmann::json json = {{"points", error.points},
                         {"missed", error.missed},
                         {"mean", error.mean},
                         {"p99", error.p99},
                         {"max", error.max},
                         {"sigma", nullptr},
                         {"wrong_weights", error.weight}};
  for (const char* name : {"mean", "p99", "max"})
    json[std::string(name) + "_in_sigma"] =
        scaled ? nlohmann::json(json[name].get<double>() / sigma) : nlohmann::json();
  if (scaled) json["sigma"] = sigma;
  return json;
}

nlohmann::json to_json(const std::vector<ComparedBackend>& backends, double sigma) {
  nlohmann::json json;
  for (const ComparedBackend& b : backends) {
    if (b.skipped.empty()) {
      json[b.name] = to_json(b.error, sigma);
      json[b.name]["seconds"] = b.seconds;
    } else {
      json[b.name]["skipped"] = b.skipped;
    }
  }
  return json;
}

}  // namespace onmesh::tools
