// The unit of exponents that vectors raise to the power of two (exp2-inl.h).
#pragma once

namespace onmesh {

/// Exponents are often scaled by this: then they count in the last place of a float's bits.
constexpr float kExponentUnit = 0x1p23F;

}  // namespace onmesh
