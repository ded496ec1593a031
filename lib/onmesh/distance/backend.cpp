#include "onmesh/distance/backend.h"

#include <array>
#include <string>
#include <utility>

#include "onmesh/base/error.h"

namespace onmesh {
namespace {

constexpr std::array<std::pair<DistanceMethod, std::string_view>, 5> kNames{{
    {DistanceMethod::automatic, "auto"},
    {DistanceMethod::unfold, "unfold"},
    {DistanceMethod::heat, "heat"},
    {DistanceMethod::cloud, "cloud"},
    {DistanceMethod::exact, "exact"},
}};

}  // namespace

std::string_view name_of(DistanceMethod method) {
  for (const auto& [value, name] : kNames)
    if (value == method) return name;
  return "?";
}

DistanceMethod distance_method(std::string_view name) {
  std::string known;
  for (const auto& [value, text] : kNames) {
    if (text == name) return value;
    known += (known.empty() ? "" : ", ") + std::string(text);
  }
  throw UsageError("unknown distance method '" + std::string(name) + "' (one of " + known + ")");
}

}  // namespace onmesh
