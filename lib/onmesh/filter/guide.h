// What range weights compare in place of the values that are filtered.
#pragma once

#include <optional>
#include <string>

#include "onmesh/filter/length.h"
#include "onmesh/filter/range_width.h"
#include "onmesh/filter/surface_textures.h"
#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// One of several: the weight of a sample y at a target x has a factor
/// exp(-|g(x) - g(y)|^2 / (2 width^2)) for each (joint bilateral filter: Petschnigg et al., Digital
/// photography with flash and no-flash image pairs, 2004).
struct Guide {
  /// Where its features come from.
  enum class Kind {
    own,               ///< the values that are filtered, or those of one map among them
    surface_normal,    ///< unit shading normals: their difference is a chord
    surface_position,  ///< points of the surface: their difference is a length
    images,            ///< other textures on the same surface
  };
  /// What codes of images mean.
  enum class Meaning {
    values,         ///< colours or data, compared in FilterOptions::range_space
    normal_gl,      ///< tangent space normals with green upwards, as OpenGL has them
    normal_dx,      ///< the same with green downwards, as DirectX has them
    object_normal,  ///< normals of the object's space
  };

  Kind kind = Kind::own;       ///< where its features come from
  std::string name = "self";   ///< what messages call it
  RangeWidth width;            ///< not of surface_position
  Length length;               ///< of surface_position only
  std::optional<Length> blur;  ///< standard deviation of a Gaussian on the surface, cut at 3 of it
  std::optional<Length> median;  ///< instead: median of each channel within that distance
  /// It is one of these.
  bool is_smoothed() const { return blur || median; }

  int map = -1;  ///< own: which of SurfaceTextures::maps; -1 = all values

  SurfaceTextures textures = {};  ///< images only
  /// Images only: the same surface with the UVs that those are laid out by; null: those of the
  /// textures that are filtered. Outlives the guide.
  const TriangleMesh* mesh = nullptr;
  Meaning meaning = Meaning::values;  ///< images only
};

struct FilterOptions;  // options.h

/// The same with as little as gives the same result: a guide that is nothing but the texture itself
/// is that, and where own values are all that is compared there is no guide.
FilterOptions settle_guides(const SurfaceTextures& textures, FilterOptions options);

}  // namespace onmesh
