// Progress of long work, reported to whoever asked for it.
#pragma once

#include <functional>
#include <string_view>

namespace onmesh {

/// Called now and then with the stage's name and the share of it that is done (0 to 1). May be
/// called from any thread, never from two at once. May throw to cancel the work.
using Progress = std::function<void(std::string_view stage, double done)>;

}  // namespace onmesh
