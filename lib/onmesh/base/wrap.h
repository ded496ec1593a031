// How coordinates beyond a period are read.
#pragma once

namespace onmesh {

/// How UVs outside [0,1] are read.
enum class Wrap {
  repeat,  ///< the texture repeats in every tile
  clamp,   ///< the texture's border goes on
  mirror,  ///< the texture repeats, every other time turned over
};

/// The same for both directions.
struct WrapModes {
  Wrap u = Wrap::repeat;  ///< columns
  Wrap v = Wrap::repeat;  ///< rows

  bool operator==(const WrapModes&) const = default;
};

}  // namespace onmesh
