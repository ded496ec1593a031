// onmesh info: what is special or wrong about a mesh, its atlas and its textures.
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>

#include "command.h"
#include "inputs.h"
#include "onmesh/base/text.h"
#include "onmesh/image/image_io.h"
#include "onmesh/measure/mesh_report.h"
#include "onmesh/measure/seam_error.h"

namespace onmesh::tools {
namespace {

Command make_command() {
  Command command;
  command.name = "info";
  command.synopsis = "MESH [-t TEXTURE | --resolution WxH] [options]";
  command.summary =
      "Examines a mesh, its atlas and its textures: counts, texels, seams, what is wrong and what\n"
      "to do about it, and whether filter will take it. Without -t it looks at every texture that\n"
      "the mesh's materials name.";
  command.examples =
      "  onmesh info cube.obj\n"
      "  onmesh info scan.obj -t scan.png --json\n"
      "  onmesh info scan.obj --resolution 4096x4096 --strict\n";
  command.options.add_options()("mesh", text());
  add_atlas_options(command.options);
  auto add = command.options.add_options();
  add("strict", flag(), "exit with 1 if there is anything to repair");
  add("json", flag(), "the findings as JSON on stdout");
  command.positional.add("mesh", 1);
  return command;
}

// What the atlas means at one texture's size.
struct TextureFacts {
  std::string path;     // empty for --resolution
  std::string trouble;  // why there is nothing else to tell
  int width = 0, height = 0, channels = 0;
  std::uint64_t covered = 0, touched = 0, overlapped = 0, crowded = 0;
  double texel_size = 0;
  std::optional<SeamError> seams;
};

void measure(const TriangleMesh& mesh, const Atlas& atlas, TextureFacts& facts) {
  facts.width = atlas.width;
  facts.height = atlas.height;
  facts.channels = atlas.image.channels;
  const TexelMap map = make_texel_map(mesh, atlas.width, atlas.height, atlas.map);
  for (const Coverage c : map.coverage) {
    facts.covered += c == Coverage::covered;
    facts.touched += c == Coverage::touched;
  }
  facts.overlapped = map.overlapped().size();
  facts.crowded = map.crowded().size();
  if (facts.covered > 0) facts.texel_size = map.median_texel_size();
  if (facts.channels > 0) facts.seams = seam_error(mesh, map, atlas.image);
}

// The findings on one mesh file.
struct Findings {
  MeshReport mesh;
  std::vector<TextureFacts> textures;
  std::vector<std::string> advice;
  std::vector<std::string> problems;  // short fixed names of what --strict minds
  std::string refusal;                // why filter will not take it; empty if it will
};

void examine_textures(const InputMesh& input, const po::variables_map& values, Findings& findings) {
  if (has_atlas_option(values)) {
    const Atlas atlas = read_atlas(values, input.cleaned);
    TextureFacts facts;
    facts.path = atlas.texture;
    try {
      measure(input.cleaned, atlas, facts);
    } catch (const InputError& error) {
      facts.trouble = error.what();
    }
    findings.textures.push_back(std::move(facts));
    return;
  }
  // One material's lost texture is a finding, not a failure.
  for (const std::string& name : named_textures(input.cleaned)) {
    check_interrupted();
    TextureFacts facts;
    facts.path = name;
    try {
      Atlas atlas;
      atlas.image = read_image(name);
      atlas.width = atlas.image.width;
      atlas.height = atlas.image.height;
      atlas.map = {wrap_of(values), faces_with_texture(input.cleaned, name)};
      measure(input.cleaned, atlas, facts);
    } catch (const FileError& error) {
      facts.trouble = error.what();
    } catch (const InputError& error) {
      facts.trouble = error.what();
    }
    findings.textures.push_back(std::move(facts));
  }
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

void find_problems(const InputMesh& input, Findings& findings) {
  const MeshReport& r = findings.mesh;
  const auto add = [&](bool there, const char* name) {
    if (there) findings.problems.emplace_back(name);
  };
  add(r.nonmanifold_edges > 0, "nonmanifold_edges");
  add(r.nonmanifold_vertices > 0, "nonmanifold_vertices");
  add(!r.orientable, "not_orientable");
  add(r.inconsistent_edges > 0, "inconsistent_edges");
  add(r.degenerate_faces > 0, "degenerate_faces");
  add(r.duplicate_faces > 0, "duplicate_faces");
  add(r.faces_without_uvs > 0, "faces_without_uvs");
  add(r.degenerate_uvs > 0, "degenerate_uvs");
  add(r.overlap_share > 0.001, "overlap");
  bool lost = false;
  for (const TextureFacts& facts : findings.textures) lost |= !facts.trouble.empty();
  add(lost, "textures");
  add(!findings.refusal.empty(), "refused");

  findings.advice = advice(r);
  const CleanReport& c = input.cleaning;
  if (c.fins > 0) {
    findings.advice.push_back(
        std::to_string(c.fins) +
        " faces are fins, pairs back to back that stick out from the surface: filtering leaves "
        "them out, so remove them if they are not meant to be there");
  }
  if (findings.textures.size() > 1) {
    findings.advice.push_back("the materials name " + std::to_string(findings.textures.size()) +
                              " textures: filter them one at a time, chosen with -t or --material");
  }
  for (const TextureFacts& facts : findings.textures) {
    if (!facts.trouble.empty()) findings.advice.push_back("texture " + facts.trouble);
    if (facts.crowded > 0) {
      findings.advice.push_back(format_count(facts.crowded) + " texels " +
                                (facts.path.empty() ? "" : "of " + facts.path + " ") +
                                "lie directly beside another chart's: look-ups there mix both, so "
                                "leave at least 2 texels between charts");
    }
  }
}

nlohmann::json to_json(const TextureFacts& t) {
  nlohmann::json json;
  json["path"] = t.path.empty() ? nlohmann::json() : nlohmann::json(t.path);
  json["error"] = t.trouble.empty() ? nlohmann::json() : nlohmann::json(t.trouble);
  json["width"] = t.width;
  json["height"] = t.height;
  json["channels"] = t.channels;
  json["covered"] = t.covered;
  json["touched"] = t.touched;
  json["overlapped"] = t.overlapped;
  json["crowded"] = t.crowded;
  json["texel_size"] = t.texel_size;
  json["seams"] = nullptr;
  if (t.seams) {
    json["seams"] = {{"edges", t.seams->edges},
                     {"length", t.seams->length},
                     {"rms", t.seams->rms},
                     {"max", t.seams->max}};
  }
  return json;
}

void print_json(const InputMesh& input, const Findings& findings) {
  const MeshReport& r = findings.mesh;
  nlohmann::json json = new_report("info");
  json["mesh"] = input.path;
  json["vertices_in_file"] = input.as_read.positions.size();
  json["vertices"] = r.vertices;
  json["faces"] = r.faces;
  json["components"] = r.components;
  json["boundary_edges"] = r.boundary_edges;
  json["boundary_loops"] = r.boundary_loops;
  json["nonmanifold_edges"] = r.nonmanifold_edges;
  json["nonmanifold_vertices"] = r.nonmanifold_vertices;
  json["inconsistent_edges"] = r.inconsistent_edges;
  json["orientable"] = r.orientable;
  json["manifold"] = r.manifold();
  json["degenerate_faces"] = r.degenerate_faces;
  json["duplicate_faces"] = r.duplicate_faces;
  json["surface_area"] = r.surface_area;
  json["diagonal"] = r.diagonal;
  json["mean_edge"] = input.welded.mean_edge_length();
  json["charts"] = r.charts;
  json["faces_without_uvs"] = r.faces_without_uvs;
  json["degenerate_uvs"] = r.degenerate_uvs;
  json["mirrored_faces"] = r.mirrored_faces;
  json["overlap_share"] = r.overlap_share;
  json["max_overlap"] = r.max_overlap;
  json["uv_min"] = {r.uv_min.x(), r.uv_min.y()};
  json["uv_max"] = {r.uv_max.x(), r.uv_max.y()};
  json["density_min"] = r.density_min;
  json["density_max"] = r.density_max;
  json["cleaning"] = {
      {"collapsed", input.cleaning.collapsed}, {"duplicates", input.cleaning.duplicates},
      {"separated", input.cleaning.separated}, {"fins", input.cleaning.fins},
      {"flat", input.cleaning.flat},           {"flipped", input.cleaning.flipped}};
  json["materials"] = nlohmann::json::array();
  for (const Material& m : input.welded.materials) {
    std::error_code error;
    json["materials"].push_back(
        {{"name", m.name},
         {"texture", m.texture.empty() ? nlohmann::json() : nlohmann::json(m.texture)},
         {"texture_exists", std::filesystem::is_regular_file(m.texture, error)}});
  }
  json["textures"] = nlohmann::json::array();
  for (const TextureFacts& t : findings.textures) json["textures"].push_back(to_json(t));
  json["warnings"] = input.warnings;
  json["advice"] = findings.advice;
  json["problems"] = findings.problems;
  json["filterable"] = findings.refusal.empty();
  json["refusal"] = findings.refusal.empty() ? nlohmann::json() : nlohmann::json(findings.refusal);
  print_report(std::move(json));
}

void row(const std::string& name, const std::string& value) {
  std::cout << "  " << std::left << std::setw(20) << name << value << '\n';
}

std::string percent(double share) { return format_number(100 * share) + " %"; }

void print_texture(const TextureFacts& t) {
  std::cout << (t.path.empty() ? "at " : "texture " + t.path + ", ") << t.width << " x "
            << t.height;
  if (t.channels > 0)
    std::cout << ", " << count_text(std::uint64_t(t.channels), "channel", "channels");
  std::cout << '\n';
  const double texels = double(t.width) * t.height;
  row("covered texels", format_count(t.covered) + " (" + percent(double(t.covered) / texels) + ")");
  row("touched texels", format_count(t.touched));
  row("crowded texels", format_count(t.crowded));
  row("overlapped texels", format_count(t.overlapped));
  row("texel size", format_number(t.texel_size) + " mesh units (median)");
  if (!t.seams) return;
  row("seams",
      format_count(t.seams->edges) + " edges, " + format_number(t.seams->length) + " mesh units");
  row("seam error", "rms " + format_number(t.seams->rms) + ", max " + format_number(t.seams->max));
}

void print_text(const InputMesh& input, const Findings& findings) {
  const MeshReport& r = findings.mesh;
  std::cout << "mesh " << input.path << '\n';
  const std::size_t in_file = input.as_read.positions.size();
  row("vertices",
      format_count(r.vertices) +
          (in_file != r.vertices ? " (" + format_count(in_file) + " in the file)" : ""));
  row("triangles", format_count(r.faces));
  row("components", format_count(r.components));
  row("boundary",
      format_count(r.boundary_edges) + " edges, " + format_count(r.boundary_loops) + " loops");
  row("non-manifold", format_count(r.nonmanifold_edges) + " edges, " +
                          format_count(r.nonmanifold_vertices) + " vertices");
  row("winding", !r.orientable ? "cannot be made consistent"
                 : r.inconsistent_edges > 0
                     ? format_count(r.inconsistent_edges) + " edges with faces of opposite winding"
                     : "consistent");
  row("degenerate faces", format_count(r.degenerate_faces));
  row("duplicate faces", format_count(r.duplicate_faces));
  row("surface area", format_number(r.surface_area));
  row("diagonal", format_number(r.diagonal));
  row("mean edge", format_number(input.welded.mean_edge_length()));
  const CleanReport& c = input.cleaning;
  if (c.collapsed + c.duplicates + c.fins + c.flat + c.flipped > 0) {
    row("filtering", "leaves out " + format_count(c.collapsed) + " collapsed, " +
                         format_count(c.duplicates) + " duplicate, " + format_count(c.fins) +
                         " fin and " + format_count(c.flat) + " flat faces, turns over " +
                         format_count(c.flipped));
  }
  if (c.separated > 0) {
    row("layers", format_count(c.separated) + " faces are filtered as sheets of their own");
  }
  if (!c.manifold()) row("nodes", "in pieces put together: " + c.defects());
  std::cout << "atlas\n";
  row("charts", format_count(r.charts));
  row("without UVs", format_count(r.faces_without_uvs) + " faces");
  row("UVs without area", format_count(r.degenerate_uvs) + " faces");
  row("mirrored", format_count(r.mirrored_faces) + " faces");
  row("used more than once", r.max_overlap < 2 ? "nothing"
                                               : percent(r.overlap_share) + " (up to " +
                                                     format_count(r.max_overlap) + " times)");
  row("UV range", format_number(r.uv_min.x()) + ".." + format_number(r.uv_max.x()) + " x " +
                      format_number(r.uv_min.y()) + ".." + format_number(r.uv_max.y()));
  row("density", format_number(r.density_min) + ".." + format_number(r.density_max) +
                     " tiles per mesh unit (1 % to 99 % of the surface)");
  if (!input.welded.materials.empty()) std::cout << "materials\n";
  for (const Material& m : input.welded.materials) {
    std::error_code error;
    const bool there = std::filesystem::is_regular_file(m.texture, error);
    row(m.name, m.texture.empty() ? "no texture" : m.texture + (there ? "" : " (missing)"));
  }
  for (const TextureFacts& t : findings.textures) {
    if (t.trouble.empty()) print_texture(t);
  }
  if (!findings.advice.empty()) std::cout << "advice\n";
  for (const std::string& line : findings.advice) std::cout << "  - " << line << '\n';
  if (findings.refusal.empty())
    std::cout << "filter will take it\n";
  else
    std::cout << "filter will refuse it: " << findings.refusal << '\n';
}

}  // namespace

int run_info(const std::vector<std::string>& arguments) {
  const Command command = make_command();
  po::variables_map values;
  if (!parse(command, arguments, values)) return 0;
  const std::string path = argument_of(command, values, "mesh");
  wrap_of(values);
  if (has(values, "material") && !has_atlas_option(values))
    throw UsageError("--material needs -t or --resolution");
  const InputMesh input = read_input_mesh(path);
  check_interrupted();
  Findings findings;
  findings.mesh = report_mesh(input.welded);
  check_interrupted();
  examine_textures(input, values, findings);
  check_interrupted();
  findings.refusal = find_refusal(findings);
  find_problems(input, findings);
  if (flag_of(values, "json")) {
    print_json(input, findings);
  } else {
    warn(input.warnings);
    print_text(input, findings);
  }
  if (!flag_of(values, "strict") || findings.problems.empty()) return 0;
  std::string list;
  for (const std::string& name : findings.problems) list += (list.empty() ? "" : ", ") + name;
  std::cout.flush();
  std::cerr << "onmesh info: " << path << " is not in order: " << list << '\n';
  return 1;
}

}  // namespace onmesh::tools
