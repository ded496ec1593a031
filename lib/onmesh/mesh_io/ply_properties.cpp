#include "onmesh/mesh_io/ply_properties.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <utility>

#include "onmesh/base/text.h"

namespace onmesh {
namespace {

constexpr std::array<std::string_view, 3> kNormals = {"nx", "ny", "nz"};
constexpr std::array<std::string_view, 12> kColours = {
    "red",         "green",         "blue",         "alpha",         "r", "g", "b", "a",
    "diffuse_red", "diffuse_green", "diffuse_blue", "diffuse_alpha",
};
/// Pairs of texture coordinates; a digit may follow if there are several.
constexpr std::array<std::array<std::string_view, 2>, 8> kUvPairs = {{{"s", "t"},
                                                                      {"u", "v"},
                                                                      {"texture_u", "texture_v"},
                                                                      {"texture_s", "texture_t"},
                                                                      {"texcoord_u", "texcoord_v"},
                                                                      {"texcoord_s", "texcoord_t"},
                                                                      {"tx", "ty"},
                                                                      {"tu", "tv"}}};
constexpr std::array<std::string_view, 3> kCornerLists = {"vertex_indices", "vertex_index",
                                                          "vertex_indexes"};
constexpr std::array<std::string_view, 6> kUvLists = {
    "texcoord", "texcoords", "texture_coordinates", "tex_coords", "uv", "uvs"};

/// The property of that name that is a list, or none.
std::optional<std::size_t> find_property(const PlyElement& element, std::string_view name,
                                         bool list) {
  const auto& all = element.properties;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].count.has_value() == list && all[i].name == name) return i;
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].count.has_value() == list && all[i].name.size() == name.size() &&
        lower_case(all[i].name) == name)
      return i;
  }
  return std::nullopt;
}

/// The first of the element's lists that has one of these names.
template <std::size_t n>
std::optional<std::size_t> find_list(const PlyElement& element,
                                     const std::array<std::string_view, n>& names) {
  std::optional<std::size_t> first;
  for (const std::string_view name : names) {
    const auto found = find_property(element, name, true);
    if (found && (!first || *found < *first)) first = found;
  }
  return first;
}

using Pair = std::array<std::size_t, 2>;

/// All pairs of texture coordinates, in the order of the file.
std::vector<Pair> find_uv_pairs(const PlyElement& element) {
  std::vector<Pair> pairs;
  for (const auto& names : kUvPairs) {
    for (const std::string_view number : {"", "0", "1", "2", "3", "4", "5", "6", "7"}) {
      const auto u = find_property(element, std::string(names[0]).append(number), false);
      const auto v = find_property(element, std::string(names[1]).append(number), false);
      if (u && v) pairs.push_back({*u, *v});
    }
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

std::string pair_names(const PlyElement& element, const Pair& pair) {
  return element.properties[pair[0]].name + " " + element.properties[pair[1]].name;
}

/// Name what is not used, things of a kind together.
/// \param used one per property
void note_unused(const PlyElement& element, const std::vector<bool>& used, ReadReport& report) {
  const auto holds = [](const auto& names, const PlyProperty& p) {
    return !p.count && std::find(names.begin(), names.end(), lower_case(p.name)) != names.end();
  };
  std::string normals, colours;
  std::vector<std::string> others;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i]) continue;
    const PlyProperty& p = element.properties[i];
    if (holds(kNormals, p)) {
      normals += " " + p.name;
    } else if (holds(kColours, p)) {
      colours += " " + p.name;
    } else {
      others.push_back(p.name);
    }
  }
  const std::string of = element.name + ": ";
  if (!normals.empty()) report.ignored.push_back(of + "normals" + normals);
  if (!colours.empty()) report.ignored.push_back(of + "colours" + colours);
  for (const std::string& name : others) report.ignored.push_back(of + name);
}

}  // namespace

VertexProperties vertex_properties(const PlyElement& element, ReadReport& report) {
  VertexProperties properties;
  properties.values.assign(element.properties.size(), VertexValue::unwanted);
  const auto choose = [&](std::string_view name, VertexValue value) {
    const auto found = find_property(element, name, false);
    if (found) properties.values[*found] = value;
    return found.has_value();
  };
  choose("x", VertexValue::x);
  choose("y", VertexValue::y);
  choose("z", VertexValue::z);
  properties.has_texture = choose("texnumber", VertexValue::texture);
  const std::vector<Pair> pairs = find_uv_pairs(element);
  std::vector<bool> known(element.properties.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const std::string names = pair_names(element, pairs[i]);
    if (i == 0) {
      properties.uv_names = names;
      properties.values[pairs[i][0]] = VertexValue::u;
      properties.values[pairs[i][1]] = VertexValue::v;
    } else {
      report.ignored.push_back(element.name + ": texture coordinates " + names);
    }
    for (const std::size_t p : pairs[i]) known[p] = true;
  }
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (properties.values[i] != VertexValue::unwanted) known[i] = true;
  }
  note_unused(element, known, report);
  return properties;
}

FaceProperties face_properties(const PlyElement& element, bool strips, ReadReport& report) {
  FaceProperties properties;
  properties.values.assign(element.properties.size(), FaceValue::unwanted);
  if (const auto corners = find_list(element, kCornerLists)) {
    properties.values[*corners] = FaceValue::corners;
    properties.has_corners = true;
  }
  const auto uvs = find_list(element, kUvLists);
  if (uvs && !strips) {
    properties.values[*uvs] = FaceValue::uvs;
    properties.uv_name = element.properties[*uvs].name;
  }
  if (const auto texture = find_property(element, "texnumber", false)) {
    properties.values[*texture] = FaceValue::texture;
    properties.has_texture = true;
  } else if (const auto textures = find_property(element, "texnumber", true); textures && !strips) {
    properties.values[*textures] = FaceValue::textures;
    properties.has_texture = true;
  }
  std::vector<bool> used;
  for (const FaceValue value : properties.values) used.push_back(value != FaceValue::unwanted);
  note_unused(element, used, report);
  return properties;
}

}  // namespace onmesh
