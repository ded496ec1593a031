// onmesh map: which texel lies where on the surface, as an image with a channel per property.
#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "atlas.h"
#include "format.h"
#include "inputs.h"
#include "interruption.h"
#include "messages.h"
#include "onmesh/base/atomic_file.h"
#include "onmesh/base/text.h"
#include "onmesh/base/triangle.h"
#include "onmesh/image/image_io.h"
#include "output_names.h"
#include "report.h"
#include "shared_options.h"
#include "subcommands.h"

namespace onmesh::tools {

Command map_command() {
  Command command;
  command.name = "map";
  command.synopsis = "MESH (-t TEXTURE... | --resolution WxH) -o MAP.exr [options]";
  command.summary =
      "Writes where on the surface every texel lies, as EXR with 32-bit float channels:\n"
      "  face          triangle of the file, from 0; -1 = none\n"
      "  b0 b1 b2      barycentric coordinates of the texel's centre in it\n"
      "  x y z         its position, mesh units\n"
      "  area          surface area of the whole texel, mesh units squared\n"
      "  chart         number of its chart, from 0; -1 = none\n"
      "  claims        positions that share the texel; the first is described\n"
      "  coverage      0 = no chart, 1 = touched (padding), 2 = covered\n"
      "Where no position claims the texel, the others are 0.";
  command.examples =
      "  onmesh map cube.obj -t cube.png -o map.exr\n"
      "  onmesh map cube.obj --resolution 1024x1024 -o map.exr --json\n";
  auto add = command.options.add_options();
  add("mesh", text());
  add("output,o", text(),
      "the EXR to write; of several textures a folder/ or a name with <UDIM>, {stem}, ...");
  add_atlas_options(command.options);
  add_weld_option(command.options);
  add_confine_option(command.options);
  add("json", flag(), "statistics as JSON on stdout");
  add("quiet", flag(), "no summary");
  command.positional.add("mesh", 1);
  return command;
}

namespace {

// In the order in which readers hand the channels out: x y z first, then by the alphabet.
enum Channel { kX, kY, kZ, kArea, kB0, kB1, kB2, kChart, kClaims, kCoverage, kFace, kChannels };
const std::vector<std::string> kNames = {"x",  "y",     "z",      "area",     "b0",  "b1",
                                         "b2", "chart", "claims", "coverage", "face"};

/// Barycentric coordinates in the file's face, of which this one may be a part.
Vec3 in_file_face(const InputMesh& input, Index face, const Vec3& barycentric) {
  const Index whole = input.cleaning.kept[face];
  Vec3 sum = Vec3::Zero();
  const auto part_uvs = input.cleaned.corner_uvs(face), uvs = input.as_read.corner_uvs(whole);
  if (part_uvs == uvs) return barycentric;
  for (std::size_t k = 0; k < 3; ++k) {
    sum += barycentric[Eigen::Index(k)] * barycentric_in(uvs, part_uvs[k]);
  }
  return sum.allFinite() ? sum : barycentric;
}

/// \param mesh the cleaned one, with UVs of each face's own tile
std::vector<Image> draw(const InputMesh& input, const TriangleMesh& mesh, const TexelMap& map) {
  std::vector<Image> images = images_like(map.tiles, kChannels);
  TexelValues texels;
  for (Image& image : images) {
    image.channel_names = kNames;
    texels.add(image);
  }
  for (Index i = 0; i < map.coverage.size(); ++i) {
    float* const texel = texels[i];
    texel[kFace] = texel[kChart] = -1;
    texel[kCoverage] = float(map.coverage[i]);
  }
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    for (Index c = map.face_offsets[f]; c < map.face_offsets[f + 1]; ++c) {
      float* const texel = texels[map.tile_of(f).texel(map.claims[c])];
      if (texel[kClaims]++ > 0) continue;
      const Vec3 b = map.barycentric(f, map.claims[c]);
      const Vec3 p = mesh.position({f, b});
      const Vec3 whole = in_file_face(input, f, b);
      texel[kFace] = float(input.cleaning.kept[f]);
      texel[kChart] = float(map.chart_of_face[f]);
      texel[kArea] = float(map.texel_area[f]);
      for (int k = 0; k < 3; ++k) {
        texel[kB0 + k] = float(whole[k]);
        texel[kX + k] = float(p[k]);
      }
    }
  }
  return images;
}

// Cleaning turns faces over; barycentric coordinates are those of the file's corners.
void restore_corner_order(const InputMesh& input, TriangleMesh& mesh) {
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const auto& before = input.joined.faces[input.joined_faces[f]];
    if (input.joined.positions[before[1]] == mesh.positions[mesh.faces[f][1]]) continue;
    std::swap(mesh.faces[f][1], mesh.faces[f][2]);
    std::swap(mesh.face_uvs[f][1], mesh.face_uvs[f][2]);
  }
}

/// What the map of a tile comes to.
struct Statistics {
  std::uint64_t covered = 0, touched = 0, overlapped = 0;
  double texel_size = 0;
};

/// Per tile.
std::vector<Statistics> statistics(const TexelMap& map) {
  std::vector<Statistics> all;
  const std::vector<Index> overlapped = map.overlapped();
  for (Index i = 0; i < map.tiles.size(); ++i) {
    const TexelTile& tile = map.tiles[i];
    const auto begin = map.coverage.begin() + std::ptrdiff_t(tile.first);
    const auto count = [&](Coverage c) {
      return std::uint64_t(std::count(begin, begin + std::ptrdiff_t(tile.size()), c));
    };
    const auto first = std::lower_bound(overlapped.begin(), overlapped.end(), tile.first);
    const auto last = std::lower_bound(first, overlapped.end(), tile.first + tile.size());
    all.push_back({count(Coverage::covered), count(Coverage::touched), std::uint64_t(last - first),
                   map.median_texel_size(i)});
  }
  return all;
}

nlohmann::json tile_json(const SetTexture& texture, const TexelTile& tile,
                         const Statistics& found) {
  return {{"texture", text_or_null(texture.path.string())},
          {"width", tile.width},
          {"height", tile.height},
          {"covered", found.covered},
          {"touched", found.touched},
          {"overlapped", found.overlapped},
          {"texel_size", found.texel_size}};
}

void print_json(const std::string& path, const OutputNames& outputs, const Atlas& atlas,
                const TexelMap& map) {
  const std::vector<Statistics> found = statistics(map);
  nlohmann::json json = new_report("map");
  json["mesh"] = path;
  json["charts"] = map.charts;
  json["claims"] = map.claims.size();
  json["channels"] = kNames;
  json["tiles"] = nlohmann::json::array();
  for (std::size_t i = 0; i < found.size(); ++i) {
    nlohmann::json tile = tile_json(atlas.set.textures[i], map.tiles[i], found[i]);
    tile["output"] = outputs.paths[i].string();
    if (found.size() == 1) json.update(tile);
    json["tiles"].push_back(std::move(tile));
  }
  print_report(std::move(json));
}

void print_text(const OutputNames& outputs, const TexelMap& map) {
  const std::vector<Statistics> found = statistics(map);
  for (std::size_t i = 0; i < found.size(); ++i) {
    std::cerr << outputs.paths[i].string() << ": " << map.tiles[i].width << " x "
              << map.tiles[i].height << ", " << format_count(found[i].covered)
              << " texels covered, " << format_count(found[i].touched) << " touched, "
              << format_count(found[i].overlapped) << " shared, texel size "
              << format_number(found[i].texel_size) << '\n';
  }
  std::cerr << format_count(map.charts) << " charts\n";
}

/// \throw UsageError unless all are EXR
void check_outputs(const OutputNames& outputs) {
  for (const std::filesystem::path& path : outputs.paths) {
    if (lower_case(path.extension().string()) != ".exr") {
      throw UsageError("--output: " + path.string() +
                       " must end in .exr, only EXR names its channels");
    }
    check_writable_image(path, make_image(1, 1, kChannels));
  }
}

}  // namespace

int run_map(const Arguments& arguments) {
  const std::string path = arguments.argument("mesh"), output = arguments.text("output");
  wrap_of(arguments);

  InputMesh input = read_input_mesh(path, arguments);
  warn(input.read.warnings);
  check_interrupted();
  restore_corner_order(input, input.cleaned);
  Atlas atlas = read_atlas(arguments, input.cleaned);
  atlas.images = {};
  warn(atlas.set.warnings);
  warn(atlas.warnings);
  const OutputNames outputs = name_outputs(atlas.set, output, ".exr");
  std::optional<AtomicFolder> folder;
  if (!outputs.folder.empty()) folder.emplace(outputs.folder);
  check_outputs(outputs);
  check_interrupted();
  const TexelMap map = covered_map(input, atlas);
  if (input.welded.faces.size() > (1U << 24))
    warn(output + ": face numbers beyond 16,777,216 are rounded, the channels are 32-bit float");
  check_interrupted();
  const std::vector<Image> images = draw(input, atlas.mesh, map);
  std::vector<ImageFile> files;
  for (std::size_t i = 0; i < images.size(); ++i) files.push_back({outputs.paths[i], &images[i]});
  write_images(files);
  if (folder) folder->keep();

  if (arguments.flag("json")) {
    print_json(path, outputs, atlas, map);
  } else if (!arguments.flag("quiet")) {
    print_text(outputs, map);
  }
  return 0;
}

}  // namespace onmesh::tools
