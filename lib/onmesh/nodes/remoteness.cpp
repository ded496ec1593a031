#include "onmesh/nodes/remoteness.h"

#include <algorithm>

#include "onmesh/base/error.h"

namespace onmesh {

Remoteness::Remoteness(const TriangleMesh& mesh, const RefineOptions& options)
    : mesh_(mesh), options_(options) {
  const std::vector<bool>& needed = options.needed;
  if (needed.empty()) return;
  if (needed.size() != mesh.faces.size()) {
    throw UsageError("needed: one entry per face of the mesh is wanted");
  }
  if (std::find(needed.begin(), needed.end(), false) == needed.end()) return;
  needed_.positions = mesh.positions;
  const double least_area = 1e-12 * mesh.diagonal() * mesh.diagonal();
  bool has_area = false;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (!needed[f]) continue;
    needed_.faces.push_back(mesh.faces[f]);
    has_area = has_area || mesh.face_area(f) > least_area;
  }
  if (has_area) nearest_.emplace(needed_);
}

double Remoteness::operator()(const SurfacePoint& point) const {
  if (!nearest_ || point.face == kNone || options_.needed[point.face]) return 0;
  const Vec3 at = mesh_.position(point);
  const double distance = (needed_.position(nearest_->closest(at)) - at).norm();
  return options_.growth * std::max(0.0, distance - options_.reach);
}

}  // namespace onmesh
