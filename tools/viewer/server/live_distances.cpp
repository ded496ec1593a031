#include "live_distances.h"

#include <cmath>
#include <limits>

#include "../../distance_compare.h"
#include "../../distance_field.h"
#include "../../format.h"
#include "../review.h"
#include "onmesh/measure/nearby_geodesics.h"
#include "onmesh/poisson/poisson.h"

namespace onmesh::tools {
namespace {

constexpr double kEverywhere = std::numeric_limits<double>::infinity();

/// "distance by unfold from (0.5, 1, 0)"
std::string layer_name(const std::string& backend, const Vec3& p) {
  std::string name = "distance";
  if (backend != "auto") {
    name += " by ";
    name += backend;
  }
  for (int k = 0; k < 3; ++k) {
    name += k == 0 ? " from (" : ", ";
    name += format_number(p[k]);
  }
  name += ')';
  return name;
}

DistanceMethod method_of(const std::string& name) {
  for (const DistanceMethod method :
       {DistanceMethod::automatic, DistanceMethod::unfold, DistanceMethod::heat,
        DistanceMethod::cloud, DistanceMethod::exact}) {
    if (name == name_of(method)) return method;
  }
  throw UsageError("backend: '" + name + "' is not one of auto, unfold, heat, cloud, exact");
}

}  // namespace

void LiveDistances::make_nodes(const Progress& progress) {
  if (fields_) return;
  progress("nodes", 0);
  RefineOptions options;
  options.spacing = default_spacing(mesh_.cleaned, kEverywhere);
  check_node_count(mesh_.cleaned, options);
  surface_ = refine(mesh_.cleaned, mesh_.cleaning, options);
  progress("surface of the page", 0);
  fields_.emplace(mesh_.cleaned, surface_);
}

std::vector<double> LiveDistances::distances(const DistanceSource& source,
                                             const std::string& backend) const {
  const DistanceMethod method = method_of(backend);
  if (method != DistanceMethod::exact) {
    std::vector<double> found =
        node_distances(mesh_.cleaned, surface_, source, method, kEverywhere);
    forget_beyond(kEverywhere, found);
    return found;
  }
  if (!mesh_.cleaning.manifold())
    throw InputError("exact distances need a manifold mesh: " + mesh_.cleaning.defects());
  return NearbyGeodesics(mesh_.cleaned, kEverywhere).distances(source.point, surface_.nodes.nodes);
}

std::string LiveDistances::answer(const DistanceQuestion& question, const Progress& progress) {
  return naming(mesh_, [&] {
    method_of(question.backend);
    make_nodes(progress);
    const DistanceSource source = source_at_point(mesh_.cleaned, question.point);
    const Vec3 place = mesh_.cleaned.position(source.point);
    PageWriter page(PageWriter::Effort::quick);
    nlohmann::json part;
    part["fields"] = question.needs_surface ? fields_->scene(page) : nlohmann::json();
    part["layers"] = nlohmann::json::array();
    const auto add = [&](const std::string& backend, std::vector<double> found) {
      part["layers"].push_back(
          fields_->layer({layer_name(backend, place), place, std::move(found)}, page));
    };
    progress("distances", 0);
    if (!question.compares) {
      add(question.backend, distances(source, question.backend));
      return page.answer(part);
    }
    std::vector<double> exact = distances(source, "exact");
    int done = 1;
    const auto found = [&](const std::string& backend, const std::vector<double>& values) {
      progress("errors", ++done / 5.0);
      std::vector<double> known = values;
      forget_beyond(kEverywhere, known);
      add(backend, std::move(known));
    };
    part["errors"] = to_json(
        compare_backends(mesh_.cleaned, surface_, source, exact, kEverywhere, kEverywhere, found),
        kEverywhere);
    add("exact", std::move(exact));
    return page.answer(part);
  });
}

std::string LiveDistances::samples(double spacing, const Progress& progress) const {
  constexpr double kMost = 5e5;
  return naming(mesh_, [&] {
    double area = 0;
    for (Index f = 0; f < mesh_.cleaned.faces.size(); ++f) area += mesh_.cleaned.face_area(f);
    if (0.7 * area / (spacing * spacing) > kMost)
      throw UsageError("--spacing: there would be more than 500,000 samples, too many to be shown");
    PoissonOptions options;
    options.spacing = spacing;
    Review review;
    review.mesh = &mesh_;
    review.samples = poisson_samples(mesh_.cleaned, options, progress);
    review.samples_text = "Poisson-disk samples, " + format_number(spacing) + " apart";
    PageWriter page(PageWriter::Effort::quick);
    const nlohmann::json part{{"samples", scene_samples(review, page)}};
    return page.answer(part);
  });
}

}  // namespace onmesh::tools
