#include "onmesh/atlas/claim_texels.h"

#include <atomic>
#include <cmath>
#include <limits>
#include <optional>

#include "onmesh/base/error.h"
#include "onmesh/base/parallel.h"

namespace onmesh {
namespace {

constexpr std::int64_t kStripRows = 256;

class Claimer {
 public:
  Claimer(const Atlas& atlas, const std::vector<Strip>& strips) : atlas_(atlas), strips_(strips) {}
  void claim();

 private:
  /// A texel and the area of a face in it, in texels.
  struct Part {
    TexelClaim texel;
    double area;
  };
  bool wins(Index face, int on, const Vec2& centre) const;
  template <class Emit>
  void claim_rows(const Strip& strip, Emit&& emit) const;
  std::vector<std::pair<Index, TexelClaim>> claims_of_empty_charts(
      const std::vector<std::size_t>& counts) const;
  std::vector<Part> parts_of(const std::vector<Index>& faces) const;
  std::optional<std::pair<Index, TexelClaim>> best_texel(const std::vector<Index>& faces) const;
  std::vector<std::size_t> count_claims() const;
  void lay_out(const std::vector<std::size_t>& counts);
  void write_claims(const std::vector<std::size_t>& places);
  void cover(const TexelTile& tile, const TexelClaim& claim);

  const Atlas& atlas_;
  const std::vector<Strip>& strips_;
};

/// Whether a face owns a centre that lies on its edges `on`: it does unless a face of lower index
/// has the same surface point. Faces too thin to claim anything connect the faces on their sides.
bool Claimer::wins(Index face, int on, const Vec2& centre) const {
  std::vector<std::pair<Index, int>> open{{face, on}};
  for (std::size_t i = 0; i < open.size(); ++i) {
    const Index f = open[i].first;
    const int edges = open[i].second;
    bool lost = false;
    // A face seen from corner k whose edges at the centre all end in that corner adds nothing new.
    const auto visit = [&](Index g, Index corner) {
      if (lost) return;
      const int its = atlas_.triangle(g).locate(centre, atlas_.tolerance);
      if (its <= 0) return;
      lost = g < face && atlas_.rasterised(g);
      for (std::size_t e = 0; e < 3; ++e)
        if (corner == atlas_.mesh.face_uvs[g][e]) {
          if ((its >> ((e + 1) % 3) & 1) == 0) return;
        }
      for (const auto& o : open)
        if (o.first == g) return;
      open.emplace_back(g, its);
    };
    for (int k = 0; k < 3; ++k) {
      if ((edges >> k & 1) == 0) continue;
      if (edges >> ((k + 2) % 3) & 1)
        atlas_.neighbours.around_corner(
            f, k, [&](Index g) { visit(g, atlas_.mesh.face_uvs[f][std::size_t(k)]); });
      else if (edges >> ((k + 1) % 3) & 1)
        continue;  // part of the corner at its end
      else
        atlas_.neighbours.across_edge(f, k, [&](Index g) { visit(g, kNone); });
      if (lost) return false;
    }
  }
  return true;
}

/// Call emit(row, first column, one beyond the last) for every run of centres that the face owns.
/// Columns whose centres are surely inside are found from the edges' lines; only those near an edge
/// are tested.
template <class Emit>
void Claimer::claim_rows(const Strip& strip, Emit&& emit) const {
  const UvTriangle t = atlas_.triangle(strip.face);
  const TexelTile tile = atlas_.map.tile_of(strip.face);
  // Centres further than this from an edge's line are decided by the line alone.
  const double margin = 1000 * atlas_.tolerance;
  for (std::int32_t row = strip.begin; row < strip.end; ++row) {
    const double y = row + 0.5;
    double low = std::ceil(t.low.x() - 0.5 - margin), high = std::floor(t.high.x() - 0.5 + margin);
    double sure_low = low, sure_high = high;
    for (const auto& e : t.edges) {
      // value(x) = slope x + constant
      const double slope = -e.sign * e.direction.y();
      const double constant = e.sign * e.direction.x() * (y - e.origin.y()) - slope * e.origin.x();
      const auto cut = [&](double at_least, double& from, double& to) {
        const double x = (at_least - constant) / slope - 0.5;
        if (slope > 0)
          from = std::max(from, std::ceil(x));
        else if (slope < 0)
          to = std::min(to, std::floor(x));
        else if (constant < at_least)
          to = from - 1;
      };
      cut(-margin, low, high);
      cut(margin, sure_low, sure_high);
    }
    if (tile.wrap.u == Wrap::clamp) {
      low = std::max(low, 0.0);
      high = std::min(high, tile.width - 1.0);
    }
    sure_low = std::max(sure_low, low);
    sure_high = std::min(sure_high, high);
    if (!(low <= high)) continue;
    const auto first = std::int32_t(low), last = std::int32_t(high);
    const bool sure = sure_low <= sure_high;
    const auto test = [&](std::int32_t x) {
      const Vec2 centre{x + 0.5, y};
      const int on = t.locate(centre, atlas_.tolerance);
      if (on == 0 || (on > 0 && wins(strip.face, on, centre))) emit(row, x, x + 1);
    };
    const std::int32_t begin = sure ? std::int32_t(sure_low) : last + 1;
    const std::int32_t end = sure ? std::int32_t(sure_high) + 1 : last + 1;
    for (std::int32_t x = first; x < begin; ++x) test(x);
    if (begin < end) emit(row, begin, end);
    for (std::int32_t x = end; x <= last; ++x) test(x);
  }
}

/// Every texel that the faces meet, once per face, by row and column.
std::vector<Claimer::Part> Claimer::parts_of(const std::vector<Index>& faces) const {
  std::vector<Part> parts;
  for (const Index f : faces) {
    const UvTriangle t = atlas_.triangle(f);
    const TexelTile tile = atlas_.map.tile_of(f);
    auto rows = t.rows(atlas_.tolerance);
    clip(tile.wrap.v, rows, tile.height);
    for (auto y = rows.first; y < rows.second; ++y) {
      auto columns = t.columns(y, atlas_.tolerance);
      clip(tile.wrap.u, columns, tile.width);
      for (auto x = columns.first; x < columns.second; ++x)
        parts.push_back({{std::int32_t(x), std::int32_t(y)}, t.area_in(x, y)});
    }
  }
  std::stable_sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) {
    return a.texel.y != b.texel.y ? a.texel.y < b.texel.y : a.texel.x < b.texel.x;
  });
  return parts;
}

/// The texel that the faces overlap most in all, and the face closest to its centre.
std::optional<std::pair<Index, TexelClaim>> Claimer::best_texel(
    const std::vector<Index>& faces) const {
  const std::vector<Part> parts = parts_of(faces);
  if (parts.empty()) return std::nullopt;
  const auto same = [](const TexelClaim& a, const TexelClaim& b) {
    return a.x == b.x && a.y == b.y;
  };
  Part best{{}, -1};
  for (std::size_t i = 0; i < parts.size();) {
    Part sum{parts[i].texel, 0};
    for (; i < parts.size() && same(parts[i].texel, sum.texel); ++i) sum.area += parts[i].area;
    if (sum.area > best.area * (1 + 1e-9)) best = sum;  // rounding does not break ties
  }
  const Vec2 centre{best.texel.x + 0.5, best.texel.y + 0.5};
  Index closest = faces[0];
  double least = std::numeric_limits<double>::infinity();
  for (const Index f : faces) {
    const double d = atlas_.triangle(f).squared_distance(centre);
    if (d < least) {
      least = d;
      closest = f;
    }
  }
  return std::make_pair(closest, best.texel);
}

/// One claim for every chart that has no centre, counts being the claims per face.
std::vector<std::pair<Index, TexelClaim>> Claimer::claims_of_empty_charts(
    const std::vector<std::size_t>& counts) const {
  std::vector<bool> has_claims(atlas_.map.charts, false);
  for (Index f = 0; f < counts.size(); ++f)
    if (counts[f] > 0) has_claims[atlas_.map.chart_of_face[f]] = true;
  std::vector<Index> slot(atlas_.map.charts, kNone);
  std::vector<std::vector<Index>> empty;
  for (Index f = 0; f < counts.size(); ++f) {
    if (!atlas_.rasterised(f) || has_claims[atlas_.map.chart_of_face[f]]) continue;
    Index& s = slot[atlas_.map.chart_of_face[f]];
    if (s == kNone) {
      s = Index(empty.size());
      empty.emplace_back();
    }
    empty[s].push_back(f);
  }
  std::vector<std::optional<std::pair<Index, TexelClaim>>> found(empty.size());
  parallel_over(empty.size(), [&](std::size_t i) { found[i] = best_texel(empty[i]); });
  std::vector<std::pair<Index, TexelClaim>> result;
  for (const auto& f : found)
    if (f) result.push_back(*f);
  return result;
}

/// Give every chart its claims: count them per strip, lay the faces out one after the other, then
/// write. Claims are found twice rather than kept in between.
void Claimer::claim() {
  std::vector<std::size_t> places = count_claims();  // per strip
  std::vector<std::size_t> counts(atlas_.mesh.faces.size(), 0);
  for (std::size_t i = 0; i < strips_.size(); ++i) counts[strips_[i].face] += places[i];
  const auto extra = claims_of_empty_charts(counts);
  for (const auto& e : extra) ++counts[e.first];
  lay_out(counts);
  // A face with an extra claim has no other, so strips begin where their face's earlier ones end.
  Index face = kNone;
  std::size_t at = 0;
  for (std::size_t i = 0; i < strips_.size(); ++i) {
    if (strips_[i].face != face) at = atlas_.map.face_offsets[face = strips_[i].face];
    at += std::exchange(places[i], at);
  }
  write_claims(places);
  for (const auto& [f, texel] : extra) {
    atlas_.map.claims[atlas_.map.face_offsets[f]] = texel;
    cover(atlas_.map.tile_of(f), texel);
  }
}

std::vector<std::size_t> Claimer::count_claims() const {
  std::vector<std::size_t> counts(strips_.size(), 0);
  parallel_over(strips_.size(), [&](std::size_t i) {
    std::size_t count = 0;
    claim_rows(strips_[i], [&](std::int32_t, std::int32_t begin, std::int32_t end) {
      count += std::size_t(end - begin);
    });
    counts[i] = count;
  });
  return counts;
}

/// Make room for so many claims per face.
void Claimer::lay_out(const std::vector<std::size_t>& counts) {
  atlas_.map.face_offsets.assign(counts.size() + 1, 0);
  std::size_t total = 0;
  for (std::size_t f = 0; f < counts.size(); ++f) {
    total += counts[f];
    if (double(total) > kMostClaims)
      throw InputError("the UVs repeat the texture too often: more than 2^31 texels are covered");
    atlas_.map.face_offsets[f + 1] = Index(total);
  }
  atlas_.map.claims.resize(total);
}

/// \param places per strip, of its first claim
void Claimer::write_claims(const std::vector<std::size_t>& places) {
  parallel_over(strips_.size(), [&](std::size_t i) {
    TexelClaim* out = atlas_.map.claims.data() + places[i];
    const TexelTile tile = atlas_.map.tile_of(strips_[i].face);
    claim_rows(strips_[i], [&](std::int32_t row, std::int32_t begin, std::int32_t end) {
      for (std::int32_t x = begin; x < end; ++x) {
        *out = {x, row};
        cover(tile, *out++);
      }
    });
  });
}

void Claimer::cover(const TexelTile& tile, const TexelClaim& claim) {
  std::atomic_ref<Coverage>(atlas_.map.coverage[tile.texel(claim)])
      .store(Coverage::covered, std::memory_order_relaxed);
}

}  // namespace

std::vector<Strip> make_strips(const Atlas& atlas) {
  std::vector<Strip> strips;
  for (Index f = 0; f < atlas.mesh.faces.size(); ++f) {
    if (!atlas.rasterised(f)) continue;
    auto rows = atlas.triangle(f).rows(atlas.tolerance);
    const TexelTile tile = atlas.map.tile_of(f);
    clip(tile.wrap.v, rows, tile.height);
    for (auto row = rows.first; row < rows.second; row += kStripRows)
      strips.push_back(
          {f, std::int32_t(row), std::int32_t(std::min(row + kStripRows, rows.second))});
  }
  return strips;
}

void claim_texels(const Atlas& atlas, const std::vector<Strip>& strips) {
  Claimer(atlas, strips).claim();
}

}  // namespace onmesh
