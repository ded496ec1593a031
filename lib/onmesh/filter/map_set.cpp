#include "onmesh/filter/map_set.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "onmesh/base/error.h"
#include "onmesh/filter/filter.h"
#include "onmesh/image/channels.h"

namespace onmesh {
namespace {

/// Maps with the same samples, as the filter takes them.
struct MapGroup {
  std::vector<std::size_t> maps;  ///< numbers
  const TriangleMesh* mesh = nullptr;
  SurfaceTextures textures;
  std::vector<Image> images;  ///< of several maps, side by side; else empty
  FilterOptions options;
};

bool all_finite(const Image& image) {
  return std::all_of(image.pixels.begin(), image.pixels.end(),
                     [](float v) { return std::isfinite(v); });
}

bool are_equal(const Image* a, const Image* b) {
  return a == b || (a != nullptr && b != nullptr && a->width == b->width &&
                    a->height == b->height && a->channels == b->channels && a->pixels == b->pixels);
}

/// Samples of such a map may have weights of their own.
bool stands_alone(const SurfaceMap& map) {
  return std::any_of(map.textures.tiles.begin(), map.textures.tiles.end(),
                     [](const TextureTile& tile) {
                       return tile.image->alpha_channel >= 0 || !all_finite(*tile.image);
                     });
}

bool have_same_samples(const SurfaceMap& a, const SurfaceMap& b) {
  const auto& one = a.textures.tiles;
  const auto& other = b.textures.tiles;
  return a.mesh == b.mesh && a.textures.tile_of_face == b.textures.tile_of_face &&
         std::equal(one.begin(), one.end(), other.begin(), other.end(),
                    [](const TextureTile& x, const TextureTile& y) {
                      return x.image->width == y.image->width &&
                             x.image->height == y.image->height && x.column == y.column &&
                             x.row == y.row && x.wrap.u == y.wrap.u && x.wrap.v == y.wrap.v &&
                             levels_of(*x.image) == levels_of(*y.image) &&
                             are_equal(x.mask, y.mask) && are_equal(x.sample_mask, y.sample_mask);
                    });
}

int channels_of(const SurfaceMap& map) {
  return int(map.textures.tiles[0].image->range_channels().size());
}

MapChannels described(const SurfaceMap& map) {
  if (!map.textures.maps.empty()) return map.textures.maps[0];
  return {map.name, channels_of(map), channels_of(map) < 3};
}

/// The maps' channels one after the other, in one image per tile.
void join_images(const std::vector<SurfaceMap>& maps, MapGroup& group) {
  const SurfaceTextures& first = maps[group.maps[0]].textures;
  group.textures = first;
  group.textures.maps.clear();
  int channels = 0;
  for (const std::size_t m : group.maps) {
    group.textures.maps.push_back(described(maps[m]));
    channels += channels_of(maps[m]);
  }
  if (group.maps.size() == 1) return;
  for (std::size_t i = 0; i < first.tiles.size(); ++i) {
    const Image& like = *first.tiles[i].image;
    Image& image = group.images.emplace_back(make_image(like.width, like.height, channels));
    image.source = like.source;  // how many levels codes have; it is not written
    std::vector<std::pair<int, std::shared_ptr<const ColourSpace>>> spaces;
    int next = 0;
    for (const std::size_t m : group.maps) {
      const TextureTile& tile = maps[m].textures.tiles[i];
      std::vector<int> to(std::size_t(tile.image->channels));
      for (int& c : to) c = next++;
      put_channels(*tile.image, to, image);
      spaces.emplace_back(tile.image->channels, tile.space);
    }
    group.textures.tiles[i].space = join_colour_spaces(std::move(spaces));
  }
  for (std::size_t i = 0; i < group.images.size(); ++i)
    group.textures.tiles[i].image = &group.images[i];
}

/// Guides by the numbers of the group's maps; other maps are images.
void translate_guides(const std::vector<SurfaceMap>& maps, MapGroup& group) {
  for (Guide& guide : group.options.guides) {
    if (guide.kind != Guide::Kind::own) continue;
    const std::size_t number = guide.map < 0 ? group.maps[0] : std::size_t(guide.map);
    const auto own = std::find(group.maps.begin(), group.maps.end(), number);
    if (own != group.maps.end()) {
      guide.map = int(own - group.maps.begin());
      continue;
    }
    const SurfaceMap& other = maps[number];
    guide.kind = Guide::Kind::images;
    guide.textures = other.textures;
    guide.mesh = other.mesh != group.mesh ? other.mesh : nullptr;
    guide.meaning = other.meaning;
  }
}

void check_maps(const std::vector<SurfaceMap>& maps, const FilterOptions& options) {
  const auto filtered =
      std::count_if(maps.begin(), maps.end(), [](const SurfaceMap& m) { return m.is_filtered; });
  if (filtered == 0) throw InputError("there is no map to filter");
  for (const SurfaceMap& map : maps)
    if (map.textures.tiles.empty()) throw InputError("map " + map.name + ": there is no texture");
  if (options.kind == FilterKind::gaussian) return;
  if (filtered > 1 && options.guides.empty()) {
    throw OptionError("guide",
                      "several maps need one that says which texels are alike, or "
                      "kind=gaussian");
  }
  for (const Guide& guide : options.guides) {
    if (guide.kind != Guide::Kind::own) continue;
    if (guide.map >= int(maps.size())) throw OptionError("guide", "there is no such map");
    if (guide.map < 0 && filtered > 1)
      throw OptionError("guide", "self: there are several maps, name one of them");
  }
}

std::vector<MapGroup> group_maps(const TriangleMesh& mesh, const std::vector<SurfaceMap>& maps,
                                 const FilterOptions& options) {
  check_maps(maps, options);
  std::vector<MapGroup> groups;
  for (std::size_t m = 0; m < maps.size(); ++m) {
    if (!maps[m].is_filtered) continue;
    const bool alone = stands_alone(maps[m]);
    const auto same = std::find_if(groups.begin(), groups.end(), [&](const MapGroup& group) {
      const SurfaceMap& first = maps[group.maps[0]];
      return !alone && !stands_alone(first) && have_same_samples(first, maps[m]);
    });
    if (same != groups.end()) {
      same->maps.push_back(m);
    } else {
      MapGroup& group = groups.emplace_back();
      group.maps = {m};
      group.mesh = maps[m].mesh != nullptr ? maps[m].mesh : &mesh;
      group.options = options;
    }
  }
  for (MapGroup& group : groups) {
    join_images(maps, group);
    translate_guides(maps, group);
    if (group.options.filter_alpha) {
      const Image& first = *group.textures.tiles[0].image;
      group.options.filter_alpha = first.alpha_channel >= 0 || groups.size() == 1;
    }
  }
  return groups;
}

/// Put the group's results where they belong.
void split_results(const std::vector<SurfaceMap>& maps, const MapGroup& group,
                   std::vector<Image> results, std::vector<std::vector<Image>>& per_map) {
  if (group.maps.size() == 1) {
    per_map[group.maps[0]] = std::move(results);
    return;
  }
  int next = 0;
  for (const std::size_t m : group.maps) {
    const int channels = channels_of(maps[m]);
    std::vector<int> from;
    for (int c = 0; c < channels; ++c) from.push_back(next++);
    for (std::size_t i = 0; i < results.size(); ++i) {
      Image image = *maps[m].textures.tiles[i].image;
      image.pixels = take_channels(results[i], from).pixels;
      per_map[m].push_back(std::move(image));
    }
  }
}

void add(const FilterReport& more, FilterReport& report) {
  report.texels += more.texels;
  report.samples += more.samples;
  report.pairs += more.pairs;
  report.by_nodes += more.by_nodes;
  report.checked += more.checked;
  report.patches += more.patches;
  report.table_rows += more.table_rows;
  report.gutter += more.gutter;
  report.missing += more.missing;
  report.left_out += more.left_out;
  report.spikes += more.spikes;
  report.without_sample += more.without_sample;
  report.max_error = std::max(report.max_error, more.max_error);
  report.rms_error = std::max(report.rms_error, more.rms_error);
  report.table_cpu_seconds += more.table_cpu_seconds;
  report.kernel_cpu_seconds += more.kernel_cpu_seconds;
  if (report.method != more.method) report.method = "nodes and direct";
  report.stages.insert(report.stages.end(), more.stages.begin(), more.stages.end());
  for (const std::string& warning : more.warnings) {
    if (std::find(report.warnings.begin(), report.warnings.end(), warning) == report.warnings.end())
      report.warnings.push_back(warning);
  }
}

}  // namespace

std::vector<std::vector<Image>> filter_maps(const TriangleMesh& mesh,
                                            const std::vector<SurfaceMap>& maps,
                                            const FilterOptions& options, FilterReport* report,
                                            const Progress& progress) {
  const std::vector<MapGroup> groups = group_maps(mesh, maps, options);
  std::vector<std::vector<Image>> per_map(maps.size());
  FilterReport sum;
  for (const MapGroup& group : groups) {
    FilterReport own;
    split_results(maps, group, filter(*group.mesh, group.textures, group.options, &own, progress),
                  per_map);
    if (&group == groups.data()) {
      sum = std::move(own);
    } else {
      add(own, sum);
    }
  }
  if (report != nullptr) *report = std::move(sum);
  std::vector<std::vector<Image>> filtered;
  for (std::size_t m = 0; m < maps.size(); ++m)
    if (maps[m].is_filtered) filtered.push_back(std::move(per_map[m]));
  return filtered;
}

FilterPlan plan_maps(const TriangleMesh& mesh, const std::vector<SurfaceMap>& maps,
                     const FilterOptions& options) {
  FilterPlan largest;
  for (const MapGroup& group : group_maps(mesh, maps, options)) {
    FilterPlan plan = plan_filter(*group.mesh, group.textures, group.options);
    if (largest.texels == 0 || plan.memory_bytes > largest.memory_bytes) largest = std::move(plan);
  }
  return largest;
}

}  // namespace onmesh
