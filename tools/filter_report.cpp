#include "filter_report.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <ostream>

#include "format.h"
#include "onmesh/base/process_memory.h"

namespace onmesh::tools {
namespace {

using nlohmann::json;

/// A length that there is only with Poisson samples.
json length_or_null(double length) { return length > 0 ? json(length) : json(); }

json method_json(const FilterReport& report) {
  return {{"name", report.method},         {"texels_by_nodes", report.by_nodes},
          {"palette", report.palette},     {"checked_values", report.checked},
          {"rms_error", report.rms_error}, {"max_error", report.max_error}};
}

json range_json(const FilterReport& report) {
  const bool has_means = report.mean_before != 0 || report.mean_after != 0;
  return {{"width", report.range_width > 0 ? json(report.range_width) : json()},
          {"noise", report.noise > 0 ? json(report.noise) : json()},
          {"mean_before_despiking", has_means ? json(report.mean_before) : json()},
          {"mean_after_despiking", has_means ? json(report.mean_after) : json()}};
}

json lengths_json(const FilterReport& report) {
  return {{"sigma_spatial", report.sigma_spatial},
          {"radius", report.radius},
          {"texel_size", report.texel_size},
          {"node_spacing", report.node_spacing},
          {"sample_spacing", length_or_null(report.sample_spacing)},
          {"largest_sample_spacing", length_or_null(report.largest_sample_spacing)}};
}

json counts_json(const FilterReport& report) {
  return {{"texels", report.texels},
          {"samples", report.samples},
          {"nodes", report.nodes},
          {"node_faces", report.node_faces},
          {"joined_edges", report.joined_edges},
          {"t_junctions", report.t_junctions},
          {"near_boundary_edges", report.near_edges},
          {"bridges", report.bridges},
          {"patches", report.patches},
          {"table_rows", report.table_rows},
          {"pairs", report.pairs},
          {"taps_per_texel", report.taps},
          {"overlapped_texels", report.overlapped},
          {"gutter_texels", report.gutter},
          {"missing_texels", report.missing},
          {"left_out_texels", report.left_out},
          {"spikes", report.spikes},
          {"texels_without_sample", report.without_sample}};
}

std::string number_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::string length_text(double length, double texel_size) {
  return number_text(length) + " (" + number_text(length / texel_size) + " texels)";
}

}  // namespace

json stages_json(const std::vector<StageTime>& stages) {
  json list = json::array();
  for (const StageTime& stage : stages) {
    list.push_back({{"stage", stage.stage},
                    {"seconds", stage.seconds},
                    {"peak_memory_bytes", stage.peak_memory_bytes}});
  }
  return list;
}

json to_json(const FilterPlan& plan) {
  return {{"sigma_spatial", plan.sigma_spatial},
          {"sigma_texels", plan.sigma_spatial / plan.texel_size},
          {"radius", plan.radius},
          {"texel_size", plan.texel_size},
          {"node_spacing", plan.node_spacing},
          {"curved_node_spacing", plan.curved_spacing},
          {"finest_node_spacing", plan.finest_spacing},
          {"bridge", length_or_null(plan.bridge)},
          {"sample_spacing", length_or_null(plan.sample_spacing)},
          {"largest_sample_spacing", length_or_null(plan.largest_sample_spacing)},
          {"surface_area", plan.surface_area},
          {"joined_edges", plan.joined_edges},
          {"t_junctions", plan.t_junctions},
          {"near_boundary_edges", plan.near_edges},
          {"texels", plan.texels},
          {"overlapped_texels", plan.overlapped},
          {"estimated_samples", plan.samples},
          {"estimated_nodes", plan.nodes},
          {"estimated_memory_bytes", plan.memory_bytes},
          {"memory_limit_bytes", plan.memory_limit}};
}

json to_json(const FilterReport& report) {
  return {
      {"backend", {{"name", report.backend}, {"reason", report.backend_reason}}},
      {"method", method_json(report)},
      {"range", range_json(report)},
      {"instruction_set", report.instruction_set},
      {"refinement", report.refinement},
      {"lengths", lengths_json(report)},
      {"counts", counts_json(report)},
      {"cpu_seconds", {{"table", report.table_cpu_seconds}, {"kernel", report.kernel_cpu_seconds}}},
      {"stages", stages_json(report.stages)}};
}

void print_plan(const FilterPlan& plan, const std::vector<Image>& textures, std::ostream& out) {
  const Image& first = textures[0];
  if (textures.size() == 1) {
    out << "texture       " << first.width << " x " << first.height;
  } else {
    out << "textures      " << textures.size();
  }
  out << ", " << first.channels << " channels; " << format_count(plan.texels)
      << " texels on the surface, one is " << number_text(plan.texel_size) << " wide\n"
      << "sigma         " << length_text(plan.sigma_spatial, plan.texel_size) << '\n'
      << "radius        " << length_text(plan.radius, plan.texel_size) << '\n'
      << "nodes         about " << format_count(plan.nodes) << ", "
      << length_text(plan.node_spacing, plan.texel_size) << " apart";
  if (plan.curved_spacing < plan.node_spacing) {
    out << ", " << length_text(plan.curved_spacing, plan.texel_size)
        << " where the surface is curved";
  }
  out << ", " << length_text(plan.finest_spacing, plan.texel_size) << " where distances bend\n";
  if (plan.sample_spacing > 0) {
    out << "samples       about " << format_count(plan.samples) << ", "
        << length_text(plan.sample_spacing, plan.texel_size);
    if (plan.largest_sample_spacing > plan.sample_spacing) {
      out << " ... " << length_text(plan.largest_sample_spacing, plan.texel_size);
    }
    out << " apart\n";
  }
  out << "memory        about " << memory_text(plan.memory_bytes) << " of "
      << memory_text(plan.memory_limit) << '\n';
}

void print_summary(const FilterReport& report, double seconds, std::ostream& out) {
  out << format_count(report.texels) << " texels filtered in " << format_seconds(seconds) << '\n'
      << "sigma " << length_text(report.sigma_spatial, report.texel_size) << ", radius "
      << length_text(report.radius, report.texel_size) << "; " << format_count(report.nodes)
      << " nodes in " << format_count(report.patches) << " patches, distances: " << report.backend
      << " (" << report.backend_reason << ")\n";
  const std::uint64_t direct = report.texels - report.by_nodes;
  if (direct > 0) {
    out << format_count(direct) << " texels by " << format_count(std::uint64_t(report.taps + 0.5))
        << " samples each on average\n";
  }
  if (report.by_nodes > 0) {
    out << format_count(report.by_nodes) << " texels by nodes";
    if (report.palette > 0) out << ", at most " << report.palette << " colours";
    out << "; of " << format_count(report.checked) << " values checked, RMS error "
        << number_text(report.rms_error) << ", largest " << number_text(report.max_error) << '\n';
  }
  if (report.noise > 0) out << "noise " << number_text(report.noise) << '\n';
  if (report.spikes > 0) {
    out << format_count(report.spikes) << " spikes taken down: the mean went from "
        << number_text(report.mean_before) << " to " << number_text(report.mean_after) << '\n';
  }
  if (report.joined_edges + report.t_junctions > 0) {
    out << format_count(report.joined_edges) << " boundary edges joined, "
        << format_count(report.t_junctions) << " T-junctions split\n";
  }
  if (report.bridges > 0) out << format_count(report.bridges) << " bridges between parts\n";
  for (const StageTime& stage : report.stages) {
    out << "  " << stage.stage
        << std::string(14 - std::min<std::size_t>(stage.stage.size(), 13), ' ')
        << format_seconds(stage.seconds) << '\n';
  }
  if (report.without_sample > 0) {
    out << format_count(report.without_sample) << " texels found no sample and keep their values\n";
  }
}

}  // namespace onmesh::tools
