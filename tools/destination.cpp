#include "destination.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "detail_images.h"
#include "gltf_results.h"
#include "interruption.h"
#include "onmesh/base/error.h"
#include "onmesh/image/image_io.h"
#include "onmesh/mesh_io/write_gltf.h"
#include "report.h"

namespace onmesh::tools {
namespace {

using nlohmann::json;

json texture_json(const SurfaceInputs& inputs, std::size_t i) {
  const SetTexture& file = inputs.set.textures[i];
  const Image& image = inputs.images[i];
  return {{"path", file.path.string()},
          {"reason", inputs.set.reason},
          {"width", image.width},
          {"height", image.height},
          {"channels", image.channels},
          {"colour_space", inputs.spaces[i].name},
          {"colour_space_reason", inputs.spaces[i].reason}};
}

/// All options with their values in force.
json options_json(const Arguments& arguments) {
  json options = json::object();
  for (const auto& [name, value] : arguments.values()) {
    if (const auto* text_value = boost::any_cast<std::string>(&value.value())) {
      options[name] = *text_value;
    } else if (const auto* list = boost::any_cast<std::vector<std::string>>(&value.value())) {
      options[name] = list->size() == 1 ? json(list->front()) : json(*list);
    } else {
      options[name] = arguments.flag(name);
    }
  }
  return options;
}

}  // namespace

Destination::Destination(const Arguments& arguments, const std::string& output,
                         const SurfaceInputs& inputs)
    : output_(output) {
  if (is_gltf()) {
    results_ = name_gltf_outputs(inputs.set, inputs.meshes(), inputs.mesh_path, output);
  } else if (!output.empty()) {
    results_ = name_outputs(inputs.set, output);
  }
  if (arguments.has("detail-out"))
    details_ = name_details(inputs.set, arguments.text("detail-out"), results_, inputs.mesh_path);
  if (!results_.folder.empty()) folder_.emplace(results_.folder);
  if (!details_.folder.empty()) details_folder_.emplace(details_.folder);
  check(inputs);
}

bool Destination::is_gltf() const { return is_gltf_name(output_); }

std::string Destination::path_of(std::size_t texture) const {
  return results_.paths.empty() ? "" : results_.paths[texture].string();
}

void Destination::check(const SurfaceInputs& inputs) const {
  for (std::size_t i = 0; i < results_.paths.size() && !is_gltf(); ++i) {
    const std::filesystem::path& output = results_.paths[i];
    if (output.empty()) continue;
    std::error_code error;
    if (output == inputs.mesh_path ||
        std::filesystem::equivalent(output, inputs.mesh_path, error)) {
      throw UsageError("--output: " + output.string() + " is the mesh");
    }
    check_writable_image(output, inputs.images[i]);
  }
  for (std::size_t i = 0; i < details_.paths.size(); ++i) {
    const Image& image = inputs.images[i];
    if (!details_.paths[i].empty())
      check_writable_image(details_.paths[i],
                           make_image(image.width, image.height, image.channels));
  }
}

std::vector<Image> Destination::details_of(const std::vector<Image>& results,
                                           const SurfaceInputs& inputs) const {
  std::vector<Image> details;
  for (std::size_t i = 0; i < details_.paths.size(); ++i) {
    details.emplace_back();
    if (details_.paths[i].empty()) continue;
    const auto& written =
        is_gltf() || output_.empty() ? inputs.set.textures[i].path : results_.paths[i];
    details.back() = detail_of(inputs.images[i], results[i], written);
    check_interrupted();
  }
  return details;
}

void Destination::write(const std::vector<Image>& results, SurfaceInputs& inputs) {
  const std::vector<Image> details = details_of(results, inputs);
  std::vector<ImageFile> files;
  const auto add = [&](const OutputNames& names, const std::vector<Image>& images) {
    for (std::size_t i = 0; i < images.size(); ++i)
      if (!names.paths[i].empty()) files.push_back({names.paths[i], &images[i]});
  };
  if (is_gltf()) {
    write_into_gltf(output_, inputs.mesh_path, inputs.set, inputs.images, results, inputs.warnings);
  } else {
    add(results_, results);
  }
  add(details_, details);
  write_images(files, {}, &inputs.warnings);
  if (folder_) folder_->keep();
  if (details_folder_) details_folder_->keep();
}

json start_report(const char* command, const Arguments& arguments, const SurfaceInputs& inputs,
                  const Destination& to) {
  json out = new_report(command);
  out["mesh"] = inputs.mesh_path;
  out["options"] = options_json(arguments);
  out["textures"] = json::array();
  for (std::size_t i = 0; i < inputs.images.size(); ++i) {
    json one = texture_json(inputs, i);
    const SetTexture& file = inputs.set.textures[i];
    one["map"] = text_or_null(file.map);
    one["udim"] = file.udim > 0 ? json(file.udim) : json();
    one["material"] = text_or_null(file.material);
    one["output"] = text_or_null(to.path_of(i));
    out["textures"].push_back(std::move(one));
  }
  // As long as there is only one.
  out["texture"] = inputs.images.size() == 1 ? texture_json(inputs, 0) : json();
  out["output"] = text_or_null(arguments.has("output") ? arguments.text("output") : "");
  return out;
}

}  // namespace onmesh::tools
