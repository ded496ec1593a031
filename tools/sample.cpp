#include "command.h"

namespace onmesh::tools {

int run_sample(const std::vector<std::string>& arguments) {
  Command command;
  command.name = "sample";
  command.synopsis = "MESH";
  command.summary = "Poisson-disk samples";
  po::variables_map values;
  if (!parse(command, arguments, values)) return 0;
  return 0;
}

}  // namespace onmesh::tools
