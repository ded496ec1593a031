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

/// Call function(Tag<T>()) with the C++ type of the values.
template <class Function>
void with_type(SampleType type, Function&& function) {
  using OIIO::TypeDesc;
  if (type == TypeDesc::UINT8) return function(Tag<std::uint8_t>());
  if (type == TypeDesc::INT8) return function(Tag<std::int8_t>());
  if (type == TypeDesc::UINT16) return function(Tag<std::uint16_t>());
  if (type == TypeDesc::INT16) return function(Tag<std::int16_t>());
  if (type == TypeDesc::UINT32) return function(Tag<std::uint32_t>());
  if (type == TypeDesc::INT32) return function(Tag<std::int32_t>());
  if (type == TypeDesc::UINT64) return function(Tag<std::uint64_t>());
  if (type == TypeDesc::INT64) return function(Tag<std::int64_t>());
  if (type == TypeDesc::HALF) return function(Tag<Half>());
  if (type == TypeDesc::DOUBLE) return function(Tag<double>());
  return function(Tag<float>());
}

/// Call convert(Tag<T>(), native, values, count) for runs of values of one type: one run over
/// everything when all channels have one type, else every value by itself, channel by channel.
template <class Byte, class Value, class Convert>
void convert_runs(Byte* native, const std::vector<SampleType>& types, std::size_t pixels,
                  Value* values, Convert&& convert) {
  const std::size_t stride = pixel_bytes(types), channels = types.size();
  const auto pass = [&](SampleType type, std::size_t channel, std::size_t offset, std::size_t run,
                        std::size_t runs) {
    with_type(type, [&](auto tag) {
      for (std::size_t r = 0; r < runs; ++r)
        convert(tag, native + r * stride + offset, values + r * channels + channel, run);
    });
  };
  const bool uniform =
      std::all_of(types.begin(), types.end(), [&](SampleType t) { return t == types[0]; });
  if (uniform) return pass(types[0], 0, 0, pixels * channels, 1);
  std::size_t offset = 0;
  for (std::size_t c = 0; c < channels; ++c) {
    pass(types[c], c, offset, 1, pixels);
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
  convert_runs(native, types, pixels, values,
               []<class T>(Tag<T>, const std::byte* in, float* out, std::size_t count) {
                 if constexpr (std::is_same_v<T, float>) {
                   std::memcpy(out, in, count * sizeof(float));
                 } else {
                   for (std::size_t i = 0; i < count; ++i) {
                     T value;
                     std::memcpy(&value, in + i * sizeof(T), sizeof(T));
                     out[i] = value_of(value);
                   }
                 }
               });
}

void from_float(const float* values, const std::vector<SampleType>& types, std::size_t pixels,
                std::byte* native) {
  convert_runs(native, types, pixels, values,
               []<class T>(Tag<T>, std::byte* out, const float* in, std::size_t count) {
                 if constexpr (std::is_same_v<T, float>) {
                   std::memcpy(out, in, count * sizeof(float));
                 } else {
                   for (std::size_t i = 0; i < count; ++i) {
                     const T value = native_of<T>(in[i]);
                     std::memcpy(out + i * sizeof(T), &value, sizeof(T));
                   }
                 }
               });
}

}  // namespace onmesh
