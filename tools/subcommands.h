// The subcommands: two functions each, in the file of its name.
#pragma once

#include <span>

#include "arguments.h"
#include "command.h"

namespace onmesh::tools {

struct Subcommand {
  const char* name;
  const char* summary;  ///< its line in onmesh --help
  /// Options and help text.
  Command (*describe)();
  /// Does the work. Errors are thrown.
  /// \return the exit code: 0, or 1 when a check that was asked for failed
  int (*run)(const Arguments& arguments);
};

/// All of them, in the order of onmesh --help.
std::span<const Subcommand> subcommands();

Command compare_command();
int run_compare(const Arguments& arguments);
Command distance_command();
int run_distance(const Arguments& arguments);
Command fill_command();
int run_fill(const Arguments& arguments);
Command filter_command();
int run_filter(const Arguments& arguments);
Command info_command();
int run_info(const Arguments& arguments);
Command make_mesh_command();
int run_make_mesh(const Arguments& arguments);
Command map_command();
int run_map(const Arguments& arguments);
Command refine_command();
int run_refine(const Arguments& arguments);
Command sample_command();
int run_sample(const Arguments& arguments);
Command view_command();
int run_view(const Arguments& arguments);

}  // namespace onmesh::tools
