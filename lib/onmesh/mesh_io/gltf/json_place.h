// A value of a JSON document and where it stands, for messages (internal).
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "onmesh/base/types.h"

namespace onmesh {

/// A value in the JSON of a file. Every look-up checks what it finds, and its errors name the file
/// and the place: "a.glb: meshes[0].primitives[1].indices: is missing".
class JsonPlace {
 public:
  /// The whole document.
  /// \pre document and file outlive this and what is looked up through it
  JsonPlace(const nlohmann::json& document, const std::string& file)
      : value_(&document), file_(&file) {}

  const nlohmann::json& value() const { return *value_; }
  /// "meshes[0].primitives[1]"; empty for the document.
  const std::string& path() const { return path_; }
  /// File and path: "a.glb: meshes[0].primitives[1]".
  std::string name() const;

  /// A member of this object.
  /// \throw InputError if this is no object or has no such member
  JsonPlace at(const char* key) const;
  /// The same; nothing if there is none.
  /// \throw InputError if this is no object
  std::optional<JsonPlace> find(const char* key) const;
  /// An element of this array.
  /// \pre i < size()
  JsonPlace at(std::size_t i) const;
  /// Elements of this array.
  /// \throw InputError if this is none
  std::size_t size() const;
  /// Elements of the array in a member; 0 without the member.
  std::size_t size_of(const char* key) const;
  /// The element of a list of the document that a number in this object names: "mesh" in "meshes".
  /// \throw InputError if there is no such number or no such element
  Index index(const char* key, std::size_t count) const;
  /// The same; nothing if there is no such member.
  std::optional<Index> find_index(const char* key, std::size_t count) const;

  /// A whole number from 0 to 2^53.
  /// \throw InputError if this is none
  std::uint64_t whole_number() const;
  /// The whole number in a member, `otherwise` without it.
  std::uint64_t whole_number(const char* key, std::uint64_t otherwise) const;
  /// A finite number.
  /// \throw InputError if this is none
  double number() const;
  /// So many finite numbers.
  /// \throw InputError if this is no array of as many
  std::vector<double> numbers(std::size_t count) const;
  /// \throw InputError if this is no string
  const std::string& text() const;
  /// The text in a member, empty without it.
  std::string text(const char* key) const;
  /// Whether a member is there and true.
  /// \throw InputError if it is no truth value
  bool flag(const char* key) const;

  /// \throw InputError naming file and place
  [[noreturn]] void fail(const std::string& what) const;

 private:
  JsonPlace(const nlohmann::json& value, std::string path, const std::string* file)
      : value_(&value), path_(std::move(path)), file_(file) {}

  const nlohmann::json* value_;
  std::string path_;
  const std::string* file_;
};

}  // namespace onmesh
