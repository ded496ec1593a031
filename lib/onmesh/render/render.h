// Pictures of textured models, on the CPU.
#pragma once

#include <optional>
#include <vector>

#include "onmesh/image/image.h"
#include "onmesh/image/lookup.h"
#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// How render() looks at the model.
struct RenderOptions {
  int width = 800;                ///< pixels, [1, 16384]
  int height = 800;               ///< the same
  double azimuth_degrees = 35;    ///< camera direction around `up`; 0 = from +z (+y up), -y (+z up)
  double elevation_degrees = 25;  ///< above the horizon, [-90, 90]
  double zoom = 1;                ///< 1 = the model fills the picture, (0, 1000]
  /// The point in the middle of the picture, mesh units; none = the model is framed.
  std::optional<Vec3> target = std::nullopt;
  /// With `target`: mesh units that the picture's height is there, > 0; 0 = the model's size.
  double extent = 0;
  int supersampling = 2;     ///< samples per pixel and direction, [1, 8]
  bool light = true;         ///< soft headlight shading; off shows texture values as they are
  bool wireframe = false;    ///< draw the mesh's edges
  WrapModes wrap;            ///< what UVs outside [0,1] mean where materials do not say
  Vec3 background{1, 1, 1};  ///< a colour in [0,1]
  Vec3 up{0, 1, 0};          ///< a direction of the mesh's space, of any length
};

/// What colours the surface. The first that is set counts: a scalar per vertex with isolines, flat
/// colours per material, one texture for all faces, a texture per face; grey if none is.
struct RenderColour {
  const std::vector<double>* scalar =
      nullptr;                              ///< per vertex; faces with a value not finite are grey
  double isoline_step = 0;                  ///< 0 = a twentieth of the range, negative = none
  bool by_material = false;                 ///< one flat colour per material
  const Image* texture = nullptr;           ///< for all faces with UVs
  std::vector<const Image*> face_textures;  ///< per face, with UVs of its own tile; null = grey
};

/// Perspective z-buffer rendering with bilinear look-ups and supersampling.
///
/// Both sides of faces are drawn. Faces without UVs are grey, texture values are clamped to [0,1],
/// those that are not numbers are magenta. The camera looks at the model from outside, framed to
/// fit. Adjacent faces leave neither gaps nor double pixels; equal input gives equal bytes.
/// \return options.width x options.height pixels with 3 channels in [0,1]
/// \throw UsageError for options outside their domain
/// \throw InputError if the mesh has no faces, a position is not finite, or sizes do not match
Image render(const TriangleMesh& mesh, const RenderColour& colour, const RenderOptions& options);

/// The colour map for scalars: even steps of `t` in [0,1] look like even steps of lightness.
/// \return the encoded colour that a screen shows (sRGB), in [0,1]
Vec3 colour_map(double t);

}  // namespace onmesh
