#include "live_scene.h"

#include <cmath>
#include <filesystem>
#include <utility>

#include "../../format.h"
#include "../../messages.h"
#include "../../presets.h"
#include "../../shared_options.h"
#include "../review_maps.h"
#include "../scene_maps.h"
#include "../scene_mesh.h"
#include "../scene_surface.h"
#include "onmesh/measure/seam_edges.h"
#include "reduced_texture.h"

namespace onmesh::tools {
namespace {

/// The built page allows no network at all; a served one talks to where it came from.
std::string with_connection(std::string page) {
  constexpr std::string_view kNone = "connect-src 'none'", kOwn = "connect-src 'self'";
  if (const std::size_t at = page.find(kNone); at != std::string::npos)
    page.replace(at, kNone.size(), kOwn);
  return page;
}

std::string both_lengths(double length, double texel_size) {
  return format_number(length) + " mesh units, " + format_number(length / texel_size) + " texels";
}

nlohmann::json report_rows(const FilterReport& report, double seconds) {
  nlohmann::json rows = nlohmann::json::array();
  const auto add = [&](const char* name, std::string value) {
    if (!value.empty()) rows.push_back({name, std::move(value)});
  };
  add("sigma spatial", both_lengths(report.sigma_spatial, report.texel_size));
  add("radius", both_lengths(report.radius, report.texel_size));
  if (report.range_width > 0) add("width of the range weight", format_number(report.range_width));
  if (report.noise > 0) add("noise", format_number(report.noise));
  add("texels", format_count(report.texels));
  add("samples", format_count(report.samples));
  add("nodes", format_count(report.nodes));
  add("distances by", report.backend);
  add("sums by", report.method);
  add("time", format_seconds(seconds));
  return rows;
}

nlohmann::json presets_json() {
  nlohmann::json list = nlohmann::json::array();
  for (const Preset& preset : presets()) {
    nlohmann::json options = nlohmann::json::array();
    for (const PresetOption& option : preset.options)
      options.push_back({option.name, option.value});
    list.push_back({{"name", preset.name}, {"purpose", preset.purpose}, {"options", options}});
  }
  return list;
}

std::string size_text(const Image& image) {
  return std::to_string(image.width) + " × " + std::to_string(image.height);
}

}  // namespace

LiveScene::LiveScene(const std::vector<std::string>& words, const Arguments& arguments,
                     const RenderOptions& camera)
    : words_(words),
      mesh_(read_input_mesh(arguments.argument("mesh"), arguments)),
      distances_(mesh_) {
  Review review;
  review.title = std::filesystem::path(mesh_.path).filename().string();
  review.created = {"onmesh", "view"};
  review.created.insert(review.created.end(), arguments.as_given().begin(),
                        arguments.as_given().end());
  review.view_command = {"onmesh", "view"};
  review.view_command.insert(review.view_command.end(), words.begin(), words.end());
  review.camera = camera;
  review.mesh = &mesh_;
  review.wrap = wrap_of(arguments);
  review.tile_of_face.assign(mesh_.welded.faces.size(), kNone);
  read_textures();
  review.notes = textures_ ? textures_->inputs().warnings : mesh_.read.warnings;
  warn(review.notes);
  if (textures_) {
    review.after_names = {kPreviewName, kRunName};
    const std::vector<Image> none(textures_->inputs().images.size());
    add_input_maps(textures_->inputs(), {none, none}, review);
    const std::vector<Index> tiles = tiles_of_cleaned(review);
    local_ = mesh_with_local_uvs(review, mesh_.cleaned, tiles);
    std::vector<std::string> told_by_the_page;
    texels_ = texels_of(review, review.maps[0], local_, tiles, told_by_the_page);
    if (texels_) seams_ = find_seams(local_, *texels_).size();
    textures_->reduce(texels_.get());
    stamps_ = stamps_of(textures_->inputs());
  }
  review.live = live_json(review);
  PageWriter page;
  nlohmann::json scene = make_scene(std::move(review), page);
  if (textures_) {
    nlohmann::json& reduced = scene["live"]["reduced"];
    bool is_reduced = false;
    for (const Image& image : textures_->inputs().images) is_reduced |= reduction_of(image) > 1;
    if (is_reduced) reduced = images_json(textures_->reduced(), page);
  }
  page_ = with_connection(page.page(scene));
}

void LiveScene::read_textures() {
  try {
    textures_ = std::make_unique<LiveTextures>(words_);
  } catch (const OptionError&) {
    throw;
  } catch (const FileError&) {
    throw;
  } catch (const std::exception& error) {
    // Without -t the shape alone is worth seeing; what was named must fit.
    bool has_uvs = false;
    for (Index f = 0; f < mesh_.welded.faces.size(); ++f) has_uvs |= mesh_.welded.has_uvs(f);
    const bool is_named = std::find(words_.begin(), words_.end(), "--texture") != words_.end();
    if (has_uvs && is_named) throw;
    why_no_textures_ = error.what();
  }
}

nlohmann::json LiveScene::live_json(const Review& review) const {
  nlohmann::json live;
  live["command"] = {"onmesh", "filter"};
  for (const std::string& word : words_) live["command"].push_back(word);
  live["why_no_textures"] = why_no_textures_;
  live["diagonal"] = mesh_.cleaned.diagonal();
  live["texel_size"] = textures_ ? textures_->texel_size() : 0;
  live["presets"] = presets_json();
  live["reduced"] = nullptr;
  if (review.maps.empty()) return live;
  const Image& first = textures_->inputs().images[0];
  live["size"] = size_text(first);
  live["preview_size"] = size_text(textures_->reduced()[0]);
  const std::filesystem::path file = review.maps[0].files[0];
  const bool has_several = review.tiles.size() > 1;
  std::string name = has_several ? "{stem}" : file.stem().string();
  name += "-filtered";
  name += file.has_extension() ? file.extension().string() : ".png";
  live["save_name"] = name;
  return live;
}

LiveTextures& LiveScene::textures(const Arguments& arguments) {
  if (!textures_) throw InputError(why_no_textures_);
  const Preset* const preset = preset_of(arguments);
  if (preset == nullptr || !preset->is_data) return *textures_;
  if (!data_) {
    std::vector<std::string> words = words_;
    words.emplace_back("--preset");
    words.emplace_back(preset->name);
    data_ = std::make_unique<LiveTextures>(words);
    data_->reduce(texels_.get());
  }
  return *data_;
}

double LiveScene::length_of(const Length& length) const {
  const double texel = textures_ ? textures_->texel_size() : 0;
  if (length.unit == Length::Unit::texel && !(texel > 0))
    throw UsageError("--spacing: there are no texels to measure with");
  return resolve(length, texel, mesh_.cleaned.diagonal());
}

nlohmann::json LiveScene::images_json(const std::vector<Image>& images, PageWriter& page) const {
  std::vector<std::string> notes_of_the_page;
  nlohmann::json list = nlohmann::json::array();
  for (std::size_t i = 0; i < images.size(); ++i) {
    nlohmann::json json = scene_image(images[i], "", page, notes_of_the_page);
    json["full_width"] = textures_->inputs().images[i].width;
    json["full_height"] = textures_->inputs().images[i].height;
    list.push_back(std::move(json));
  }
  return list;
}

std::string LiveScene::preview_answer(const LiveResult& result, double seconds) const {
  PageWriter page(PageWriter::Effort::quick);
  const nlohmann::json part{{"images", images_json(result.images, page)},
                            {"rows", report_rows(result.report, seconds)},
                            {"warnings", result.report.warnings}};
  return page.answer(part);
}

std::string LiveScene::run_answer(const LiveResult& result, double seconds) const {
  PageWriter page(PageWriter::Effort::quick);
  ReviewMap map;
  map.before = textures_->inputs().images;
  map.after.push_back(result.images);
  for (Image& image : map.after[0]) round_to_codes(image);
  nlohmann::json part{{"images", images_json(map.after[0], page)},
                      {"rows", report_rows(result.report, seconds)},
                      {"warnings", result.report.warnings},
                      {"numbers", map_numbers(map, 0, local_, texels_.get())},
                      {"seam_errors", nullptr}};
  if (texels_) part["seam_errors"] = page.add(seam_errors(map.after[0], local_, *texels_, seams_));
  return page.answer(part);
}

}  // namespace onmesh::tools
