// onmesh_bench_tables: the measurements of onmesh_bench as tables, and as numbers for plots.
#include <iostream>
#include <string>

#include "command_line.h"
#include "onmesh/base/error.h"
#include "onmesh/base/file_io.h"
#include "scaling/output.h"

namespace onmesh::bench {
namespace {

struct Outputs {
  std::string markdown, readme, csv;  ///< files; empty = not wanted
};

void write_outputs(const std::vector<std::string>& paths, const Outputs& outputs) {
  if (paths.empty()) throw UsageError("no results given");
  Results results;
  for (const std::string& path : paths) read_results(path, results);
  const std::string tables = summary(results);
  if (!outputs.markdown.empty()) write_file(outputs.markdown, tables + '\n' + details(results));
  if (!outputs.readme.empty())
    write_file(outputs.readme, with_summary(read_file(outputs.readme), tables));
  if (!outputs.csv.empty()) write_file(outputs.csv, csv(results));
  if (outputs.markdown.empty() && outputs.readme.empty()) std::cout << tables;
}

}  // namespace
}  // namespace onmesh::bench

int main(int count, char** arguments) {
  using namespace onmesh::bench;
  Outputs outputs;
  Program program;
  program.name = "onmesh_bench_tables";
  program.arguments = "RESULTS.json... [options]";
  program.summary = "Turns what onmesh_bench --benchmark_out=RESULTS.json wrote into tables.";
  const auto file = [](std::string& path) { return po::value(&path)->value_name("FILE"); };
  auto add = program.options.add_options();
  add("markdown", file(outputs.markdown), "all tables");
  add("readme", file(outputs.readme),
      "replace what is between '<!-- scaling: begin -->' and '<!-- scaling: end -->' there by the "
      "tables of times and memory");
  add("csv", file(outputs.csv), "the times, for 'bench/make_plots scaling'");
  return run_program(program, count, arguments, [&] { write_outputs(program.files, outputs); });
}
