// The faces around some targets, compiled once per instruction set.
#if defined(ONMESH_KERNEL_NEIGHBOURHOOD_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ONMESH_KERNEL_NEIGHBOURHOOD_INL_H_
#undef ONMESH_KERNEL_NEIGHBOURHOOD_INL_H_
#else
#define ONMESH_KERNEL_NEIGHBOURHOOD_INL_H_
#endif

#include <algorithm>
#include <utility>

#include "onmesh/kernel/direct/records.h"
#include "onmesh/kernel/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace onmesh {
namespace HWY_NAMESPACE {
namespace {

/// The faces near some consecutive targets, with their corners renumbered. Which faces can hold a
/// sample within the radius is decided once for several vectors of targets: a patch may be large.
class Neighbourhood {
 public:
  struct Face {
    std::array<Index, 3> corners;  ///< into nodes
    float slack;
    std::size_t begin, end;  ///< records
    Index number;            ///< in PatchRecords::faces
  };
  std::vector<Index> nodes;  ///< local nodes of the patch
  std::vector<Face> faces;
  /// The faces' corners and slacks once more, padded by a vector.
  std::array<std::vector<std::int32_t>, 3> corners;
  std::vector<float> slacks;
  std::size_t samples = 0;  ///< in all faces

  Neighbourhood(const KernelInput& input, const PatchRecords& records)
      : table_(*input.table),
        records_(records),
        nearest_(table_.columns),
        index_(table_.columns),
        is_listed_(table_.columns) {}

  /// Find the faces near the `count` targets from `first` on.
  void find(std::size_t first, std::size_t count) {
    list_corners(first, count);
    find_nearest();
    clear();
    for (Index f = 0; f < records_.faces.size(); ++f) {
      const PatchRecords::Face& face = records_.faces[f];
      const auto& n = face.corners;
      const float farthest = std::max({nearest_[n[0]], nearest_[n[1]], nearest_[n[2]]});
      if (farthest <= face.reach_squared) add(face, f);
    }
    for (auto& corner : corners) corner.resize(faces.size() + hn::Lanes(D()), 0);
    slacks.resize(faces.size() + hn::Lanes(D()), 0);
  }

 private:
  /// The corners of the targets' faces, each once.
  void list_corners(std::size_t first, std::size_t count) {
    corners_.clear();
    for (std::size_t k = first; k < first + count; ++k) {
      for (const Index corner : records_.targets[k].corners) {
        if (std::exchange(is_listed_[corner], 1) == 0) corners_.push_back(corner);
      }
    }
    for (const Index corner : corners_) is_listed_[corner] = 0;
  }

  void find_nearest() {
    std::fill(nearest_.begin(), nearest_.end(), kUnreachable);
    for (const Index corner : corners_) {
      const float* const row = table_.row(corner);
      float* const nearest = nearest_.data();
      const std::size_t columns = nearest_.size();
      for (std::size_t n = 0; n < columns; ++n) {
        nearest[n] = row[n] < nearest[n] ? row[n] : nearest[n];
      }
    }
  }

  void clear() {
    nodes.clear();
    faces.clear();
    samples = 0;
    for (auto& corner : corners) corner.clear();
    slacks.clear();
    std::fill(index_.begin(), index_.end(), kNone);
  }

  void add(const PatchRecords::Face& face, Index number) {
    Face& near = faces.emplace_back(Face{{}, face.slack, face.begin, face.end, number});
    for (int i = 0; i < 3; ++i) {
      Index& index = index_[face.corners[i]];
      if (index == kNone) {
        index = Index(nodes.size());
        nodes.push_back(face.corners[i]);
      }
      near.corners[i] = index;
      corners[i].push_back(std::int32_t(index));
    }
    slacks.push_back(face.slack);
    samples += face.end - face.begin;
  }

  const DistanceTable& table_;
  const PatchRecords& records_;
  std::vector<Index> corners_;            ///< of the targets' faces
  std::vector<float> nearest_;            ///< per node: its smallest squared distance to those
  std::vector<Index> index_;              ///< per node: in nodes, or kNone
  std::vector<unsigned char> is_listed_;  ///< in corners_
};

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace onmesh
HWY_AFTER_NAMESPACE();

#endif  // ONMESH_KERNEL_NEIGHBOURHOOD_INL_H_
