// Whether rays meet a mesh.
#pragma once

#include <memory>

#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// Rays against the faces of a mesh (an AABB tree). Any number of threads may ask at once.
class RayCaster {
 public:
  /// \throw InputError if no face has area
  explicit RayCaster(const TriangleMesh& mesh);
  ~RayCaster();
  RayCaster(RayCaster&&) noexcept;

  /// Whether a segment meets any face.
  bool meets(const Vec3& from, const Vec3& to) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace onmesh
