#include "onmesh/mesh_io/gltf/json_place.h"

#include <cmath>

#include "onmesh/base/error.h"
#include "onmesh/base/text.h"

namespace onmesh {

std::optional<JsonPlace> JsonPlace::find(const char* key) const {
  if (!value_->is_object()) fail("is no object");
  const auto found = value_->find(key);
  if (found == value_->end()) return std::nullopt;
  return JsonPlace(*found, (path_.empty() ? "" : path_ + ".") + key, file_);
}

JsonPlace JsonPlace::at(const char* key) const {
  if (std::optional<JsonPlace> found = find(key)) return *std::move(found);
  JsonPlace(*value_, (path_.empty() ? "" : path_ + ".") + key, file_).fail("is missing");
}

JsonPlace JsonPlace::at(std::size_t i) const {
  return {(*value_)[i], path_ + "[" + std::to_string(i) + "]", file_};
}

std::size_t JsonPlace::size() const {
  if (!value_->is_array()) fail("is no array");
  return value_->size();
}

std::size_t JsonPlace::size_of(const char* key) const {
  const std::optional<JsonPlace> list = find(key);
  return list ? list->size() : 0;
}

Index JsonPlace::index(const char* key, std::size_t count) const {
  const JsonPlace place = at(key);
  const std::uint64_t number = place.whole_number();
  if (number >= count || number >= kNone) {
    place.fail("index " + std::to_string(number) + " is out of range (there are " +
               std::to_string(count) + ")");
  }
  return Index(number);
}

std::optional<Index> JsonPlace::find_index(const char* key, std::size_t count) const {
  if (!find(key)) return std::nullopt;
  return index(key, count);
}

std::uint64_t JsonPlace::whole_number() const {
  constexpr double kMost = 9007199254740992.0;  // 2^53: more cannot be told from its neighbours
  const double number = value_->is_number() ? value_->get<double>() : -1;
  if (!(number >= 0 && number <= kMost) || number != std::floor(number))
    fail("is no whole number from 0 on");
  return std::uint64_t(number);
}

std::uint64_t JsonPlace::whole_number(const char* key, std::uint64_t otherwise) const {
  const std::optional<JsonPlace> place = find(key);
  return place ? place->whole_number() : otherwise;
}

double JsonPlace::number() const {
  const double number = value_->is_number() ? value_->get<double>() : std::nan("");
  if (!std::isfinite(number)) fail("is no number");
  return number;
}

std::vector<double> JsonPlace::numbers(std::size_t count) const {
  if (size() != count) fail("should have " + std::to_string(count) + " numbers");
  std::vector<double> numbers;
  for (std::size_t i = 0; i < count; ++i) numbers.push_back(at(i).number());
  return numbers;
}

const std::string& JsonPlace::text() const {
  if (!value_->is_string()) fail("is no text");
  return value_->get_ref<const std::string&>();
}

std::string JsonPlace::text(const char* key) const {
  const std::optional<JsonPlace> place = find(key);
  return place ? place->text() : std::string();
}

bool JsonPlace::flag(const char* key) const {
  const std::optional<JsonPlace> place = find(key);
  if (!place) return false;
  if (!place->value_->is_boolean()) place->fail("is neither true nor false");
  return place->value_->get<bool>();
}

std::string JsonPlace::name() const {
  return *file_ + ": " + (path_.empty() ? "JSON" : one_line_text(path_));
}

void JsonPlace::fail(const std::string& what) const {
  throw InputError(name() + ": " + one_line_text(what));
}

}  // namespace onmesh
