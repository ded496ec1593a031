#include "backends/measure.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "backends/observer.h"
#include "onmesh/distance/make_backend.h"
#include "onmesh/filter/patch_loop.h"
#include "onmesh/kernel/radius.h"

namespace onmesh::bench {
namespace {

/// True distances where the filter has its back end.
class Truth final : public DistanceBackend {
 public:
  explicit Truth(const Scene& scene) : scene_(scene) {
    for (const SurfacePoint& node : scene.surface.nodes.nodes)
      positions_.push_back(scene.setup.mesh.position(node));
  }
  std::string_view name() const override { return "exact"; }
  double margin(double, double) const override { return 0; }
  void fill(const Patch& patch, const Reach& reach, DistanceTable& table) const override {
    const auto& nodes = scene_.surface.nodes.nodes;
    const Distances truth = scene_.truth(reach.table);
    table.rows = patch.core_nodes;
    table.columns = Index(patch.nodes.size());
    table.squared.assign(std::size_t(table.rows) * table.columns, kUnreachable);
    std::vector<SurfacePoint> targets;
    std::vector<Index> columns;
    for (Index i = 0; i < table.rows; ++i) {
      targets.clear();
      columns.clear();
      for (Index j = 0; j < table.columns; ++j) {
        if ((positions_[patch.nodes[i]] - positions_[patch.nodes[j]]).norm() > reach.table)
          continue;
        targets.push_back(nodes[patch.nodes[j]]);
        columns.push_back(j);
      }
      const std::vector<double> d = truth(nodes[patch.nodes[i]], targets);
      float* const row = table.squared.data() + std::size_t(i) * table.columns;
      for (std::size_t k = 0; k < d.size(); ++k) {
        if (d[k] <= reach.table) row[columns[k]] = float(d[k] * d[k]);
      }
    }
  }

 private:
  const Scene& scene_;
  std::vector<Vec3> positions_;
};

Row new_row(const Scene& scene, std::string_view backend) {
  Row row;
  row.mesh = scene.name;
  row.backend = backend;
  row.sigma_texels = scene.sigma_texels;
  row.spacing = scene.setup.lengths.curved_spacing / scene.sigma();
  row.faces = scene.setup.mesh.faces.size();
  row.texels = scene.setup.mesh_plan.texels;
  row.nodes = scene.surface.nodes.nodes.size();
  row.refine_ms = 1e3 * scene.refine_seconds;
  return row;
}

/// In units of sigma, within the bilateral filter's radius.
DistanceError error_of(const Scene& scene, const std::vector<std::vector<double>>& distances) {
  const double radius = largest_distance(scene.weights(FilterKind::bilateral).radius);
  std::vector<double> exact, other;
  for (std::size_t k = 0; k < scene.tried.size(); ++k) {
    const Neighbourhood& around = scene.tried[k];
    for (std::size_t i = 0; i < around.near.size(); ++i) {
      // The table does not tell texels of several places apart.
      const bool unique = scene.places[scene.points.texels[around.near[i]]].face != kNone;
      const double d = around.distances[i];
      // What the truth, which goes farther, does not reach must not be within the radius.
      const bool leaked = std::isnan(d) && distances[k][i] <= radius;
      if (!unique || !(d <= radius || leaked)) continue;
      exact.push_back(leaked ? std::numeric_limits<double>::infinity() : d / scene.sigma());
      other.push_back(distances[k][i] / scene.sigma());
    }
  }
  return distance_error(exact, other, 1);
}

DistanceError node_error_of(const Scene& scene, const NodeTruth& truth,
                            const std::vector<std::vector<double>>& distances) {
  std::vector<double> exact, other;
  for (std::size_t k = 0; k < truth.size(); ++k) {
    for (const auto& corner : truth[k]) {
      for (const auto& entry : corner) exact.push_back(entry.second / scene.sigma());
    }
    for (const double d : distances[k]) other.push_back(d / scene.sigma());
  }
  return distance_error(exact, other, 1);
}

using Values = std::vector<std::vector<double>>;  // per tried texel, per channel

Values true_values(const Scene& scene, FilterKind kind) {
  Values values;
  for (const Neighbourhood& around : scene.tried)
    values.push_back(filtered_value(scene.points, around, scene.texture, scene.weights(kind)));
  return values;
}

Values filter_values(const Scene& scene, FilterKind kind, const DistanceBackend& backend,
                     const Samples& targets) {
  const Weights weights = scene.weights(kind);
  const int channels = scene.texture.channels;
  const bool bilateral = kind == FilterKind::bilateral;
  PatchWork work;
  work.nodes = &scene.surface.nodes;
  work.backend = &backend;
  work.sources = &scene.samples;
  work.targets = &targets;
  work.colours = {scene.texture.pixels.data(), channels, bilateral ? channels : 0, channels};
  work.kernel = {weights.sigma, weights.radius, weights.sigma_range};
  Values values(scene.tried.size());
  filter_patches(work,
                 [&](Index begin, Index end, const float* result) {
                   for (Index target = begin; target < end; ++target, result += channels) {
                     const Index k = scene.tried_at[targets.samples[target].texel];
                     if (k != kNone) values[k].assign(result, result + channels);
                   }
                 },
                 {});
  return values;
}

double psnr(const Values& truth, const Values& values) {
  double squares = 0, count = 0;
  for (std::size_t k = 0; k < truth.size(); ++k) {
    for (std::size_t c = 0; c < truth[k].size(); ++c) {
      squares += std::pow(truth[k][c] - values[k][c], 2);
      ++count;
    }
  }
  // Results are floats: beyond 150 dB there is nothing to tell.
  return std::min(150.0, 10 * std::log10(count / std::max(squares, 1e-300)));
}

/// Only the tried texels.
Samples tried_targets(const Scene& scene) {
  Samples out;
  for (Index f = 0; f + 1 < scene.samples.face_offsets.size(); ++f) {
    out.face_offsets.push_back(Index(out.samples.size()));
    for (Index i = scene.samples.face_offsets[f]; i < scene.samples.face_offsets[f + 1]; ++i) {
      if (scene.tried_at[scene.samples.samples[i].texel] != kNone)
        out.samples.push_back(scene.samples.samples[i]);
    }
  }
  out.face_offsets.push_back(Index(out.samples.size()));
  return out;
}

void add_psnr(const Scene& scene, FilterKind kind, const Values& values, Row& row) {
  const double value = psnr(true_values(scene, kind), values);
  (kind == FilterKind::gaussian ? row.psnr_gaussian : row.psnr_bilateral) = value;
}

}  // namespace

Row measure_exact(const Scene& scene, NodeTruth& truth) {
  Row row = new_row(scene, "exact");
  const Samples targets = tried_targets(scene);
  const Truth backend(scene);
  // One pass serves both filters: the Gaussian's tables reach farther than the bilateral's need.
  Observer observer(scene, backend, 0);
  observer.record(scene.weights(FilterKind::bilateral).radius, truth);
  add_psnr(scene, FilterKind::gaussian,
           filter_values(scene, FilterKind::gaussian, observer, targets), row);
  row.error = error_of(scene, observer.distances());
  Values values;
  for (std::size_t k = 0; k < scene.tried.size(); ++k) {
    Neighbourhood around = scene.tried[k];
    for (std::size_t i = 0; i < around.near.size(); ++i) {
      const double d = observer.distances()[k][i];
      if (!std::isnan(d)) around.distances[i] = d;  // else of a texel of several places
    }
    values.push_back(
        filtered_value(scene.points, around, scene.texture, scene.weights(FilterKind::bilateral)));
  }
  add_psnr(scene, FilterKind::bilateral, values, row);
  return row;
}

Row measure_backend(const Scene& scene, DistanceMethod method, const NodeTruth& truth,
                    int repeats) {
  Row row = new_row(scene, name_of(method));
  try {
    const double start = thread_seconds();
    const auto backend = make_backend(method, scene.setup.mesh, scene.surface.nodes);
    const double made = thread_seconds() - start;
    Observer observer(scene, *backend, repeats);
    observer.expect(truth);
    Values values;
    tbb::task_arena(1).execute(
        [&] { values = filter_values(scene, FilterKind::bilateral, observer, scene.samples); });
    const double made_us = 1e6 * made / double(row.nodes);
    row.cost = observer.cost();
    row.cost.us_per_source += made_us;
    row.cost.prepare_us += made_us;
    row.error = error_of(scene, observer.distances());
    row.node_error = node_error_of(scene, truth, observer.node_distances());
    add_psnr(scene, FilterKind::bilateral, values, row);
    add_psnr(
        scene, FilterKind::gaussian,
        filter_values(scene, FilterKind::gaussian, Observer(scene, *backend, 0), scene.samples),
        row);
  } catch (const std::runtime_error& error) {
    row.skipped = error.what();
  }
  return row;
}

Row measure_euclidean(const Scene& scene, const NodeTruth& truth) {
  Row row = new_row(scene, "Euclidean");
  row.refine_ms = Row::kUnmeasured;
  const auto& positions = scene.points.positions;
  std::vector<std::vector<double>> distances, node_distances;
  Values gaussian, bilateral;
  for (const Neighbourhood& around : scene.tried) {
    Neighbourhood straight = around;
    for (std::size_t i = 0; i < around.near.size(); ++i)
      straight.distances[i] = (positions[around.near[i]] - positions[around.centre]).norm();
    for (const FilterKind kind : {FilterKind::gaussian, FilterKind::bilateral})
      (kind == FilterKind::gaussian ? gaussian : bilateral)
          .push_back(filtered_value(scene.points, straight, scene.texture, scene.weights(kind)));
    distances.push_back(std::move(straight.distances));
  }
  const auto position = [&](Index node) {
    return scene.setup.mesh.position(scene.surface.nodes.nodes[node]);
  };
  for (std::size_t k = 0; k < truth.size(); ++k) {
    const Index texel = scene.points.texels[scene.tried[k].centre];
    const auto& corners = scene.surface.nodes.faces[scene.places[texel].face];
    auto& out = node_distances.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) {
      for (const auto& entry : truth[k][i])
        out.push_back((position(entry.first) - position(corners[i])).norm());
    }
  }
  row.error = error_of(scene, distances);
  row.node_error = node_error_of(scene, truth, node_distances);
  add_psnr(scene, FilterKind::gaussian, gaussian, row);
  add_psnr(scene, FilterKind::bilateral, bilateral, row);
  return row;
}

}  // namespace onmesh::bench
