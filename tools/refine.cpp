#include "command.h"

namespace onmesh::tools {

int run_refine(const std::vector<std::string>& arguments) {
  Command command;
  command.name = "refine";
  command.synopsis = "MESH";
  command.summary = "intrinsic triangulation";
  po::variables_map values;
  if (!parse(command, arguments, values)) return 0;
  return 0;
}

}  // namespace onmesh::tools
