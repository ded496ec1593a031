#include "onmesh/mesh/coincident_faces.h"

#include <algorithm>
#include <tuple>

#include "onmesh/base/disjoint_sets.h"
#include "onmesh/mesh/edge_table.h"

namespace onmesh {
namespace {

/// The UV indices that a face has at the ends of an edge.
std::array<Index, 2> uvs_along(const TriangleMesh& mesh, const EdgeSide& side,
                               const std::array<Index, 2>& ends) {
  std::array<Index, 2> uvs;
  for (std::size_t i = 0; i < 2; ++i) {
    const Index corner = corner_at(mesh, side, ends[i]);
    uvs[i] = mesh.face_uvs[corner / 3][corner % 3];
  }
  return uvs;
}

/// How well two faces go on into each other across an edge.
int fit(const TriangleMesh& mesh, const std::array<Index, 2>& ends, const EdgeSide& a,
        const EdgeSide& b) {
  const auto uvs = uvs_along(mesh, a, ends);
  const bool same_uvs = uvs[0] != kNone && uvs[1] != kNone && uvs == uvs_along(mesh, b, ends);
  return 2 * same_uvs + (a.forward != b.forward);
}

/// The sides among `all` that belong to the stack.
std::vector<EdgeSide> sides_of(std::span<const EdgeSide> all, const std::vector<Index>& stack_of,
                               Index stack) {
  std::vector<EdgeSide> sides;
  for (const EdgeSide& s : all) {
    if (stack_of[s.face] == stack) sides.push_back(s);
  }
  return sides;
}

/// Takes the layers of stacks apart. A stack is the faces on the same three vertices, a sheet the
/// layers of several stacks that go on into each other, a region the stacks that are joined so.
class LayerSeparation {
 public:
  explicit LayerSeparation(TriangleMesh& mesh)
      : mesh_(mesh),
        edges_(mesh),
        stack_of_(mesh.faces.size(), kNone),
        sheets_(mesh.faces.size()),
        regions_(mesh.faces.size()),
        fans_(3 * mesh.faces.size()) {
    const std::vector<Index> earlier = earlier_copies(mesh);
    for (Index f = 0; f < earlier.size(); ++f) {
      if (earlier[f] != kNone) stack_of_[f] = stack_of_[earlier[f]] = earlier[f];
    }
  }

  /// \return number of faces that were given copies of vertices
  Index run() {
    join_sheets();
    choose_keepers();
    return give_copies();
  }

 private:
  bool stacked(Index face) const { return stack_of_[face] != kNone; }

  void join_sheets() {
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      std::vector<Index> stacks;
      for (const EdgeSide& s : edges_.sides(e)) {
        if (stacked(s.face)) stacks.push_back(stack_of_[s.face]);
      }
      std::sort(stacks.begin(), stacks.end());
      stacks.erase(std::unique(stacks.begin(), stacks.end()), stacks.end());
      if (stacks.size() == 2) join_stacks(e, stacks[0], stacks[1]);
    }
  }

  // Pair the faces of two stacks off across an edge, the best fits first.
  void join_stacks(std::size_t edge, Index first, Index second) {
    const auto& ends = edges_.vertices(edge);
    const auto a = sides_of(edges_.sides(edge), stack_of_, first);
    const auto b = sides_of(edges_.sides(edge), stack_of_, second);
    std::vector<std::tuple<int, std::size_t, std::size_t>> pairs;
    for (std::size_t i = 0; i < a.size(); ++i) {
      for (std::size_t j = 0; j < b.size(); ++j) {
        pairs.emplace_back(-fit(mesh_, ends, a[i], b[j]), i, j);
      }
    }
    std::sort(pairs.begin(), pairs.end());
    std::vector<bool> a_taken(a.size(), false), b_taken(b.size(), false);
    for (const auto& [score, i, j] : pairs) {
      if (a_taken[i] || b_taken[j]) continue;
      a_taken[i] = b_taken[j] = true;
      sheets_.join(a[i].face, b[j].face);
      for (const Index v : ends) {
        fans_.join(corner_at(mesh_, a[i], v), corner_at(mesh_, b[j], v));
      }
    }
    regions_.join(first, second);
  }

  // In every region of stacks joined to each other, one sheet keeps the vertices.
  void choose_keepers() {
    std::vector<int> score(mesh_.faces.size(), 0);
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      for (const EdgeSide& s : edges_.sides(e)) {
        if (!stacked(s.face)) continue;
        for (const EdgeSide& other : edges_.sides(e)) {
          if (stacked(other.face)) continue;
          score[sheets_.find(s.face)] += fit(mesh_, edges_.vertices(e), s, other);
        }
      }
    }
    keeper_.assign(mesh_.faces.size(), kNone);
    for (Index f = 0; f < mesh_.faces.size(); ++f) {
      if (!stacked(f)) continue;
      Index& keeper = keeper_[regions_.find(stack_of_[f])];
      const Index sheet = sheets_.find(f);
      if (keeper == kNone || score[sheet] > score[keeper]) keeper = sheet;
    }
  }

  // Per sheet: it has two layers in one stack.
  std::vector<bool> find_sheets_on_themselves() {
    std::vector<bool> on_itself(mesh_.faces.size(), false);
    std::vector<std::array<Index, 2>> layers;
    for (Index f = 0; f < mesh_.faces.size(); ++f) {
      if (stacked(f)) layers.push_back({stack_of_[f], sheets_.find(f)});
    }
    std::sort(layers.begin(), layers.end());
    for (std::size_t i = 1; i < layers.size(); ++i) {
      if (layers[i] == layers[i - 1]) on_itself[layers[i][1]] = true;
    }
    return on_itself;
  }

  // A fan keeps its vertex if its sheet does; but the two-sided cover of a Moebius strip is one
  // sheet that lies on itself: there the first fan of every vertex keeps it.
  Index give_copies() {
    const std::vector<bool> on_itself = find_sheets_on_themselves();
    std::vector<Index> keeping_fan(mesh_.positions.size(), kNone);
    std::vector<Index> copy_of(3 * mesh_.faces.size(), kNone);  // per fan
    Index moved = 0;
    for (Index f = 0; f < mesh_.faces.size(); ++f) {
      if (!stacked(f)) continue;
      const Index sheet = sheets_.find(f);
      const bool keeps = keeper_[regions_.find(stack_of_[f])] == sheet;
      bool copied = false;
      for (Index k = 0; k < 3; ++k) {
        Index& vertex = mesh_.faces[f][k];
        const Index fan = fans_.find(3 * f + k);
        if (keeps) {
          if (!on_itself[sheet]) continue;
          if (keeping_fan[vertex] == kNone) keeping_fan[vertex] = fan;
          if (keeping_fan[vertex] == fan) continue;
        }
        if (copy_of[fan] == kNone) {
          copy_of[fan] = static_cast<Index>(mesh_.positions.size());
          const Vec3 position = mesh_.positions[vertex];
          mesh_.positions.push_back(position);
        }
        vertex = copy_of[fan];
        copied = true;
      }
      moved += copied;
    }
    return moved;
  }

  TriangleMesh& mesh_;
  const EdgeTable edges_;
  std::vector<Index> stack_of_;  // per face: the first one on its vertices; kNone if it is alone
  DisjointSets sheets_;          // of faces
  DisjointSets regions_;         // of stacks, by their first faces
  DisjointSets fans_;            // of corners
  std::vector<Index> keeper_;    // per region
};

}  // namespace

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

Index separate_coincident_faces(TriangleMesh& mesh) { return LayerSeparation(mesh).run(); }

}  // namespace onmesh
