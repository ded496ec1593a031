// Test textures: patterns with noise, in the image plane or on a surface.
#pragma once

#include <cstdint>

#include "onmesh/image/image.h"
#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// What a texture shows.
enum class Pattern { checker, stripes, noise, gradient, dots };

/// A textured test image: the pattern, its cells an eighth of the longer side, with uniform noise
/// from [-noise, noise] added to every value, clamped to [0,1]. Channel c has the colour of channel
/// c mod 3. Equal arguments give equal bytes on every machine.
/// \param width,height in texels, [1, 32768]
/// \throw UsageError unless the sizes and channels are in range and noise is in [0, 1]
Image make_texture(int width, int height, Pattern pattern, double noise, std::uint64_t seed,
                   int channels = 3);

/// How make_surface_texture() paints.
struct SurfaceTextureOptions {
  Pattern pattern = Pattern::checker;  ///< what is painted
  double cell = 0;   ///< size of the pattern's cells, mesh units; 0 = an eighth of the longest side
  double noise = 0;  ///< amplitude of the uniform noise per texel, [0, 1]
  std::uint64_t seed = 1;  ///< of the noise and of random patterns
  int padding = 4;         ///< texels around charts that continue the pattern, >= 0
};

/// The pattern as a solid texture carved by the surface: it runs on across seams, whatever the
/// atlas. Texels that no chart is near are grey. UVs outside [0,1] repeat. 3 channels.
/// \param width,height in texels, [1, 32768]
/// \throw UsageError for options or sizes outside their domain, or an empty mesh
Image make_surface_texture(const TriangleMesh& mesh, int width, int height,
                           const SurfaceTextureOptions& options);

}  // namespace onmesh
