#include "command_line.h"

#include <iostream>

#include "onmesh/base/error.h"

namespace onmesh::bench {
namespace {

/// \return false if only help was asked for, which is then printed
bool parse(Program& program, int count, char** arguments) {
  po::options_description all = program.options;
  all.add_options()("help,h", "show this help");
  po::options_description with_files = all;
  with_files.add_options()("file", po::value(&program.files));
  po::positional_options_description positional;
  positional.add("file", -1);
  const int without_guessing =
      po::command_line_style::unix_style & ~po::command_line_style::allow_guessing;
  try {
    po::variables_map values;
    po::store(po::command_line_parser(count, arguments)
                  .options(with_files)
                  .positional(positional)
                  .style(without_guessing)
                  .run(),
              values);
    if (values.count("help") > 0) {
      std::cout << "usage: " << program.name << ' ' << program.arguments << "\n\n"
                << program.summary << "\n\n"
                << all;
      return false;
    }
    po::notify(values);
  } catch (const po::error& error) {
    throw UsageError(error.what());
  }
  return true;
}

}  // namespace

int run_program(Program& program, int count, char** arguments, const std::function<void()>& run) {
  int code = 0;
  const auto report = [&](const std::exception& error, int exit_code) {
    std::cerr << program.name << ": " << error.what() << '\n';
    code = exit_code;
  };
  try {
    if (parse(program, count, arguments)) run();
  } catch (const UsageError& error) {
    report(error, 2);
  } catch (const FileError& error) {
    report(error, 4);
  } catch (const std::exception& error) {
    report(error, 3);
  }
  return code;
}

std::function<void(int)> counts(const std::string& option) {
  return [option](int value) {
    if (value < 1 || value > 100'000)
      throw UsageError(option + ": " + std::to_string(value) + " is not between 1 and 100,000");
  };
}

}  // namespace onmesh::bench
