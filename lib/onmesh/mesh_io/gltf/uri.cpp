#include "onmesh/mesh_io/gltf/uri.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "onmesh/base/text.h"

namespace onmesh {
namespace {

constexpr std::string_view kDigits =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr std::uint8_t kNoDigit = 64;

/// The value of each character as a digit.
constexpr std::array<std::uint8_t, 256> digit_values() {
  std::array<std::uint8_t, 256> values{};
  values.fill(kNoDigit);
  for (std::size_t i = 0; i < kDigits.size(); ++i)
    values[static_cast<unsigned char>(kDigits[i])] = std::uint8_t(i);
  return values;
}

int hex_value(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

constexpr std::string_view kBase64 = ";base64";

/// What stands before the comma of a data URI.
bool is_base64(std::string_view kind) {
  return kind.size() >= kBase64.size() &&
         lower_case(kind.substr(kind.size() - kBase64.size())) == kBase64;
}

}  // namespace

// Schemes are written in any case of letters (RFC 3986, section 3.1).
bool is_data_uri(std::string_view uri) { return lower_case(uri.substr(0, 5)) == "data:"; }

std::string to_base64(std::string_view bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t left = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (k < left ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += k <= left ? kDigits[group >> (18 - 6 * k) & 63U] : '=';
  }
  return text;
}

std::optional<std::string> from_base64(std::string_view text) {
  static constexpr std::array<std::uint8_t, 256> kValues = digit_values();
  for (int i = 0; i < 2 && text.ends_with('='); ++i) text.remove_suffix(1);
  if (text.size() % 4 == 1) return std::nullopt;
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t group = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::uint8_t value = kValues[static_cast<unsigned char>(text[i])];
    if (value == kNoDigit) return std::nullopt;
    group = group << 6 | value;
    if (i % 4 != 3) continue;
    bytes += char(group >> 16 & 255U);
    bytes += char(group >> 8 & 255U);
    bytes += char(group & 255U);
  }
  if (text.size() % 4 == 2) bytes += char(group >> 4 & 255U);
  if (text.size() % 4 == 3) {
    bytes += char(group >> 10 & 255U);
    bytes += char(group >> 2 & 255U);
  }
  return bytes;
}

std::string percent_decoded(std::string_view text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool is_code = text[i] == '%' && i + 2 < text.size() && hex_value(text[i + 1]) >= 0 &&
                         hex_value(text[i + 2]) >= 0;
    decoded += is_code ? char(16 * hex_value(text[i + 1]) + hex_value(text[i + 2])) : text[i];
    if (is_code) i += 2;
  }
  return decoded;
}

std::string percent_encoded(std::string_view path) {
  constexpr std::string_view kHexDigits = "0123456789ABCDEF";
  std::string encoded;
  for (const char c : path) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') ||
                          (c >= 'a' && c <= 'z') ||
                          std::string_view("-._~/").find(c) != std::string_view::npos;
    if (is_plain) {
      encoded += c;
    } else {
      encoded += '%';
      encoded += kHexDigits[byte >> 4U];
      encoded += kHexDigits[byte & 15U];
    }
  }
  return encoded;
}

std::optional<std::string> data_of_uri(std::string_view uri) {
  const std::size_t comma = uri.find(',');
  if (!is_data_uri(uri) || comma == std::string_view::npos) return std::nullopt;
  const std::string data = percent_decoded(uri.substr(comma + 1));
  return is_base64(uri.substr(0, comma)) ? from_base64(data) : data;
}

std::string with_data(std::string_view uri, std::string_view bytes) {
  std::string_view kind = uri.substr(0, uri.find(','));
  if (is_base64(kind)) kind.remove_suffix(kBase64.size());
  return std::string(kind) + ";base64," + to_base64(bytes);
}

}  // namespace onmesh
