#include "onmesh/filter/report_notes.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "onmesh/base/text.h"
#include "onmesh/kernel/direct/direct_kernel.h"

namespace onmesh {
namespace {

std::string reason_for_backend(DistanceMethod method, const CleanReport& cleaning) {
  if (method != DistanceMethod::automatic) return "asked for";
  if (cleaning.manifold()) return "the default for manifold meshes";
  return "the default for meshes that are not manifold: " + cleaning.defects();
}

void note_method(const NodeCheck& nodes, FilterReport& report) {
  const std::uint64_t direct = report.texels - nodes.targets + nodes.direct;
  report.method = nodes.targets == 0 ? "direct" : direct == 0 ? "nodes" : "nodes and direct";
  report.by_nodes = nodes.targets - nodes.direct;
  report.checked = nodes.checked;
  report.palette = nodes.colours;
  if (nodes.checked > 0) report.rms_error = std::sqrt(nodes.squared_error / double(nodes.checked));
  report.max_error = nodes.largest_error;
}

}  // namespace

void note_plan(const FilterPlan& plan, FilterReport& report) {
  report.sigma_spatial = plan.sigma_spatial;
  report.radius = plan.radius;
  report.node_spacing = plan.node_spacing;
  report.sample_spacing = plan.sample_spacing;
  report.largest_sample_spacing = plan.largest_sample_spacing;
  report.texel_size = plan.texel_size;
  report.overlapped = plan.overlapped;
  report.joined_edges = plan.joined_edges;
  report.t_junctions = plan.t_junctions;
  report.near_edges = plan.near_edges;
  report.warnings = plan.warnings;
}

void note_backend(const DistanceBackend& backend, DistanceMethod method,
                  const CleanReport& cleaning, FilterReport& report) {
  report.backend = backend.name();
  if (backend.skipped_nodes() > 0) {
    report.warnings.push_back(std::to_string(backend.skipped_nodes()) +
                              " points have no face with area around them and are left out");
  }
  report.backend_reason = reason_for_backend(method, cleaning);
  report.instruction_set = kernel_target();
}

void note_counts(const PatchCounts& counts, FilterReport& report) {
  report.patches = counts.patches;
  report.pairs = counts.pairs;
  report.taps = counts.pairs_within / double(std::max<std::uint64_t>(report.texels, 1));
  report.without_sample = counts.without_sample;
  report.table_rows = counts.table_rows;
  note_method(counts.nodes, report);
  report.table_cpu_seconds = counts.table_cpu_seconds;
  report.kernel_cpu_seconds = counts.kernel_cpu_seconds;
}

void note_missing(const WorkingValues& working, std::uint64_t left, FilterReport& report) {
  report.missing = working.missing();
  report.left_out = working.left_out();
  const auto tell = [&](std::uint64_t count, const char* why) {
    if (count == 0) return;
    report.warnings.push_back(count_text(count, "texel", "texels") + " on the surface " + why +
                              ": they did not count, and were filled from around them");
  };
  tell(working.missing() - working.left_out(), "had values that are not finite");
  tell(working.left_out(), "had no value by the mask of samples");
  if (left > 0) {
    report.warnings.push_back(count_text(left, "texel", "texels") +
                              " had nothing around them to be filled from: they stay as they are");
  }
  if (working.emission() > 0) {
    report.warnings.push_back(count_text(working.emission(), "texel", "texels") +
                              " with alpha 0 and a colour multiplied with it: kept as emission");
  }
}

}  // namespace onmesh
