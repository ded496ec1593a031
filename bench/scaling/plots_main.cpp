// onmesh_bench_plots: the measurements of onmesh_bench as tables and plots.
#include <iostream>
#include <string>
#include <vector>

#include "onmesh/base/error.h"
#include "onmesh/base/file_io.h"
#include "scaling/output.h"

namespace onmesh::bench {
namespace {

const char* const kUsage =
    "usage: onmesh_bench_plots RESULTS.json... [options]\n"
    "\n"
    "Turns what onmesh_bench --benchmark_out=RESULTS.json wrote into tables and plots.\n"
    "\n"
    "  --markdown FILE   write all tables\n"
    "  --plots FOLDER    write scaling-*.svg: time by texels, sigma, threads and faces\n"
    "  --readme FILE     replace what is between '<!-- scaling: begin -->' and\n"
    "                    '<!-- scaling: end -->' there by the tables of times and memory, and "
    "links to the\n"
    "                    plots if there are any\n";

struct Options {
  std::vector<std::string> results;
  std::string markdown, plots, readme;
  bool help = false;
};

Options parse(const std::vector<std::string>& arguments) {
  Options options;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& name = arguments[i];
    const auto value = [&]() -> const std::string& {
      if (i + 1 == arguments.size()) throw UsageError(name + ": needs a value");
      return arguments[++i];
    };
    if (name == "--help" || name == "-h") {
      options.help = true;
    } else if (name == "--markdown") {
      options.markdown = value();
    } else if (name == "--plots") {
      options.plots = value();
    } else if (name == "--readme") {
      options.readme = value();
    } else if (name.starts_with("-")) {
      throw UsageError("unknown option '" + name + "'");
    } else {
      options.results.push_back(name);
    }
  }
  if (options.results.empty() && !options.help) throw UsageError("no results given");
  return options;
}

int run(const std::vector<std::string>& arguments) {
  const Options options = parse(arguments);
  if (options.help) {
    std::cout << kUsage;
    return 0;
  }
  Results results;
  for (const std::string& path : options.results) read_results(path, results);
  const std::string tables = summary(results);
  if (!options.markdown.empty()) write_file(options.markdown, tables + '\n' + details(results));
  if (!options.plots.empty()) write_plots(options.plots, results);
  if (!options.readme.empty()) {
    const std::string links = options.plots.empty() ? "" : plot_links(options.plots, results);
    write_file(options.readme, with_summary(read_file(options.readme), tables + links));
  }
  if (options.markdown.empty() && options.readme.empty()) std::cout << tables;
  return 0;
}

}  // namespace
}  // namespace onmesh::bench

int main(int count, char** arguments) {
  try {
    return onmesh::bench::run({arguments + 1, arguments + count});
  } catch (const onmesh::UsageError& error) {
    std::cerr << "onmesh_bench_plots: " << error.what() << '\n';
    return 2;
  } catch (const onmesh::FileError& error) {
    std::cerr << "onmesh_bench_plots: " << error.what() << '\n';
    return 4;
  } catch (const std::exception& error) {
    std::cerr << "onmesh_bench_plots: " << error.what() << '\n';
    return 3;
  }
}
