#include "info_findings.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "flags.h"
#include "format.h"
#include "interruption.h"
#include "messages.h"
#include "onmesh/image/image_io.h"
#include "onmesh/mesh/coarse_coordinates.h"

namespace onmesh::tools {
namespace {

std::vector<std::string> named_textures(const TriangleMesh& mesh) {
  std::vector<bool> used(mesh.materials.size(), false);
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (mesh.face_materials[f] != kNone && mesh.has_uvs(f)) used[mesh.face_materials[f]] = true;
  }
  std::vector<std::string> names;
  for (std::size_t m = 0; m < used.size(); ++m) {
    const std::string& name = mesh.materials[m].texture;
    if (used[m] && !name.empty() && std::find(names.begin(), names.end(), name) == names.end())
      names.push_back(name);
  }
  return names;
}

std::vector<bool> faces_with_texture(const TriangleMesh& mesh, const std::string& texture) {
  std::vector<bool> faces(mesh.faces.size(), false);
  for (Index f = 0; f < faces.size(); ++f) {
    const Index material = mesh.face_materials[f];
    faces[f] = material != kNone && mesh.materials[material].texture == texture && mesh.has_uvs(f);
  }
  return faces;
}

void measure(const InputMesh& input, const Atlas& atlas, TextureFacts& facts) {
  const TriangleMesh& mesh = input.cleaned;
  facts.width = atlas.width;
  facts.height = atlas.height;
  facts.channels = atlas.image.channels;
  const TexelMap map = with_face_numbers(input.cleaning.kept, [&] {
    return make_texel_map(mesh, atlas.width, atlas.height, atlas.map);
  });
  for (const Coverage c : map.coverage) {
    facts.covered += c == Coverage::covered;
    facts.touched += c == Coverage::touched;
  }
  facts.overlapped = map.overlapped().size();
  facts.crowded = map.crowded().size();
  if (facts.covered > 0) facts.texel_size = map.median_texel_size();
  std::vector<double> texel_size;
  for (const double area : map.texel_area) texel_size.push_back(std::sqrt(area));
  facts.near = find_near_boundaries(mesh, texel_size);
  if (facts.channels > 0) facts.seams = seam_error(mesh, map, atlas.image);
}

/// Facts that `find` sets. Whatever it meets is a finding, not a failure.
TextureFacts facts_on(const std::string& path, const std::function<void(TextureFacts&)>& find) {
  TextureFacts facts;
  facts.path = path;
  try {
    find(facts);
  } catch (const FileError& error) {
    facts.trouble = error.what();
  } catch (const InputError& error) {
    facts.trouble = error.what();
  }
  return facts;
}

/// Of the texture or resolution that was given, else of all that the materials name.
std::vector<TextureFacts> examine_textures(const InputMesh& input, const Arguments& arguments) {
  std::vector<TextureFacts> textures;
  if (has_atlas_option(arguments)) {
    const Atlas atlas = read_atlas(arguments, input.cleaned);
    textures.push_back(
        facts_on(atlas.texture, [&](TextureFacts& facts) { measure(input, atlas, facts); }));
    return textures;
  }
  for (const std::string& name : named_textures(input.cleaned)) {
    check_interrupted();
    textures.push_back(facts_on(name, [&](TextureFacts& facts) {
      Atlas atlas;
      atlas.image = read_texture(name);
      atlas.width = atlas.image.width;
      atlas.height = atlas.image.height;
      atlas.map = {wrap_of(arguments), faces_with_texture(input.cleaned, name)};
      measure(input, atlas, facts);
    }));
  }
  return textures;
}

// What filter refuses before it starts.
std::string find_refusal(const Findings& findings) {
  if (findings.mesh.faces_without_uvs == findings.mesh.faces) return "no face has UVs";
  if (findings.mesh.charts == 0 || findings.mesh.density_max == 0)
    return "no face has both UVs with an area and an area on the surface";
  for (const TextureFacts& facts : findings.textures) {
    if (facts.trouble.empty() && facts.covered > 0) return {};
  }
  if (findings.textures.empty()) return {};
  return findings.textures[0].trouble.empty() ? "no texel is covered"
                                              : findings.textures[0].trouble;
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
                                              {"textures", lost},
                                              {"refused", !findings.refusal.empty()}};
  std::vector<std::string> problems;
  for (const auto& [name, is_there] : all) {
    if (is_there) problems.emplace_back(name);
  }
  return problems;
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
  if (findings.textures.size() > 1) {
    lines.push_back("the materials name " + std::to_string(findings.textures.size()) +
                    " textures: filter them one at a time, chosen with -t or --material");
  }
  for (const TextureFacts& facts : findings.textures) {
    if (!facts.trouble.empty()) lines.push_back("texture " + facts.trouble);
    if (facts.near.edges > 0) lines.push_back(in_flags(facts.near.text()));
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
  findings.textures = examine_textures(input, arguments);
  check_interrupted();
  findings.refusal = find_refusal(findings);
  findings.problems = find_problems(findings);
  findings.advice = find_advice(input, findings);
  return findings;
}

}  // namespace onmesh::tools
