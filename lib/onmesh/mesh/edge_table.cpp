#include "onmesh/mesh/edge_table.h"

#include <algorithm>

namespace onmesh {

EdgeTable::EdgeTable(const TriangleMesh& mesh) {
  struct Entry {
    Index high;
    EdgeSide side;
  };
  // Buckets by the lower vertex keep the sorting local and linear.
  std::vector<std::size_t> bucket(mesh.positions.size() + 1, 0);
  const auto for_each_side = [&](const auto& visit) {
    for (Index f = 0; f < mesh.faces.size(); ++f) {
      const auto& v = mesh.faces[f];
      if (has_repeated_vertex(v)) continue;
      for (std::uint8_t k = 0; k < 3; ++k) {
        const Index a = v[k], b = v[(k + 1) % 3];
        visit(std::min(a, b), std::max(a, b), EdgeSide{f, k, a < b});
      }
    }
  };
  for_each_side([&](Index low, Index, const EdgeSide&) { ++bucket[low + 1]; });
  for (std::size_t i = 1; i < bucket.size(); ++i) bucket[i] += bucket[i - 1];
  std::vector<Entry> entries(bucket.back());
  std::vector<std::size_t> next(bucket.begin(), bucket.end() - 1);
  for_each_side([&](Index low, Index high, const EdgeSide& side) {
    entries[next[low]++] = {high, side};
  });
  sides_.reserve(entries.size());
  for (Index low = 0; low + 1 < bucket.size(); ++low) {
    const auto begin = entries.begin() + static_cast<std::ptrdiff_t>(bucket[low]);
    const auto end = entries.begin() + static_cast<std::ptrdiff_t>(bucket[low + 1]);
    std::sort(begin, end, [](const Entry& a, const Entry& b) {
      return a.high != b.high ? a.high < b.high : a.side.face < b.side.face;
    });
    for (auto e = begin; e != end; ++e) {
      if (e == begin || e->high != e[-1].high) {
        offsets_.push_back(sides_.size());
        vertices_.push_back({low, e->high});
      }
      sides_.push_back(e->side);
    }
  }
  offsets_.push_back(sides_.size());
}

std::vector<Index> earlier_copies(const TriangleMesh& mesh) {
  struct Key {
    std::array<Index, 3> vertices;
    Index face;
  };
  std::vector<Key> keys;
  keys.reserve(mesh.faces.size());
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    auto v = mesh.faces[f];
    std::sort(v.begin(), v.end());
    keys.push_back({v, f});
  }
  std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
    return a.vertices != b.vertices ? a.vertices < b.vertices : a.face < b.face;
  });
  std::vector<Index> earlier(mesh.faces.size(), kNone);
  for (std::size_t i = 1; i < keys.size(); ++i) {
    if (keys[i].vertices != keys[i - 1].vertices) continue;
    const Index first = earlier[keys[i - 1].face];
    earlier[keys[i].face] = first == kNone ? keys[i - 1].face : first;
  }
  return earlier;
}

Winding consistent_winding(const TriangleMesh& mesh, const EdgeTable& edges) {
  constexpr std::uint32_t kBoundary = kNone;
  struct Neighbour {
    Index face = kBoundary;
    bool same_direction = false;
  };
  std::vector<std::array<Neighbour, 3>> neighbours(mesh.faces.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto s = edges.sides(e);
    if (s.size() != 2) continue;
    neighbours[s[0].face][s[0].corner] = {s[1].face, edges.inconsistent(e)};
    neighbours[s[1].face][s[1].corner] = {s[0].face, edges.inconsistent(e)};
  }
  Winding result;
  result.flip.assign(mesh.faces.size(), false);
  std::vector<bool> seen(mesh.faces.size(), false);
  std::vector<Index> component;
  for (Index seed = 0; seed < mesh.faces.size(); ++seed) {
    if (seen[seed]) continue;
    component.assign(1, seed);
    seen[seed] = true;
    double kept_area = 0, flipped_area = 0;
    bool one_sided = false;
    for (std::size_t i = 0; i < component.size(); ++i) {
      const Index f = component[i];
      (result.flip[f] ? flipped_area : kept_area) += mesh.face_area(f);
      for (const Neighbour& n : neighbours[f]) {
        if (n.face == kBoundary) continue;
        const bool flip = result.flip[f] != n.same_direction;
        if (!seen[n.face]) {
          seen[n.face] = true;
          result.flip[n.face] = flip;
          component.push_back(n.face);
        } else if (result.flip[n.face] != flip) {
          one_sided = true;
          result.conflict = std::min(result.conflict, f);
        }
      }
    }
    if (one_sided) {
      for (const Index f : component) result.flip[f] = false;
    } else if (flipped_area > kept_area) {
      for (const Index f : component) result.flip[f] = !result.flip[f];
    }
  }
  return result;
}

DisjointSets join_fans(const TriangleMesh& mesh, const EdgeTable& edges) {
  DisjointSets corners(3 * mesh.faces.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto sides = edges.sides(e);
    for (const Index v : edges.vertices(e)) {
      for (std::size_t i = 1; i < sides.size(); ++i) {
        corners.join(corner_at(mesh, sides[0], v), corner_at(mesh, sides[i], v));
      }
    }
  }
  return corners;
}

std::vector<Index> count_fans(const TriangleMesh& mesh, DisjointSets& fans) {
  std::vector<Index> count(mesh.positions.size(), 0);
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (has_repeated_vertex(mesh.faces[f])) continue;
    for (Index k = 0; k < 3; ++k) {
      if (fans.find(3 * f + k) == 3 * f + k) ++count[mesh.faces[f][k]];
    }
  }
  return count;
}

}  // namespace onmesh
