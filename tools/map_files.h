// -t by maps.
#pragma once

#include <string>
#include <vector>

namespace onmesh::tools {

/// What -t says of one map.
struct MapFiles {
  std::string name;                ///< empty if there is only one
  std::vector<std::string> files;  ///< without the map's name, with their roles
};

/// The values of -t, [MAP=]FILE[@ROLE], by maps in the order in which these are named first.
/// \throw UsageError if of several maps one has no name, or has one that guides have
std::vector<MapFiles> maps_of_files(const std::vector<std::string>& files);

}  // namespace onmesh::tools
