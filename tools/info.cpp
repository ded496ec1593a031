// onmesh info: what is special or wrong about a mesh, its atlas and its textures.
#include <iostream>

#include "atlas.h"
#include "info_findings.h"
#include "info_output.h"
#include "interruption.h"
#include "messages.h"
#include "shared_options.h"
#include "subcommands.h"

namespace onmesh::tools {

Command info_command() {
  Command command;
  command.name = "info";
  command.synopsis = "MESH [-t TEXTURE | --resolution WxH] [options]";
  command.summary =
      "Examines a mesh, its atlas and its textures: counts, texels, seams, what is wrong and what\n"
      "to do about it, and whether filter will take it. Without -t it looks at every texture that\n"
      "the mesh's materials name.";
  command.examples =
      "  onmesh info cube.obj\n"
      "  onmesh info scan.obj -t scan.png --json\n"
      "  onmesh info scan.obj --resolution 4096x4096 --strict\n";
  command.options.add_options()("mesh", text());
  add_atlas_options(command.options);
  add_weld_option(command.options);
  add_confine_option(command.options);
  auto add = command.options.add_options();
  add("strict", flag(), "exit with 1 if there is anything to repair");
  add("json", flag(), "the findings as JSON on stdout");
  command.positional.add("mesh", 1);
  return command;
}

int run_info(const Arguments& arguments) {
  const std::string path = arguments.argument("mesh");
  wrap_of(arguments);
  if (arguments.has("material") && !has_atlas_option(arguments))
    throw UsageError("--material needs -t or --resolution");
  const InputMesh input = read_input_mesh(path, arguments);
  check_interrupted();
  const Findings findings = examine(input, arguments);
  if (arguments.flag("json")) {
    print_json(input, findings);
  } else {
    warn(input.read.warnings);
    warn(findings.warnings);
    print_text(input, findings);
  }
  if (!arguments.flag("strict") || findings.problems.empty()) return 0;
  std::string list;
  for (const std::string& name : findings.problems) list += (list.empty() ? "" : ", ") + name;
  std::cout.flush();
  std::cerr << "onmesh info: " << path << " is not in order: " << list << '\n';
  return 1;
}

}  // namespace onmesh::tools
