#include "onmesh/render/clip.h"

namespace onmesh {

std::vector<FacePart> clip_face(const std::array<Vec3, 3>& corners,
                                const std::vector<ViewPlane>& planes) {
  const FacePart whole = whole_face();
  std::vector<Vec3> polygon(whole.begin(), whole.end()), kept;
  for (const ViewPlane& plane : planes) {
    // Depth behind the plane is linear in the barycentric coordinates.
    Vec3 depths;
    for (int k = 0; k < 3; ++k)
      depths[k] = plane.normal.dot(corners[std::size_t(k)]) + plane.offset;
    kept.clear();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      const double da = depths.dot(a), db = depths.dot(b);
      if (da >= 0) kept.push_back(a);
      if ((da > 0 && db < 0) || (da < 0 && db > 0)) kept.push_back(a + (b - a) * (da / (da - db)));
    }
    polygon.swap(kept);
  }
  std::vector<FacePart> parts;
  for (std::size_t i = 2; i < polygon.size(); ++i)
    parts.push_back({polygon[0], polygon[i - 1], polygon[i]});
  return parts;
}

}  // namespace onmesh
