// Changes to the text of a JSON document (internal).
#pragma once

#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace onmesh {

/// Changes members of objects. All else stays as it is, byte for byte: numbers keep their digits,
/// members their order, lines their indentation. Time goes with the length of what is looked
/// through: the document once per list, an object for each of its members that changes. Of members
/// of one name the last one counts.
class JsonText {
 public:
  /// Where an object begins in the text.
  using Object = std::size_t;

  /// \param text JSON without errors, an object; outlives this
  explicit JsonText(std::string_view text) : text_(text) {}

  /// An element of a list of the document.
  /// \pre there is one, and it is an object
  Object element(const std::string& list, std::size_t i);
  /// An object in a member of another.
  /// \pre there is one
  Object object(Object in, std::string_view key) const;

  /// Give a member another value, or add one.
  /// \pre the object has a member
  void set(Object object, std::string_view key, const nlohmann::json& value);

  /// The text with all changes.
  std::string edited() const;

 private:
  struct Edit {
    std::size_t end = 0;  ///< of what is replaced
    std::string text;     ///< what comes there instead
  };

  std::string_view text_;
  std::map<std::string, std::vector<Object>> lists_;  ///< those that were asked for
  std::map<std::size_t, Edit> edits_;                 ///< by where they begin
};

}  // namespace onmesh
