#include "info_findings.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <string_view>
#include <utility>

#include "atlas.h"
#include "colour_spaces.h"
#include "filtered_channels.h"
#include "flags.h"
#include "format.h"
#include "interruption.h"
#include "messages.h"
#include "onmesh/atlas/uv_overlap.h"
#include "onmesh/base/face_error.h"
#include "onmesh/base/text.h"
#include "onmesh/mesh/coarse_coordinates.h"
#include "onmesh/mesh_io/write_gltf.h"
#include "shared_options.h"

namespace onmesh::tools {
namespace {

/// Tiles beside each other use their texels once, though their UVs agree but for whole numbers.
void measure_overlap(const Atlas& atlas, MeshReport& report) {
  TriangleMesh by_tile = atlas.mesh;
  by_tile.materials.clear();
  for (const SetTexture& texture : atlas.set.textures)
    by_tile.materials.push_back({texture.path.string(), texture.path.string()});
  by_tile.face_materials = atlas.set.tile_of_face;
  const UvOverlap overlap = estimate_overlap(by_tile);
  report.overlap_share = overlap.share;
  report.max_overlap = overlap.deepest;
}

/// The facts of every tile of an atlas.
std::vector<TextureFacts> measure(const InputMesh& input, const Atlas& atlas, Findings& findings) {
  const TexelMap map = with_face_numbers(input.cleaning.kept, [&] { return atlas.map(); });
  const std::vector<Index> overlapped = map.overlapped(), crowded = map.crowded();
  const std::vector<const Image*> images = atlas.image_pointers();
  std::vector<TextureFacts> all;
  for (Index i = 0; i < map.tiles.size(); ++i) {
    const TexelTile& tile = map.tiles[i];
    const auto in_tile = [&](const std::vector<Index>& texels) {
      return std::uint64_t(
          std::lower_bound(texels.begin(), texels.end(), tile.first + tile.size()) -
          std::lower_bound(texels.begin(), texels.end(), tile.first));
    };
    TextureFacts facts;
    facts.path = atlas.set.textures[i].path.string();
    facts.width = tile.width;
    facts.height = tile.height;
    for (Index t = tile.first; t < tile.first + tile.size(); ++t) {
      facts.covered += map.coverage[t] == Coverage::covered;
      facts.touched += map.coverage[t] == Coverage::touched;
    }
    facts.overlapped = in_tile(overlapped);
    facts.crowded = in_tile(crowded);
    if (facts.covered > 0) facts.texel_size = map.median_texel_size(i);
    if (!images.empty()) {
      facts.channels = images[i]->channels;
      facts.seams = seam_error(atlas.mesh, map, images, i);
    }
    all.push_back(std::move(facts));
  }
  std::vector<double> texel_size;
  for (const double area : map.texel_area) texel_size.push_back(std::sqrt(area));
  findings.near = find_near_boundaries(atlas.mesh, texel_size);
  if (images.size() > 1) {
    findings.seams = seam_error(atlas.mesh, map, images);
    measure_overlap(atlas, findings.mesh);
  }
  return all;
}

/// What there is to tell if the textures cannot be read: about the first that materials name.
std::vector<TextureFacts> troubled_textures(const InputMesh& input, const std::string& trouble) {
  TextureFacts facts;
  facts.trouble = trouble;
  for (const Material& material : input.cleaned.materials) {
    if (material.texture.empty()) continue;
    facts.path = material.texture;
    break;
  }
  return {facts};
}

/// Channels that differ keep the filter from taking the textures as one map.
void check_channels(const Atlas& atlas, Findings& findings) {
  for (std::size_t i = 1; i < atlas.images.size(); ++i) {
    if (atlas.images[i].channels == atlas.images[0].channels) continue;
    findings.refusal = atlas.set.textures[i].path.string() + " and " +
                       atlas.set.textures[0].path.string() + " have different channels";
    return;
  }
}

/// Of the textures or resolution that were given, else of all that the materials name. What is
/// wrong with those is a finding, not a failure.
void examine_textures(const InputMesh& input, const Arguments& arguments, Findings& findings) {
  const bool is_given = has_atlas_option(arguments);
  try {
    const auto choose = [&] {
      TextureRequest request;
      request.confined_to = confining_folder(arguments);
      return choose_textures(input.cleaned, request);
    };
    Atlas atlas = is_given ? read_atlas(arguments, input.cleaned)
                           : read_atlas(explained_by(input.read.warnings, choose), input.cleaned,
                                        wrap_of(arguments));
    findings.missing = atlas.set.warnings;
    findings.warnings = atlas.warnings;
    check_interrupted();
    // What is filtered may be some of the channels; what is told is of the file.
    std::vector<int> channels;
    std::vector<ColourSpaceChoice> spaces;
    std::vector<std::string> names;
    const bool has_slot = is_gltf_name(input.path) && !is_given;
    ColourSpaceRequest request = colour_space_request_of_slot(slot_of(arguments), has_slot);
    for (std::size_t i = 0; i < atlas.images.size(); ++i) {
      channels.push_back(atlas.images[i].channels);
      names.push_back(atlas.set.textures[i].path.string());
      request.role = atlas.set.textures[i].role;
      spaces.push_back(choose_colour_space(atlas.images[i], request));
    }
    FilteredChannels filtered =
        choose_channels({slot_of(arguments), "", {}}, atlas.images, names, findings.warnings);
    if (!filtered.parts.empty()) atlas.images = std::move(filtered.parts);
    check_channels(atlas, findings);
    if (findings.refusal.empty()) findings.textures = measure(input, atlas, findings);
    for (std::size_t i = 0; i < std::min(channels.size(), findings.textures.size()); ++i)
      findings.textures[i].channels = channels[i];
    for (std::size_t i = 0; i < std::min(spaces.size(), findings.textures.size()); ++i) {
      findings.textures[i].colour_space = spaces[i].name;
      findings.textures[i].colour_space_reason = spaces[i].reason;
    }
  } catch (const UsageError& error) {
    if (is_given) throw;
    findings.refusal = error.what();
  } catch (const FileError& error) {
    if (is_given) throw;
    findings.textures = troubled_textures(input, error.what());
  } catch (const InputError& error) {
    findings.textures = troubled_textures(input, error.what());
  }
}

// What filter refuses before it starts.
std::string find_refusal(const Findings& findings) {
  if (findings.mesh.faces_without_uvs == findings.mesh.faces) return "no face has UVs";
  if (findings.mesh.charts == 0 || findings.mesh.density_max == 0)
    return "no face has both UVs with an area and an area on the surface";
  std::uint64_t covered = 0;
  for (const TextureFacts& facts : findings.textures) {
    if (!facts.trouble.empty()) return facts.trouble;
    covered += facts.covered;
  }
  if (!findings.textures.empty() && covered == 0) return "no texel is covered";
  return findings.refusal;
}

std::vector<std::string> find_problems(const Findings& findings) {
  const MeshReport& r = findings.mesh;
  const bool lost = std::any_of(findings.textures.begin(), findings.textures.end(),
                                [](const TextureFacts& facts) { return !facts.trouble.empty(); });
  const std::pair<const char*, bool> all[] = {{"nonmanifold_edges", r.nonmanifold_edges > 0},
                                              {"nonmanifold_vertices", r.nonmanifold_vertices > 0},
                                              {"not_orientable", !r.orientable},
                                              {"inconsistent_edges", r.inconsistent_edges > 0},
                                              {"degenerate_faces", r.degenerate_faces > 0},
                                              {"duplicate_faces", r.duplicate_faces > 0},
                                              {"faces_without_uvs", r.faces_without_uvs > 0},
                                              {"degenerate_uvs", r.degenerate_uvs > 0},
                                              {"overlap", r.overlap_share > 0.001},
                                              {"textures", lost || !findings.missing.empty()},
                                              {"refused", !findings.refusal.empty()}};
  std::vector<std::string> problems;
  for (const auto& [name, is_there] : all) {
    if (is_there) problems.emplace_back(name);
  }
  return problems;
}

/// What a file's name says that it holds, against the colour space that it would be read in; empty
/// if it says nothing. Names decide nothing: they are only told.
std::string advice_by_name(const TextureFacts& facts) {
  if (facts.colour_space.empty() || facts.colour_space == "data" || facts.colour_space == "raw")
    return {};
  const std::string stem = lower_case(std::filesystem::path(facts.path).stem().string());
  const auto ends_in = [&](std::initializer_list<std::string_view> words) {
    return std::any_of(words.begin(), words.end(), [&](std::string_view word) {
      if (stem.size() <= word.size() || !stem.ends_with(word)) return false;
      const char before = stem[stem.size() - word.size() - 1];
      return before == '_' || before == '-' || before == '.';
    });
  };
  if (ends_in({"n", "nor", "nrm", "normal", "normals"})) {
    return facts.path +
           " has the name of a normal map: the mean of their codes is no normal, so "
           "it should not be filtered";
  }
  if (facts.colour_space != "linear" &&
      ends_in({"rough", "roughness", "metal", "metallic", "metalness", "ao", "occlusion", "height",
               "disp", "displacement", "gloss", "mask", "orm", "arm"})) {
    return facts.path + " has the name of a map of numbers, and would be taken for colours in " +
           facts.colour_space + ": give -t " + facts.path + "@data";
  }
  return {};
}

std::vector<std::string> find_advice(const InputMesh& input, const Findings& findings) {
  std::vector<std::string> lines = advice(findings.mesh);
  if (!findings.coarse.empty()) lines.push_back(findings.coarse);
  if (const Index refused = input.joining.refused_edges; refused > 0) {
    lines.push_back(std::to_string(refused) +
                    " boundary edges lie within the tolerance of several others, or of chains of "
                    "them: they are not joined");
  }
  if (const Index fins = input.cleaning.fins; fins > 0) {
    lines.push_back(
        std::to_string(fins) +
        " faces are fins, pairs back to back that stick out from the surface: filtering leaves "
        "them out, so remove them if they are not meant to be there");
  }
  for (const std::string& line : findings.missing) lines.push_back(line);
  if (findings.near.edges > 0) lines.push_back(in_flags(findings.near.text()));
  for (const TextureFacts& facts : findings.textures) {
    if (!facts.trouble.empty()) lines.push_back("texture " + facts.trouble);
    if (std::string line = advice_by_name(facts); !line.empty()) lines.push_back(std::move(line));
    if (facts.crowded > 0) {
      lines.push_back(format_count(facts.crowded) + " texels " +
                      (facts.path.empty() ? "" : "of " + facts.path + " ") +
                      "lie directly beside another chart's: look-ups there mix both, so "
                      "leave at least 2 texels between charts");
    }
  }
  return lines;
}

}  // namespace

Findings examine(const InputMesh& input, const Arguments& arguments) {
  Findings findings;
  findings.mesh = report_mesh(input.joined);
  findings.coarse = find_coarse_coordinates(input.as_read, input.welded).problem;
  check_interrupted();
  examine_textures(input, arguments, findings);
  check_interrupted();
  findings.refusal = find_refusal(findings);
  findings.problems = find_problems(findings);
  findings.advice = find_advice(input, findings);
  return findings;
}

}  // namespace onmesh::tools
