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

namespace onmesh::tools {
namespace {

/// As it is in the file: integers are rounded there.
void round_to_codes(Image& image) {
  const int levels = levels_of(image);
  if (levels == 0) return;
  for (float& value : image.pixels)
    value = float(std::round(std::clamp(double(value), 0.0, 1.0) * levels) / levels);
}

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

/// Maps on the faces of the first one. Others are noted.
void add_maps(const SurfaceInputs& inputs, std::vector<Image> results, Review& review) {
  const InputMap& first = inputs.maps[0];
  review.tile_of_face = first.tile_of_face;
  for (std::size_t t = 0; t < first.count; ++t) {
    const SetTexture& texture = inputs.set.textures[t];
    const std::string name =
        texture.udim > 0 ? std::to_string(texture.udim) : texture.path.filename().string();
    review.tiles.push_back({name, texture.column(), texture.row()});
  }
  for (const InputMap& map : inputs.maps) {
    if (map.has_own_uvs || map.tile_of_face != first.tile_of_face) {
      review.notes.push_back(map.name + ": is on other faces or UVs than " + first.name +
                             " and not shown");
      continue;
    }
    ReviewMap& shown = review.maps.emplace_back();
    shown.name = map.name;
    shown.space = inputs.spaces[map.first].name;
    shown.after.emplace_back();
    for (std::size_t i = map.first; i < map.first + map.count; ++i) {
      shown.files.push_back(inputs.set.textures[i].path.filename().string());
      shown.before.push_back(inputs.images[i]);
      shown.after[0].push_back(std::move(results[i]));
    }
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
    add_maps(inputs, std::move(results), review);
    review.tables = {table_of_run(arguments, report, seconds), table_of_stages(report)};
  }
  write_review(path, std::move(review));
}

}  // namespace onmesh::tools
