#include "command.h"

namespace onmesh::tools {

int run_compare(const std::vector<std::string>& arguments) {
  Command command;
  command.name = "compare";
  command.synopsis = "MESH";
  command.summary = "measure how two textures differ";
  po::variables_map values;
  if (!parse(command, arguments, values)) return 0;
  return 0;
}

}  // namespace onmesh::tools
