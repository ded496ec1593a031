#include "command.h"

namespace onmesh::tools {

int run_info(const std::vector<std::string>& arguments) {
  Command command;
  command.name = "info";
  command.synopsis = "MESH";
  command.summary = "report on mesh and atlas";
  po::variables_map values;
  if (!parse(command, arguments, values)) return 0;
  return 0;
}

}  // namespace onmesh::tools
