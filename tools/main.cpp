// The onmesh program: picks the subcommand and turns errors into messages and exit codes.
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <new>
#include <stdexcept>

#include "command.h"
#include "flags.h"
#include "interruption.h"
#include "library_start.h"
#include "onmesh/base/error.h"
#include "onmesh/base/process_memory.h"
#include "onmesh/base/simd_level.h"
#include "onmesh/version.h"
#include "subcommands.h"

namespace {

using namespace onmesh::tools;

enum ExitCode { kUsage = 2, kInput = 3, kFile = 4, kSignal = 128 };

void print_help(std::ostream& out) {
  out << "usage: onmesh COMMAND [arguments]\n\n"
         "Filters textures on the surface of triangle meshes.\n\n"
         "Commands:\n";
  for (const Subcommand& command : subcommands()) {
    out << "  " << command.name << std::string(12 - std::string(command.name).size(), ' ')
        << command.summary << '\n';
  }
  out << "\n"
         "  onmesh COMMAND --help   what a command takes, with examples\n"
         "  onmesh --version        the program's version\n\n"
         "The environment variable ONMESH_SIMD names the best instruction set to use, such as "
         "AVX2.\n\n"
         "Exit codes: 0 done, 1 a check that was asked for failed, 2 wrong usage, 3 wrong input,\n"
         "4 a file cannot be read or written, 128 + N ended by signal N (130 interrupted, 143 "
         "terminated).\n";
}

const Subcommand& find_command(const std::string& name) {
  std::vector<std::string> names;
  for (const Subcommand& command : subcommands()) {
    if (name == command.name) return command;
    names.emplace_back(command.name);
  }
  const bool option = !name.empty() && name[0] == '-';
  std::string message = std::string("unknown ") + (option ? "option '" : "command '") + name + "'";
  if (const auto nearest = nearest_name(name, names))
    message += " (did you mean " + *nearest + "?)";
  throw onmesh::UsageError(message + "; see onmesh --help");
}

int run(const std::vector<std::string>& arguments, std::string& name) {
  if (arguments.empty()) {
    print_help(std::cerr);
    return kUsage;
  }
  std::string first = arguments[0];
  std::vector<std::string> rest(arguments.begin() + 1, arguments.end());
  const bool help = first == "help" || first == "--help" || first == "-h";
  if (help && rest.empty()) {
    print_help(std::cout);
    return 0;
  }
  if (first == "--version") {
    std::cout << "onmesh " << onmesh::version() << "\n";
    return 0;
  }
  if (help) {
    first = rest[0];
    rest = {"--help"};
  }
  const Subcommand& command = find_command(first);
  name = command.name;
  set_program_name("onmesh " + name);
  const std::optional<Arguments> parsed = parse(command.describe(), rest);
  return parsed ? command.run(*parsed) : 0;
}

// One line on stderr, whatever the message holds.
int fail(const std::string& name, std::string message, int code) {
  for (char& c : message) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  while (!message.empty() && message.back() == ' ') message.pop_back();
  std::cerr << "onmesh" << (name.empty() ? "" : " ") << name << ": " << message << '\n';
  return code;
}

void limit_instructions() {
  const char* const level = std::getenv("ONMESH_SIMD");
  if (level == nullptr) return;
  try {
    onmesh::limit_simd(level);
  } catch (const onmesh::UsageError& error) {
    throw onmesh::UsageError(std::string("ONMESH_SIMD: ") + error.what());
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::string name;
  int code = 0;
  end_library_start();
  install_signal_handling();
  try {
    limit_instructions();
    code = run({argv + std::min(argc, 1), argv + argc}, name);
    std::cout.flush();
    if (!std::cout) throw onmesh::FileError("standard output: cannot write");
  } catch (const Interrupted& interruption) {
    // The destructors have removed what was half written.
    code = fail(name, signal_word(interruption.signal), kSignal + interruption.signal);
  } catch (const onmesh::OptionError& error) {
    code = fail(name, flag_of_field(error.option()) + ": " + in_flags(error.problem()), kUsage);
  } catch (const onmesh::UsageError& error) {
    code = fail(name, error.what(), kUsage);
  } catch (const onmesh::FileError& error) {
    code = fail(name, error.what(), kFile);
  } catch (const std::filesystem::filesystem_error& error) {
    code = fail(name, error.path1().string() + ": " + error.code().message(), kFile);
  } catch (const std::bad_alloc&) {
    code = fail(name,
                "not enough memory, with " + onmesh::memory_text(onmesh::resident_memory_bytes()) +
                    " in use",
                kInput);
  } catch (const std::exception& error) {
    code = fail(name, error.what(), kInput);
  }
  return code;
}
