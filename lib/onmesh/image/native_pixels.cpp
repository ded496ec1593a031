#include "onmesh/image/native_pixels.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

namespace onmesh {
namespace {

/// IEEE half, moved bit by bit so that a NaN keeps its payload.
struct Half {
  std::uint16_t bits;
};

float half_to_float(Half h) {
  const std::uint32_t sign = std::uint32_t(h.bits & 0x8000U) << 16;
  const std::uint32_t exponent = (h.bits >> 10) & 0x1fU;
  const std::uint32_t mantissa = h.bits & 0x3ffU;
  if (exponent == 31) return std::bit_cast<float>(sign | 0x7f800000U | mantissa << 13);
  if (exponent > 0) return std::bit_cast<float>(sign | (exponent + 112) << 23 | mantissa << 13);
  const float subnormal = float(mantissa) * 0x1p-24F;
  return std::bit_cast<float>(sign | std::bit_cast<std::uint32_t>(subnormal));
}

Half float_to_half(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const auto sign = std::uint16_t(bits >> 16 & 0x8000U);
  const std::uint32_t magnitude = bits & 0x7fffffffU;
  if (magnitude > 0x7f800000U) {  // NaN: never let a dropped payload turn it into infinity
    const auto payload = std::uint16_t(magnitude >> 13 & 0x3ffU);
    return {std::uint16_t(sign | 0x7c00U | (payload ? payload : 1U))};
  }
  if (magnitude == 0x7f800000U) return {std::uint16_t(sign | 0x7c00U)};
  const float size = std::bit_cast<float>(magnitude);
  if (size >= 65504) return {std::uint16_t(sign | 0x7bffU)};
  if (size < 0x1p-14F)  // subnormal: a multiple of 2^-24, nearbyint rounds ties to even
    return {std::uint16_t(sign | std::uint16_t(std::nearbyint(size * 0x1p24F)))};
  const std::uint32_t rounded = magnitude + 0xfffU + (magnitude >> 13 & 1U);
  return {std::uint16_t(sign | std::uint16_t((rounded >> 13) - (112U << 10)))};
}

template <class T>
float value_of(T native) {
  if constexpr (std::is_same_v<T, Half>) {
    return half_to_float(native);
  } else if constexpr (std::is_floating_point_v<T>) {
    return float(native);
  } else if constexpr (sizeof(T) <= 2) {
    return float(native) / float(std::numeric_limits<T>::max());
  } else {
    return float(double(native) / double(std::numeric_limits<T>::max()));
  }
}

template <class T>
T native_of(float value) {
  if constexpr (std::is_same_v<T, Half>) {
    return float_to_half(value);
  } else if constexpr (std::is_floating_point_v<T>) {
    return T(value);
  } else {
    using Limits = std::numeric_limits<T>;
    if (std::isnan(value)) return T(0);
    const double scaled = std::nearbyint(double(value) * double(Limits::max()));
    if (scaled >= double(Limits::max())) return Limits::max();
    if (scaled <= double(Limits::min())) return Limits::min();
    return T(scaled);
  }
}

template <class T>
struct Tag {
  using type = T;
};

template <class Function>
void with_type(SampleType type, Function&& function) {
  switch (type) {
    case OIIO::TypeDesc::UINT8:
      return function(Tag<std::uint8_t>());
    case OIIO::TypeDesc::INT8:
      return function(Tag<std::int8_t>());
    case OIIO::TypeDesc::UINT16:
      return function(Tag<std::uint16_t>());
    case OIIO::TypeDesc::INT16:
      return function(Tag<std::int16_t>());
    case OIIO::TypeDesc::UINT32:
      return function(Tag<std::uint32_t>());
    case OIIO::TypeDesc::INT32:
      return function(Tag<std::int32_t>());
    case OIIO::TypeDesc::UINT64:
      return function(Tag<std::uint64_t>());
    case OIIO::TypeDesc::INT64:
      return function(Tag<std::int64_t>());
    case OIIO::TypeDesc::HALF:
      return function(Tag<Half>());
    case OIIO::TypeDesc::DOUBLE:
      return function(Tag<double>());
    default:
      return function(Tag<float>());
  }
}

/// Call function(type, first channel, byte offset, values in a run, runs): one run over everything
/// when all channels have one type, else one strided pass per channel.
template <class Function>
void for_each_pass(const std::vector<SampleType>& types, std::size_t pixels, Function&& function) {
  const bool uniform =
      std::all_of(types.begin(), types.end(), [&](SampleType t) { return t == types[0]; });
  if (uniform) return function(types[0], std::size_t(0), std::size_t(0), pixels * types.size(), 1);
  std::size_t offset = 0;
  for (std::size_t c = 0; c < types.size(); ++c) {
    function(types[c], c, offset, std::size_t(1), pixels);
    offset += OIIO::TypeDesc(types[c]).size();
  }
}

}  // namespace

bool survives_float(SampleType type) {
  switch (type) {
    case OIIO::TypeDesc::UINT8:
    case OIIO::TypeDesc::INT8:
    case OIIO::TypeDesc::UINT16:
    case OIIO::TypeDesc::INT16:
    case OIIO::TypeDesc::HALF:
    case OIIO::TypeDesc::FLOAT:
      return true;
    default:
      return false;
  }
}

std::size_t pixel_bytes(const std::vector<SampleType>& types) {
  std::size_t bytes = 0;
  for (const SampleType type : types) bytes += OIIO::TypeDesc(type).size();
  return bytes;
}

void to_float(const std::byte* native, const std::vector<SampleType>& types, std::size_t pixels,
              float* values) {
  const std::size_t stride = pixel_bytes(types);
  for_each_pass(types, pixels,
                [&](SampleType type, std::size_t channel, std::size_t offset, std::size_t run,
                    std::size_t runs) {
                  with_type(type, [&]<class T>(Tag<T>) {
                    for (std::size_t r = 0; r < runs; ++r) {
                      const std::byte* in = native + r * stride + offset;
                      float* out = values + r * types.size() + channel;
                      if constexpr (std::is_same_v<T, float>) {
                        std::memcpy(out, in, run * sizeof(float));
                      } else {
                        for (std::size_t i = 0; i < run; ++i) {
                          T value;
                          std::memcpy(&value, in + i * sizeof(T), sizeof(T));
                          out[i] = value_of(value);
                        }
                      }
                    }
                  });
                });
}

void from_float(const float* values, const std::vector<SampleType>& types, std::size_t pixels,
                std::byte* native) {
  const std::size_t stride = pixel_bytes(types);
  for_each_pass(types, pixels,
                [&](SampleType type, std::size_t channel, std::size_t offset, std::size_t run,
                    std::size_t runs) {
                  with_type(type, [&]<class T>(Tag<T>) {
                    for (std::size_t r = 0; r < runs; ++r) {
                      const float* in = values + r * types.size() + channel;
                      std::byte* out = native + r * stride + offset;
                      if constexpr (std::is_same_v<T, float>) {
                        std::memcpy(out, in, run * sizeof(float));
                      } else {
                        for (std::size_t i = 0; i < run; ++i) {
                          const T value = native_of<T>(in[i]);
                          std::memcpy(out + i * sizeof(T), &value, sizeof(T));
                        }
                      }
                    }
                  });
                });
}

}  // namespace onmesh
