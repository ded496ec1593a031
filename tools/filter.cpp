#include "command.h"

namespace onmesh::tools {

int run_filter(const std::vector<std::string>& arguments) {
  Command command;
  command.name = "filter";
  command.synopsis = "MESH";
  command.summary = "filter a texture on the surface";
  po::variables_map values;
  if (!parse(command, arguments, values)) return 0;
  return 0;
}

}  // namespace onmesh::tools
