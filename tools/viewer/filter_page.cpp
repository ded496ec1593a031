#include "filter_page.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "../format.h"
#include "../inputs.h"
#include "../shared_options.h"
#include "onmesh/image/colour_space.h"
#include "onmesh/render/render.h"
#include "review.h"
#include "review_maps.h"

namespace onmesh::tools {
namespace {

/// What was written; the results themselves where they are inside a mesh file.
void read_back(const SurfaceInputs& inputs, const Destination& to, std::vector<Image>& results) {
  for (std::size_t i = 0; i < results.size(); ++i) {
    const std::string path = to.path_of(i);
    if (to.is_gltf() || path.empty()) {
      round_to_codes(results[i]);
      continue;
    }
    std::vector<std::string> told_before;
    SetTexture texture = inputs.set.textures[i];
    texture.path = path;
    texture.content = nullptr;
    results[i] = read_texture(texture, told_before);
  }
}

std::string length_text(double length, double texel_size) {
  return format_number(length) + " mesh units, " + format_number(length / texel_size) + " texels";
}

/// Every option that was given, as it was.
std::string options_text(const Arguments& arguments) {
  std::string text;
  for (const std::string& word : arguments.as_given()) {
    if (!text.empty()) text += ' ';
    text += word;
  }
  return text;
}

ReviewTable table_of_run(const Arguments& arguments, const FilterReport& report, double seconds) {
  ReviewTable table{"Run", {}};
  const auto add = [&](const char* name, std::string value) {
    table.rows.emplace_back(name, std::move(value));
  };
  add("options", options_text(arguments));
  add("sigma spatial", length_text(report.sigma_spatial, report.texel_size));
  if (report.range_width > 0) add("range width", format_number(report.range_width));
  if (report.noise > 0) add("noise", format_number(report.noise));
  add("radius", length_text(report.radius, report.texel_size));
  add("texels", format_count(report.texels));
  add("samples", format_count(report.samples));
  add("nodes", format_count(report.nodes));
  add("distances by", report.backend);
  add("sums by", report.method);
  if (report.spikes > 0) add("spikes taken down", format_count(report.spikes));
  add("time", format_seconds(seconds));
  return table;
}

ReviewTable table_of_stages(const FilterReport& report) {
  ReviewTable table{"Times", {}};
  for (const StageTime& stage : report.stages)
    table.rows.emplace_back(stage.stage, format_seconds(stage.seconds));
  return table;
}

/// What shows the same again.
std::vector<std::string> view_command(const Arguments& arguments, const std::string& mesh) {
  std::vector<std::string> command{"onmesh", "view", mesh};
  if (arguments.has("texture"))
    for (const std::string& texture : arguments.texts("texture"))
      command.insert(command.end(), {"-t", texture});
  command.insert(command.end(), {"--after", arguments.text("output")});
  return command;
}

}  // namespace

void write_filter_page(const std::string& path, const Arguments& arguments,
                       const SurfaceInputs& inputs, const Destination& to,
                       std::vector<Image> results, const FilterReport& report, double seconds) {
  const InputMesh mesh = read_input_mesh(inputs.mesh_path, arguments);
  Review review;
  review.title = std::filesystem::path(inputs.mesh_path).filename().string();
  review.created = {"onmesh", "filter"};
  review.created.insert(review.created.end(), arguments.as_given().begin(),
                        arguments.as_given().end());
  review.view_command = view_command(arguments, inputs.mesh_path);
  review.notes = inputs.warnings;
  review.mesh = &mesh;
  review.wrap = inputs.wrap;
  review.tile_of_face.assign(mesh.welded.faces.size(), kNone);
  review.after_names = {std::filesystem::path(arguments.text("output")).filename().string()};
  if (!inputs.maps.empty()) {
    read_back(inputs, to, results);
    add_input_maps(inputs, {std::move(results)}, review);
    review.tables = {table_of_run(arguments, report, seconds), table_of_stages(report)};
  }
  write_review(path, std::move(review));
}

}  // namespace onmesh::tools
