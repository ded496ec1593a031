// What the tests of several subcommands check alike.
#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "onmesh/image/image.h"
#include "support/run_program.h"

namespace onmesh {

/// Failed runs say why in one line on stderr and nothing on stdout, and leave no file behind.
inline void check_refused(const Workspace& space, const std::string& arguments, int code,
                          const std::string& reason) {
  INFO("onmesh " << arguments);
  const auto before = space.files();
  const Run run = space.run(arguments);
  INFO(run.err);
  CHECK(run.code == code);
  CHECK(run.out.empty());
  CHECK(std::count(run.err.begin(), run.err.end(), '\n') == 1);
  CHECK_THAT(run.err, Catch::Contains(reason));
  CHECK(run.err.rfind("onmesh", 0) == 0);
  CHECK(space.files() == before);
}

inline std::vector<std::string> keys(const nlohmann::json& json) {
  std::vector<std::string> names;
  for (const auto& [name, value] : json.items()) names.push_back(name);
  return names;
}

/// The number of a named channel.
inline int channel(const Image& image, const std::string& name) {
  const auto& names = image.channel_names;
  const auto at = std::find(names.begin(), names.end(), name);
  REQUIRE(at != names.end());
  return int(at - names.begin());
}

}  // namespace onmesh
