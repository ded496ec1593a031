#include "onmesh/base/simd_level.h"

#include <cstdint>

#include "onmesh/base/error.h"
#include "onmesh/base/simd_targets.h"

// Highway's headers after what they depend on.
#include <hwy/highway.h>

namespace onmesh {
namespace {

/// A bit per instruction set, lower ones for better ones.
void use(std::int64_t levels) {
  hwy::SetSupportedTargetsForTest(levels);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

/// Those there are, whatever the limit is.
std::int64_t all_levels() {
  const std::int64_t limited = hwy::SupportedTargets();
  hwy::SetSupportedTargetsForTest(0);
  const std::int64_t all = hwy::SupportedTargets();
  use(limited == all ? 0 : limited);
  return all & HWY_TARGETS;
}

}  // namespace

std::vector<std::string> simd_levels() {
  std::vector<std::string> names;
  for (std::int64_t rest = all_levels(); rest != 0; rest &= rest - 1) {
    names.emplace_back(hwy::TargetName(rest & -rest));
  }
  return names;
}

void limit_simd(const std::string& level) {
  const std::int64_t all = all_levels();
  if (level.empty()) return use(0);
  std::string known;
  for (std::int64_t rest = all; rest != 0; rest &= rest - 1) {
    const std::int64_t bit = rest & -rest;
    if (level == hwy::TargetName(bit)) return use(rest);
    known += (known.empty() ? "" : ", ") + std::string(hwy::TargetName(bit));
  }
  throw UsageError("instruction set '" + level + "': there are " + known);
}

}  // namespace onmesh
