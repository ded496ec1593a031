// Pictures of textured models, on the CPU.
#pragma once

#include <optional>
#include <vector>

#include "onmesh/image.h"
#include "onmesh/triangle_mesh.h"

namespace onmesh {

struct RenderOptions {
  int width = 800, height = 800;
  double azimuth_degrees = 35, elevation_degrees = 25;  ///< camera direction around the model's centre
  double zoom = 1;
  bool light = true;             ///< soft headlight shading; off shows texture values as they are
  bool wireframe = false;        ///< draw the mesh's edges
  Vec3 background{1, 1, 1};
  Vec3 up{0, 1, 0};
};

/// What colours the surface: a texture with UVs, or a scalar per vertex with isolines.
struct RenderColour {
  const Image* texture = nullptr;
  const std::vector<double>* scalar = nullptr;  ///< per vertex; not finite = grey
  double isoline_step = 0;                      ///< 0 = a twentieth of the range
};

/// Perspective z-buffer rendering with bilinear look-ups and 2 x 2 supersampling; 3 channels.
/// Faces without UVs are grey.
Image render(const TriangleMesh& mesh, const RenderColour& colour, const RenderOptions& options);

/// Pictures of equal height beside each other with a gap.
Image beside(const std::vector<Image>& pictures, int gap = 8);

}  // namespace onmesh
