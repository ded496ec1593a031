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

}  // namespace onmesh
