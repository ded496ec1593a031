// Bytes as text and back (internal).
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace onmesh {

/// Base 64 with padding (RFC 4648, section 4).
std::string to_base64(std::string_view bytes);

/// The bytes; padding may be missing. Nothing if the text is no base 64.
std::optional<std::string> from_base64(std::string_view text);

/// The text with each %41 replaced by the byte it stands for (RFC 3986, section 2.1); a percent
/// sign that two hexadecimal digits do not follow stays.
std::string percent_decoded(std::string_view text);

/// A path as a URI: what is neither a letter, a digit nor one of -._~/ becomes %41.
std::string percent_encoded(std::string_view path);

/// Whether the URI holds its data (RFC 2397).
bool is_data_uri(std::string_view uri);

/// The data of such a URI; nothing if it is damaged.
std::optional<std::string> data_of_uri(std::string_view uri);

/// The URI with other data of the same kind.
std::string with_data(std::string_view uri, std::string_view bytes);

}  // namespace onmesh
