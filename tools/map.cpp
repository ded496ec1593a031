#include "command.h"

namespace onmesh::tools {

int run_map(const std::vector<std::string>& arguments) {
  Command command;
  command.name = "map";
  command.synopsis = "MESH";
  command.summary = "texel map";
  po::variables_map values;
  if (!parse(command, arguments, values)) return 0;
  return 0;
}

}  // namespace onmesh::tools
