#include "command.h"

namespace onmesh::tools {

int run_distance(const std::vector<std::string>& arguments) {
  Command command;
  command.name = "distance";
  command.synopsis = "MESH";
  command.summary = "geodesic distances from a point";
  po::variables_map values;
  if (!parse(command, arguments, values)) return 0;
  return 0;
}

}  // namespace onmesh::tools
