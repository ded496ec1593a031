#include "onmesh/patches/grow_patch.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

namespace onmesh {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Numbers keys 0, 1, 2, ... in the order of their first appearance (open addressing).
class Numbering {
 public:
  explicit Numbering(std::size_t expected)
      : slots_(std::bit_ceil(std::max<std::size_t>(64, 2 * expected)), kNone) {}

  const std::vector<Index>& keys() const { return keys_; }
  Index find(Index key) const { return slots_[slot(key)]; }
  Index find_or_add(Index key) {
    std::size_t at = slot(key);
    if (slots_[at] != kNone) return slots_[at];
    if (2 * (keys_.size() + 1) > slots_.size()) {
      slots_.assign(2 * slots_.size(), kNone);
      for (Index i = 0; i < keys_.size(); ++i) slots_[slot(keys_[i])] = i;
      at = slot(key);
    }
    slots_[at] = Index(keys_.size());
    keys_.push_back(key);
    return slots_[at];
  }

 private:
  std::size_t slot(Index key) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t at = (std::uint64_t(key) * 0x9e3779b97f4a7c15U >> 20) & mask;
    while (slots_[at] != kNone && keys_[slots_[at]] != key) at = (at + 1) & mask;
    return at;
  }

  std::vector<Index> slots_, keys_;
};

// Without std::hypot's care for squares that overflow, which lengths in working units don't need.
double length(double x, double y) { return std::sqrt(x * x + y * y); }

// A lower estimate of the distance at the third corner of a triangle from those at the ends of its
// edge of length l; a and b are the other edges' lengths. The least of the paths along the edges,
// from a point source, and from a straight front (which is what the core's edges send out); only
// rays that cross the edge count.
double distance_across(double da, double db, double l, double a, double b) {
  // No path to the third corner is shorter than those to the edge, whatever rounding says.
  const double least = std::min(da, db);
  double best = std::min(da + a, db + b);
  if (!(l > 0) || da == kInfinity || db == kInfinity) return best;
  const double x = (l * l + a * a - b * b) / (2 * l);
  const double y = std::sqrt(std::max(0.0, a * a - x * x));

  const double sx = ((da - db) * (da + db) + l * l) / (2 * l);
  const double sy2 = da * da - sx * sx;
  if (sy2 >= 0) {
    const double sy = std::sqrt(sy2);
    const double crossing = sx * y + x * sy;
    if (crossing >= 0 && crossing <= l * (y + sy))
      best = std::min(best, std::max(length(x - sx, y + sy), least));
  }
  const double nx = (db - da) / l;
  if (std::abs(nx) < 1) {
    const double ny = std::sqrt(1 - nx * nx);
    const double crossing = x * ny - nx * y;
    if (crossing >= 0 && crossing <= l * ny)
      best = std::min(best, std::max(da + nx * x + ny * y, least));
  }
  return best;
}

struct Growth {
  Numbering nodes;
  std::vector<double> distance;  // per numbered node
  double noise = 1e-9;           // relative error that was put up with
};

// How far from the core faces are wanted.
struct Reach {
  double everywhere = 0;
  double per_extent = 0;  // and so much farther for each unit of a face's extent
  const std::vector<double>* extents = nullptr;  // per node of the mesh

  double at(const NodeMesh& mesh, Index face) const {
    if (extents == nullptr) return everywhere;
    const auto& n = mesh.faces[face];
    return everywhere +
           per_extent * std::max({(*extents)[n[0]], (*extents)[n[1]], (*extents)[n[2]]});
  }
};

Growth march_from(const NodeMesh& mesh, const Numbering& core, const Reach& reach) {
  Growth growth{Numbering(3 * core.keys().size()), {}};
  const auto number = [&](Index node) {
    const Index i = growth.nodes.find_or_add(node);
    if (i == growth.distance.size()) growth.distance.push_back(kInfinity);
    return i;
  };
  using Entry = std::pair<double, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  for (const Index f : core.keys())
    for (const Index v : mesh.faces[f]) growth.distance[number(v)] = 0;
  for (Index i = 0; i < growth.distance.size(); ++i) {
    const Index v = growth.nodes.keys()[i];
    const bool inside = std::all_of(mesh.node_faces.begin() + mesh.node_offsets[v],
                                    mesh.node_faces.begin() + mesh.node_offsets[v + 1],
                                    [&](Index f) { return core.find(f) != kNone; });
    if (!inside) queue.push({0, i});
  }
  // Most nodes are visited a few times. The estimates of thin faces can lower each other by less
  // and less for a very long time; then more and more counts as noise.
  std::size_t visits = 0, patience = 1000;
  while (!queue.empty()) {
    const auto [d, i] = queue.top();
    queue.pop();
    if (d > growth.distance[i]) continue;
    if (++visits > patience + 8 * growth.distance.size()) {
      patience += growth.distance.size();
      growth.noise = std::min(1.0, 2 * growth.noise);
    }
    const Index v = growth.nodes.keys()[i];
    for (Index at = mesh.node_offsets[v]; at < mesh.node_offsets[v + 1]; ++at) {
      const Index f = mesh.node_faces[at];
      const auto& l = mesh.lengths[f];
      // Beyond this the face can neither be within reach nor help one that is: farther away reaches
      // grow by less than the distance.
      const double longest = std::max({l[0], l[1], l[2]});
      if (d - longest > reach.at(mesh, f)) continue;
      const auto& corner = mesh.faces[f];
      const std::array<Index, 3> n{number(corner[0]), number(corner[1]), number(corner[2])};
      const bool bridge = f >= mesh.faces.size() - mesh.bridge_faces;
      for (int k = 0; k < 3; ++k) {
        const int a = (k + 1) % 3, b = (k + 2) % 3;
        if (n[a] != i && n[b] != i) continue;
        const double there =
            bridge && k != 0
                ? growth.distance[n[0]] + (k == 1 ? l[0] : l[2])
                : distance_across(growth.distance[n[a]], growth.distance[n[b]], l[a], l[k], l[b]);
        // A threshold, so that rounding cannot keep the march busy.
        if (there >= growth.distance[n[k]] * (1 - growth.noise) - 1e-12 * longest) continue;
        growth.distance[n[k]] = there;
        queue.push({there, n[k]});
      }
    }
  }
  return growth;
}

// Whether the face can hold a point within reach: on each edge the distance is at least
// (d_a + d_b - l) / 2, and paths enter the face over an edge.
bool within(const Growth& growth, const NodeMesh& mesh, Index face, double reach) {
  if (growth.noise > 1e-9) reach *= 1 + 16 * growth.noise;  // noise may add up on the way
  std::array<double, 3> d;
  for (int k = 0; k < 3; ++k) {
    const Index i = growth.nodes.find(mesh.faces[face][k]);
    d[k] = i == kNone ? kInfinity : growth.distance[i];
  }
  for (int k = 0; k < 3; ++k)
    if (d[k] + d[(k + 1) % 3] - mesh.lengths[face][k] <= 2 * reach) return true;
  return false;
}

// The core's faces and, after them, the others that can hold a point within reach.
Numbering faces_within(const NodeMesh& mesh, const std::vector<Index>& core_faces,
                       const Reach& reach) {
  Numbering faces(4 * core_faces.size());
  for (const Index f : core_faces) faces.find_or_add(f);
  const Growth growth = march_from(mesh, faces, reach);

  std::vector<Index> halo;
  for (const Index v : growth.nodes.keys())
    for (Index at = mesh.node_offsets[v]; at < mesh.node_offsets[v + 1]; ++at)
      halo.push_back(mesh.node_faces[at]);
  std::sort(halo.begin(), halo.end());
  halo.erase(std::unique(halo.begin(), halo.end()), halo.end());
  for (const Index f : halo)  // ascending, so that bridges come last
    if (faces.find(f) == kNone && within(growth, mesh, f, reach.at(mesh, f))) faces.find_or_add(f);
  return faces;
}

// The faces, of which so many are the core, as a complex of their own.
Patch cut_out(const NodeMesh& mesh, const Numbering& faces, Index core_faces) {
  Numbering nodes(std::size_t{4} * core_faces);
  Patch patch;
  patch.faces = faces.keys();
  patch.core_faces = core_faces;
  patch.corners.reserve(patch.faces.size());
  patch.lengths.reserve(patch.faces.size());
  for (Index i = 0; i < patch.faces.size(); ++i) {
    const auto& corner = mesh.faces[patch.faces[i]];
    const auto& l = mesh.lengths[patch.faces[i]];
    patch.corners.push_back(
        {nodes.find_or_add(corner[0]), nodes.find_or_add(corner[1]), nodes.find_or_add(corner[2])});
    patch.lengths.push_back(l);
    patch.longest_edge = std::max({patch.longest_edge, l[0], l[1], l[2]});
    patch.bridge_faces += patch.faces[i] >= mesh.faces.size() - mesh.bridge_faces;
    if (i + 1 == patch.core_faces) patch.core_nodes = Index(nodes.keys().size());
  }
  patch.nodes = nodes.keys();

  if (!mesh.neighbours.empty()) {
    patch.neighbours.assign(patch.faces.size(), {kNone, kNone, kNone});
    for (Index i = 0; i < patch.faces.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        const Index across = mesh.neighbours[patch.faces[i]][k];
        if (across == kNone) continue;
        const Index local = faces.find(across / 3);
        if (local != kNone) patch.neighbours[i][k] = 3 * local + across % 3;
      }
  }
  return patch;
}

Patch grow(const NodeMesh& mesh, const std::vector<Index>& core_faces, const Reach& reach) {
  return cut_out(mesh, faces_within(mesh, core_faces, reach), Index(core_faces.size()));
}

}  // namespace

Patch grow_patch(const NodeMesh& mesh, const std::vector<Index>& core_faces, double reach) {
  return grow(mesh, core_faces, {reach});
}

Patch grow_patch(const NodeMesh& mesh, const std::vector<Index>& core_faces, double radius,
                 const std::vector<double>& extents) {
  // A path between corners i and j of two faces is at most radius + e_i + e_j long, and j at most
  // radius + e_j from the core. So its points are at most radius + e_i / 2 + e_j from the core, and
  // e_j is at most the extent there plus a third of e_i / 2 and of an edge. The corners of the
  // faces that it crosses are an edge beyond.
  double in_core = 0;
  for (const Index f : core_faces)
    for (const Index n : mesh.faces[f]) in_core = std::max(in_core, extents[n]);
  Patch patch = grow(mesh, core_faces, {radius + in_core * 2 / 3, 7.0 / 3, &extents});
  patch.extents.reserve(patch.nodes.size());
  for (const Index n : patch.nodes) patch.extents.push_back(extents[n]);
  return patch;
}

}  // namespace onmesh
