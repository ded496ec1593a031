// Books: pages that share their spine, an edge of as many faces as there are pages.
#pragma once

#include <algorithm>
#include <cmath>

#include "support/simple_shapes.h"

namespace onmesh {

/// Three squares of side 1 at 120 degrees, n x n quads each, on a spine along the z axis: any two
/// pages make a flat sheet.
inline TriangleMesh three_pages(int n) {
  TriangleMesh book;
  for (int page = 0; page < 3; ++page) {
    TriangleMesh sheet = simple::plane(n, n, 1, 1);
    const double angle = 2 * simple::kPi * page / 3;
    std::vector<Index> to_book;
    for (const Vec3& p : sheet.positions) {
      const Vec3 q(p.x() * std::cos(angle), p.x() * std::sin(angle), p.y());
      const auto same = std::find_if(book.positions.begin(), book.positions.end(),
                                     [&](const Vec3& r) { return (r - q).norm() < 1e-12; });
      to_book.push_back(Index(same - book.positions.begin()));
      if (same == book.positions.end()) book.positions.push_back(q);
    }
    for (const auto& f : sheet.faces)
      book.faces.push_back({to_book[f[0]], to_book[f[1]], to_book[f[2]]});
  }
  return book;
}

}  // namespace onmesh
