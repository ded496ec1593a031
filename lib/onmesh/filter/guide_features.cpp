#include "onmesh/filter/guide_features.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "onmesh/atlas/fill_rings.h"
#include "onmesh/atlas/texel_lookup.h"
#include "onmesh/base/error.h"
#include "onmesh/base/parallel.h"
#include "onmesh/base/text.h"
#include "onmesh/base/triangle.h"
#include "onmesh/filter/surface_origin.h"
#include "onmesh/mesh/shading_normals.h"

namespace onmesh {
namespace {

constexpr float kNoValue = std::numeric_limits<float>::quiet_NaN();

using FaceNormals = std::vector<std::array<Vec3, 3>>;

bool have_equal_sizes(const std::vector<TextureTile>& a, const std::vector<TextureTile>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const TextureTile& x, const TextureTile& y) {
                      return x.image->width == y.image->width &&
                             x.image->height == y.image->height && x.wrap.u == y.wrap.u &&
                             x.wrap.v == y.wrap.v && x.column == y.column && x.row == y.row;
                    });
}

/// From codes, or floats as they are, to a vector of about unit length.
Vec3 decode_normal(const float* code, int levels) {
  if (levels == 0) return {code[0], code[1], code[2]};
  const int zero = (levels + 1) / 2;
  Vec3 n;
  for (int c = 0; c < 3; ++c) n[c] = (double(code[c]) * levels - zero) / (levels - zero);
  return n;
}

/// Features of a guide's images for their own texels.
class GuideTexels {
 public:
  /// \param mesh with the guide's UVs
  /// \param local the same mesh, UVs those of each face's own tile
  /// \param map of the guide's texels on `local`
  GuideTexels(const FeatureSlot& slot, const FilterOptions& options, const TriangleMesh& local,
              const TexelMap& map)
      : guide_(*slot.guide), channels_(slot.channels), local_(local), map_(map) {
    options_.kind = FilterKind::bilateral;
    if (slot.is_colour) options_.range_space = options.range_space;
    values_.emplace(guide_.textures, map, options_);
    values_->compare_own();
    if (guide_.meaning != Guide::Meaning::values) decode(map);
  }

  /// `channels` floats; not finite where there is no value.
  const float* of(Index texel) const {
    return decoded_.empty() ? values_->colours().of(texel)
                            : decoded_.data() + std::size_t(texel) * 3;
  }

 private:
  void decode(const TexelMap& map) {
    const bool in_tangent_space = guide_.meaning != Guide::Meaning::object_normal;
    if (in_tangent_space) normals_ = shading_normals(local_);
    decoded_.resize(map.coverage.size() * 3);
    const TexelPlaces places(map);
    Index first = 0;
    for (const TextureTile& tile : guide_.textures.tiles) {
      const int levels = levels_of(*tile.image);
      const auto count = std::size_t(tile.image->width) * std::size_t(tile.image->height);
      over_blocks(count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
          const Index t = first + Index(k);
          if (places.face(t) == kNone) continue;
          Vec3 n = decode_normal(values_->straight().values_of(t), levels);
          if (guide_.meaning == Guide::Meaning::normal_dx) n.y() = -n.y();
          if (in_tangent_space) n = to_object(places.face(t), places.claim(t), n);
          const double length = n.norm();
          for (int c = 0; c < 3; ++c)
            decoded_[std::size_t(t) * 3 + std::size_t(c)] =
                length > kLeastLength ? float(n[c] / length) : kNoValue;
        }
      });
      first += Index(count);
    }
  }

  /// See add_guides().
  Vec3 to_object(Index face, const TexelClaim& claim, const Vec3& n) const {
    const Vec3 normal = interpolate(normals_[face], map_.barycentric(face, claim)).normalized();
    const auto corner = local_.corners(face);
    const auto uv = local_.corner_uvs(face);
    const Vec2 a = uv[1] - uv[0], b = uv[2] - uv[0];
    const double area = a.x() * b.y() - a.y() * b.x();
    const Vec3 along_u =
        ((corner[1] - corner[0]) * b.y() - (corner[2] - corner[0]) * a.y()) * (area < 0 ? -1 : 1);
    const Vec3 tangent = (along_u - normal * normal.dot(along_u)).stableNormalized();
    const Vec3 bitangent = normal.cross(tangent) * (area < 0 ? -1 : 1);
    return tangent * n.x() + bitangent * n.y() + normal * n.z();
  }

  static constexpr double kLeastLength = 1e-3;

  const Guide& guide_;
  const int channels_;
  const TriangleMesh& local_;
  const TexelMap& map_;
  FilterOptions options_;
  std::optional<WorkingValues> values_;
  FaceNormals normals_;
  LargeArray<float> decoded_;  ///< normals only
};

/// Fills slots.
class GuideFiller {
 public:
  GuideFiller(const TriangleMesh& mesh, const PreparedMesh& prepared, const FilterOptions& options,
              WorkingValues& working)
      : mesh_(mesh),
        prepared_(prepared),
        options_(options),
        working_(working),
        places_(prepared.map),
        origin_(mesh, prepared) {}

  void add_normals(const FeatureSlot& slot) {
    const FaceNormals normals = shading_normals(mesh_);
    over_texels(slot, [&](Index t, float* to) {
      const SurfacePoint p = origin(t);
      const Vec3 n = interpolate(normals[p.face], p.barycentric).stableNormalized();
      for (int c = 0; c < 3; ++c) to[c] = float(n[c]);
    });
  }

  void add_positions(const FeatureSlot& slot) {
    over_texels(slot, [&](Index t, float* to) {
      const Index f = places_.face(t);
      const Vec3 p =
          interpolate(prepared_.mesh.corners(f), prepared_.map.barycentric(f, places_.claim(t)));
      for (int c = 0; c < 3; ++c) to[c] = float(p[c]);
    });
  }

  void add_images(const FeatureSlot& slot) {
    const Guide& guide = *slot.guide;
    const bool is_alike = guide.mesh == nullptr &&
                          guide.textures.tile_of_face == working_.textures().tile_of_face &&
                          have_equal_sizes(guide.textures.tiles, working_.textures().tiles);
    if (is_alike) {
      const GuideTexels texels(slot, options_, prepared_.mesh, prepared_.map);
      over_texels(slot, [&](Index t, float* to) { std::copy_n(texels.of(t), slot.channels, to); });
    } else {
      look_up(slot);
    }
  }

 private:
  /// put(texel, features) for every covered texel.
  template <class Put>
  void over_texels(const FeatureSlot& slot, const Put& put) {
    over_blocks(prepared_.map.coverage.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t)
        if (places_.face(Index(t)) != kNone) put(Index(t), working_.features_of(Index(t), slot));
    });
  }

  SurfacePoint origin(Index texel) const {
    const Index f = places_.face(texel);
    return origin_.point(f, prepared_.map.barycentric(f, places_.claim(texel)));
  }

  void look_up(const FeatureSlot& slot) {
    const Guide& guide = *slot.guide;
    TriangleMesh local = guide.mesh != nullptr ? *guide.mesh : mesh_;
    if (local.faces.size() != mesh_.faces.size())
      throw InputError("guide " + guide.name + ": its UVs are those of another mesh");
    std::vector<Index> tile_of_face = guide.textures.tile_of_face;
    if (tile_of_face.empty()) tile_of_face.assign(local.faces.size(), 0);
    make_uvs_local(guide.textures.tiles, tile_of_face, local);
    const TexelMap map = make_texel_map(local, texel_tiles(guide.textures.tiles), tile_of_face);
    if (map.claims.empty())
      throw InputError("guide " + guide.name + ": no face of the mesh carries it");
    const GuideTexels texels(slot, options_, local, map);
    const TexelLookup lookup(map);
    over_texels(slot, [&](Index t, float* to) {
      std::fill_n(to, slot.channels, kNoValue);
      const SurfacePoint p = origin(t);
      if (!local.has_uvs(p.face) || !(map.texel_area[p.face] > 0)) return;
      const TexelTile tile = map.tile_of(p.face);
      const Vec2 uv = interpolate(local.corner_uvs(p.face), p.barycentric);
      const LookupTexels around =
          lookup.around(p.face, {uv.x() * tile.width - 0.5, (1 - uv.y()) * tile.height - 0.5});
      add_up(texels, around, slot, map, to);
    });
  }

  /// The mean of the covered texels that have values.
  static void add_up(const GuideTexels& texels, const LookupTexels& around, const FeatureSlot& slot,
                     const TexelMap& map, float* to) {
    std::vector<float> sum(std::size_t(slot.channels), 0.F);
    float weights = 0;
    for (std::size_t k = 0; k < std::size_t(around.count); ++k) {
      if (map.coverage[around.texels[k]] != Coverage::covered) continue;
      const float* const from = texels.of(around.texels[k]);
      if (!std::all_of(from, from + slot.channels, [](float v) { return std::isfinite(v); }))
        continue;
      for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += around.weights[k] * from[c];
      weights += around.weights[k];
    }
    for (float& s : sum) s = weights > 0 ? s / weights : kNoValue;
    if (slot.guide->meaning != Guide::Meaning::values) normalise(sum);
    std::copy(sum.begin(), sum.end(), to);
  }

  static void normalise(std::vector<float>& normal) {
    float squared = 0;
    for (const float x : normal) squared += x * x;
    for (float& x : normal) x = squared > 0 ? x / std::sqrt(squared) : kNoValue;
  }

  const TriangleMesh& mesh_;
  const PreparedMesh& prepared_;
  const FilterOptions& options_;
  WorkingValues& working_;
  const TexelPlaces places_;
  const SurfaceOrigin origin_;
};

}  // namespace

std::uint64_t fill_slot(const FeatureSlot& slot, const TexelMap& map, WorkingValues& working) {
  const auto is_missing = [&](Index t) {
    const float* const own = working.features(slot).of(t);
    return map.coverage[t] == Coverage::covered &&
           !std::all_of(own, own + slot.channels, [](float v) { return std::isfinite(v); });
  };
  std::atomic<std::uint64_t> missing = 0;
  over_blocks(map.coverage.size(), [&](std::size_t begin, std::size_t end) {
    std::uint64_t some = 0;
    for (std::size_t t = begin; t < end; ++t) some += is_missing(Index(t));
    missing += some;
  });
  if (missing == 0) return 0;
  std::vector<Image> images;
  Index first = 0;
  for (const TexelTile& tile : map.tiles) {
    Image& image = images.emplace_back(make_image(tile.width, tile.height, slot.channels));
    image.alpha_channel = -1;
    for (Index t = 0; t < tile.size(); ++t)
      std::copy_n(working.features(slot).of(first + t), slot.channels, image.texel(t));
    first += tile.size();
  }
  TexelValues values;
  for (Image& image : images) values.add(image);
  fill_rings(map, values);
  for (Index t = 0; t < values.size(); ++t) {
    if (map.coverage[t] != Coverage::covered) continue;
    for (int c = 0; c < slot.channels; ++c)  // charts without any value compare as equal
      working.features_of(t, slot)[c] = std::isfinite(values[t][c]) ? values[t][c] : 0;
  }
  return missing;
}

void add_guides(const TriangleMesh& mesh, const PreparedMesh& prepared,
                const FilterOptions& options, WorkingValues& working,
                std::vector<std::string>& warnings) {
  const auto& slots = working.layout().slots;
  if (std::all_of(slots.begin(), slots.end(), [](const FeatureSlot& s) { return s.is_own(); }))
    return;
  GuideFiller filler(mesh, prepared, options, working);
  for (const FeatureSlot& slot : slots) {
    if (slot.is_own()) continue;
    switch (slot.guide->kind) {
      case Guide::Kind::surface_normal:
        filler.add_normals(slot);
        break;
      case Guide::Kind::surface_position:
        filler.add_positions(slot);
        break;
      default:
        filler.add_images(slot);
    }
    const std::uint64_t missing = fill_slot(slot, prepared.map, working);
    if (missing > 0) {
      warnings.push_back("guide " + slot.guide->name + ": " +
                         count_text(missing, "texel has", "texels have") +
                         " no value in it: taken from around them");
    }
  }
}

}  // namespace onmesh
