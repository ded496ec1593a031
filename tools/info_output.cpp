#include "info_output.h"

#include <filesystem>
#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>

#include "format.h"
#include "report.h"

namespace onmesh::tools {
namespace {

nlohmann::json texture_json(const TextureFacts& t) {
  return {{"path", text_or_null(t.path)},
          {"error", text_or_null(t.trouble)},
          {"width", t.width},
          {"height", t.height},
          {"channels", t.channels},
          {"colour_space", text_or_null(t.colour_space)},
          {"colour_space_reason", text_or_null(t.colour_space_reason)},
          {"covered", t.covered},
          {"touched", t.touched},
          {"overlapped", t.overlapped},
          {"crowded", t.crowded},
          {"texel_size", t.texel_size},
          {"seams", t.seams ? to_json(*t.seams) : nlohmann::json()}};
}

nlohmann::json mesh_json(const MeshReport& r) {
  return {{"vertices", r.vertices},
          {"faces", r.faces},
          {"components", r.components},
          {"boundary_edges", r.boundary_edges},
          {"boundary_loops", r.boundary_loops},
          {"nonmanifold_edges", r.nonmanifold_edges},
          {"nonmanifold_vertices", r.nonmanifold_vertices},
          {"inconsistent_edges", r.inconsistent_edges},
          {"orientable", r.orientable},
          {"manifold", r.manifold()},
          {"degenerate_faces", r.degenerate_faces},
          {"duplicate_faces", r.duplicate_faces},
          {"surface_area", r.surface_area},
          {"diagonal", r.diagonal},
          {"charts", r.charts},
          {"faces_without_uvs", r.faces_without_uvs},
          {"degenerate_uvs", r.degenerate_uvs},
          {"mirrored_faces", r.mirrored_faces},
          {"faces_running_back", r.running_back},
          {"overlap_share", r.overlap_share},
          {"max_overlap", r.max_overlap},
          {"uv_min", {r.uv_min.x(), r.uv_min.y()}},
          {"uv_max", {r.uv_max.x(), r.uv_max.y()}},
          {"density_min", r.density_min},
          {"density_max", r.density_max}};
}

nlohmann::json cleaning_json(const CleanReport& c) {
  return {{"collapsed", c.collapsed}, {"duplicates", c.duplicates},
          {"separated", c.separated}, {"fins", c.fins},
          {"flat", c.flat},           {"flipped", c.flipped}};
}

bool texture_exists(const Material& material) {
  std::error_code error;
  return material.content || std::filesystem::is_regular_file(material.texture, error);
}

void row(const std::string& name, const std::string& value) {
  std::cout << "  " << std::left << std::setw(20) << name << value << '\n';
}

/// What readers found in the files, in the words of their formats.
void print_reading(const ReadReport& read) {
  const auto list = [](const char* name, const std::vector<std::string>& lines) {
    for (std::size_t i = 0; i < lines.size(); ++i) row(i == 0 ? name : "", lines[i]);
  };
  list("read", read.read);
  list("ignored", read.ignored);
  list("assumed", read.assumed);
}

void print_surface(const InputMesh& input, const MeshReport& r) {
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
  if (!input.joining.nothing_done()) {
    row("joined", format_count(input.joining.joined_edges) + " edges apart by rounding, " +
                      format_count(input.joining.t_junctions) + " T-junctions");
  }
}

void print_cleaning(const CleanReport& c) {
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
}

void print_atlas(const MeshReport& r) {
  std::cout << "atlas\n";
  row("charts", format_count(r.charts));
  row("without UVs", format_count(r.faces_without_uvs) + " faces");
  row("UVs without area", format_count(r.degenerate_uvs) + " faces");
  row("mirrored", format_count(r.mirrored_faces) + " faces");
  row("used more than once", r.max_overlap < 2 ? "nothing"
                                               : format_percent(r.overlap_share) + " (up to " +
                                                     format_count(r.max_overlap) + " times)");
  row("UV range", format_number(r.uv_min.x()) + ".." + format_number(r.uv_max.x()) + " x " +
                      format_number(r.uv_min.y()) + ".." + format_number(r.uv_max.y()));
  row("density", format_number(r.density_min) + ".." + format_number(r.density_max) +
                     " tiles per mesh unit (1 % to 99 % of the surface)");
}

void print_materials(const std::vector<Material>& materials) {
  if (!materials.empty()) std::cout << "materials\n";
  for (const Material& m : materials) {
    row(m.name,
        m.texture.empty() ? "no texture" : m.texture + (texture_exists(m) ? "" : " (missing)"));
  }
}

void print_seams(const SeamError& seams) {
  row("seams",
      format_count(seams.edges) + " edges, " + format_number(seams.length) + " mesh units");
  row("seam error", "rms " + format_number(seams.rms) + ", max " + format_number(seams.max));
}

void print_texture(const TextureFacts& t) {
  std::cout << (t.path.empty() ? "at " : "texture " + t.path + ", ") << t.width << " x "
            << t.height;
  if (t.channels > 0)
    std::cout << ", " << t.channels << (t.channels == 1 ? " channel" : " channels");
  std::cout << '\n';
  if (!t.colour_space.empty())
    row("colour space", t.colour_space + " (" + t.colour_space_reason + ")");
  const double texels = double(t.width) * t.height;
  row("covered texels",
      format_count(t.covered) + " (" + format_percent(double(t.covered) / texels) + ")");
  row("touched texels", format_count(t.touched));
  row("crowded texels", format_count(t.crowded));
  row("overlapped texels", format_count(t.overlapped));
  row("texel size", format_number(t.texel_size) + " mesh units (median)");
  if (t.seams) print_seams(*t.seams);
}

}  // namespace

void print_json(const InputMesh& input, const Findings& findings) {
  nlohmann::json json = new_report("info");
  json["mesh"] = input.path;
  json["vertices_in_file"] = input.as_read.positions.size();
  json.update(mesh_json(findings.mesh));
  json["mean_edge"] = input.welded.mean_edge_length();
  json["joined_edges"] = input.joining.joined_edges;
  json["t_junctions"] = input.joining.t_junctions;
  json["refused_edges"] = input.joining.refused_edges;
  json["cleaning"] = cleaning_json(input.cleaning);
  json["materials"] = nlohmann::json::array();
  for (const Material& m : input.welded.materials) {
    json["materials"].push_back({{"name", m.name},
                                 {"texture", text_or_null(m.texture)},
                                 {"texture_exists", texture_exists(m)}});
  }
  json["textures"] = nlohmann::json::array();
  for (const TextureFacts& t : findings.textures) json["textures"].push_back(texture_json(t));
  json["near_boundary_edges"] = findings.near.edges;
  json["seams"] = findings.seams ? to_json(*findings.seams) : nlohmann::json();
  json["read"] = input.read.read;
  json["ignored"] = input.read.ignored;
  json["assumed"] = input.read.assumed;
  json["warnings"] = input.read.warnings;
  for (const std::string& warning : findings.warnings) json["warnings"].push_back(warning);
  json["advice"] = findings.advice;
  json["problems"] = findings.problems;
  json["filterable"] = findings.refusal.empty();
  json["refusal"] = text_or_null(findings.refusal);
  print_report(std::move(json));
}

void print_text(const InputMesh& input, const Findings& findings) {
  std::cout << "mesh " << input.path << '\n';
  print_reading(input.read);
  print_surface(input, findings.mesh);
  print_cleaning(input.cleaning);
  print_atlas(findings.mesh);
  print_materials(input.welded.materials);
  for (const TextureFacts& t : findings.textures) {
    if (t.trouble.empty()) print_texture(t);
  }
  if (findings.near.edges > 0) {
    row("near boundaries", format_count(findings.near.edges) + " edges within a texel of others");
  }
  if (findings.seams) {
    std::cout << "textures in all\n";
    print_seams(*findings.seams);
  }
  if (!findings.advice.empty()) std::cout << "advice\n";
  for (const std::string& line : findings.advice) std::cout << "  - " << line << '\n';
  if (findings.refusal.empty())
    std::cout << "filter will take it\n";
  else
    std::cout << "filter will refuse it: " << findings.refusal << '\n';
}

}  // namespace onmesh::tools
