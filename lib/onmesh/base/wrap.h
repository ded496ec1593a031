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

  constexpr WrapModes() = default;
  /// One mode for both; implicit, so that a Wrap says it.
  constexpr WrapModes(Wrap both) : u(both), v(both) {}
  /// One mode each.
  constexpr WrapModes(Wrap columns, Wrap rows) : u(columns), v(rows) {}

  /// Both directions are read alike.
  bool operator==(const WrapModes&) const = default;
};

/// The whole periods of n that lie before column or row i: negative to the left of the first.
template <class Integer>
constexpr Integer periods_before(Integer i, Integer n) {
  return i >= 0 ? i / n : -((n - 1 - i) / n);
}

/// The column or row of an image with n of them that is seen at i, which may lie outside.
template <class Integer>
constexpr Integer wrapped_index(Wrap wrap, Integer i, Integer n) {
  if (i >= 0 && i < n) return i;
  if (wrap == Wrap::clamp) return i < 0 ? 0 : n - 1;
  const Integer period = periods_before(i, n), rest = i - period * n;
  return wrap == Wrap::mirror && period % 2 != 0 ? n - 1 - rest : rest;
}

}  // namespace onmesh
