#include "onmesh/atlas/settle_claims.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <optional>
#include <unordered_set>

#include "onmesh/base/parallel.h"

namespace onmesh {
namespace {

/// Areas that differ by rounding are equal.
constexpr double kRounding = 1e-9;
/// More charts in one texel, or more pairs of their faces, are not looked at: such charts are much
/// smaller than a texel, and share it.
constexpr Index kMostCharts = 16;
constexpr std::size_t kMostPairs = 1 << 16;

/// Numbers the members of a set of texels, in ascending order.
class Numbering {
 public:
  Numbering(const std::vector<Index>& members, std::size_t texels)
      : bits_(texels / 64 + 1, 0), before_(bits_.size(), 0) {
    for (const Index t : members) bits_[t / 64] |= std::uint64_t{1} << (t % 64);
    for (std::size_t i = 1; i < bits_.size(); ++i)
      before_[i] = before_[i - 1] + Index(std::popcount(bits_[i - 1]));
  }
  /// kNone if the texel is no member.
  Index number(Index texel) const {
    const std::uint64_t bit = std::uint64_t{1} << (texel % 64), word = bits_[texel / 64];
    if ((word & bit) == 0) return kNone;
    return before_[texel / 64] + Index(std::popcount(word & (bit - 1)));
  }

 private:
  std::vector<std::uint64_t> bits_;
  std::vector<Index> before_;  // members in the words before each
};

class Settler {
 public:
  Settler(const Atlas& atlas, const std::vector<Index>& shared)
      : atlas_(atlas), shared_(shared), numbering_(shared, atlas.map.coverage.size()) {}
  void settle();

 private:
  struct Claim {
    Index face;
    Index place;  ///< among the map's claims
  };
  /// What a chart has of a texel's square.
  struct Part {
    std::vector<Index> faces;  ///< at most kMostPairs
    TexelClaim at;             ///< the chart's own, not wrapped
    double area;               ///< texels
  };

  void gather();
  const Claim* begin(Index i) const { return claims_.data() + offsets_[i]; }
  const Claim* end(Index i) const { return claims_.data() + offsets_[i + 1]; }
  Index chart(const Claim& claim) const { return atlas_.map.chart_of_face[claim.face]; }
  bool has_both(const TexelTile& tile, const TexelClaim& at, Index a, Index b) const;
  bool lie_on_each_other(const Claim& a, const Claim& b) const;
  Part part_of(const Claim& claim) const;
  bool touch(const Part& a, const Part& b) const;
  std::optional<Index> only_claim(Index i) const;

  const Atlas& atlas_;
  const std::vector<Index>& shared_;
  const Numbering numbering_;
  std::vector<Index> offsets_;  // claims of shared texel i: claims_[offsets_[i], offsets_[i + 1])
  std::vector<Claim> claims_;   // per texel in the order of faces
};

/// Sort the claims of shared texels by texel.
void Settler::gather() {
  const TexelMap& map = atlas_.map;
  offsets_.assign(shared_.size() + 1, 0);
  const auto each = [&](auto&& visit) {
    for (Index f = 0; f + 1 < map.face_offsets.size(); ++f) {
      for (Index k = map.face_offsets[f]; k < map.face_offsets[f + 1]; ++k) {
        const Index i = numbering_.number(map.tile_of(f).texel(map.claims[k]));
        if (i != kNone) visit(i, Claim{f, k});
      }
    }
  };
  each([&](Index i, const Claim&) { ++offsets_[i + 1]; });
  for (std::size_t i = 0; i < shared_.size(); ++i) offsets_[i + 1] += offsets_[i];
  claims_.resize(offsets_.back());
  std::vector<Index> next(offsets_.begin(), offsets_.end() - 1);
  each([&](Index i, const Claim& claim) { claims_[next[i]++] = claim; });
}

/// Whether both charts claim the texel.
bool Settler::has_both(const TexelTile& tile, const TexelClaim& at, Index a, Index b) const {
  if (!tile.holds(at)) return false;
  const Index i = numbering_.number(tile.texel(at));
  if (i == kNone) return false;
  bool has_a = false, has_b = false;
  for (const Claim* c = begin(i); c != end(i); ++c) {
    has_a = has_a || chart(*c) == a;
    has_b = has_b || chart(*c) == b;
  }
  return has_a && has_b;
}

/// Whether both charts claim two by two centres, this texel's or a neighbour's among them.
bool Settler::lie_on_each_other(const Claim& a, const Claim& b) const {
  const TexelTile tile = atlas_.map.tile_of(a.face);
  const TexelClaim at = atlas_.map.claims[a.place];
  const auto both = [&](int x, int y) {
    return has_both(tile, {at.x + x, at.y + y}, chart(a), chart(b));
  };
  for (const int y : {0, -1, 1, -2}) {  // those with the texel itself first: most often they are
    for (const int x : {0, -1, 1, -2})
      if (both(x, y) && both(x + 1, y) && both(x, y + 1) && both(x + 1, y + 1)) return true;
  }
  return false;
}

/// The claim's face and those of its chart around it that meet the texel.
Settler::Part Settler::part_of(const Claim& claim) const {
  const TexelClaim at = atlas_.map.claims[claim.place];
  Part part{{claim.face}, at, 0};
  std::unordered_set<Index> met{claim.face};
  for (std::size_t i = 0; i < part.faces.size(); ++i) {
    const Index f = part.faces[i];
    part.area += atlas_.triangle(f).area_in(at.x, at.y);
    for (int k = 0; k < 3; ++k) {
      atlas_.neighbours.across_edge(f, k, [&](Index g) {
        if (atlas_.map.chart_of_face[g] != chart(claim) || part.faces.size() == kMostPairs) return;
        if (met.insert(g).second && atlas_.triangle(g).area_in(at.x, at.y) > 0)
          part.faces.push_back(g);
      });
    }
  }
  return part;
}

/// Whether two charts have less than kTouching of a texel's square in common.
bool Settler::touch(const Part& a, const Part& b) const {
  if (a.faces.size() * b.faces.size() > kMostPairs) return false;
  // Where one of them sees the texel turned over, the square is turned over with it.
  const TexelTile tile = atlas_.map.tile_of(a.faces[0]), other = atlas_.map.tile_of(b.faces[0]);
  const bool turn_x = tile.is_turned_x(a.at) != other.is_turned_x(b.at);
  const bool turn_y = tile.is_turned_y(a.at) != other.is_turned_y(b.at);
  const auto turn = [&](const Vec2& v, double size) {
    return Vec2(turn_x ? size - v.x() : v.x(), turn_y ? size - v.y() : v.y());
  };
  double common_area = 0;
  for (const Index f : a.faces) {
    const ConvexPolygon part = atlas_.triangle(f).part_in(a.at.x, a.at.y);
    for (const Index g : b.faces) {
      const UvTriangle triangle = atlas_.triangle(g);
      const Vec2 corner{double(b.at.x), double(b.at.y)};
      ConvexPolygon common = part;
      for (const auto& e : triangle.edges)
        common.clip(turn(e.origin - corner, 1),
                    turn(e.sign * Vec2(-e.direction.y(), e.direction.x()), 0));
      common_area += common.area();
    }
  }
  return common_area < kTouching - kRounding;
}

/// The claim that a shared texel is left, as a place among the map's claims; none if all remain.
std::optional<Index> Settler::only_claim(Index i) const {
  if (offsets_[i + 1] - offsets_[i] > kMostCharts) return std::nullopt;
  for (const Claim* a = begin(i); a != end(i); ++a) {
    for (const Claim* b = begin(i); b != a; ++b)
      if (chart(*a) == chart(*b) || lie_on_each_other(*a, *b)) return std::nullopt;
  }
  std::vector<Part> parts;
  std::size_t best = 0;
  for (const Claim* c = begin(i); c != end(i); ++c) {
    parts.push_back(part_of(*c));
    if (parts.back().area > parts[best].area + kRounding) best = parts.size() - 1;
    for (std::size_t k = 0; k + 1 < parts.size(); ++k)
      if (!touch(parts[k], parts.back())) return std::nullopt;
  }
  return begin(i)[best].place;
}

void Settler::settle() {
  gather();
  std::vector<std::uint8_t> dropped(claims_.size(), 0);
  parallel_over(shared_.size(), [&](std::size_t i) {
    const std::optional<Index> only = only_claim(Index(i));
    for (Index k = offsets_[i]; only && k < offsets_[i + 1]; ++k)
      dropped[k] = claims_[k].place != *only;
  });
  TexelMap& map = atlas_.map;
  std::vector<Index> places;
  for (std::size_t k = 0; k < dropped.size(); ++k)
    if (dropped[k]) places.push_back(claims_[k].place);
  if (places.empty()) return;
  std::sort(places.begin(), places.end());
  // Move the others up.
  std::size_t gone = 0;
  Index kept = 0, face = 0;
  for (Index k = 0; k < map.claims.size(); ++k) {
    for (; map.face_offsets[face + 1] <= k; ++face) map.face_offsets[face + 1] = kept;
    if (gone < places.size() && places[gone] == k)
      ++gone;
    else
      map.claims[kept++] = map.claims[k];
  }
  for (; face + 1 < map.face_offsets.size(); ++face) map.face_offsets[face + 1] = kept;
  map.claims.resize(kept);
}

}  // namespace

void settle_claims(const Atlas& atlas) {
  const std::vector<Index> shared = atlas.map.overlapped();
  if (!shared.empty()) Settler(atlas, shared).settle();
}

}  // namespace onmesh
