#include "library_start.h"

#include <unistd.h>

#include <csignal>
#include <exception>
#include <string_view>

namespace onmesh::tools {
namespace {

std::terminate_handler terminate_before = nullptr;

/// Uses nothing that has to be initialised.
[[noreturn]] void fail_to_start() {
  constexpr std::string_view kMessage =
      "onmesh: the libraries cannot start: the limits leave too little memory or too few threads "
      "(see ulimit -v and -u)\n";
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, kMessage.data(), kMessage.size());
  ::_exit(3);
}

void guard_library_start() {
  terminate_before = std::set_terminate(fail_to_start);
  std::signal(SIGABRT, [](int) { fail_to_start(); });
}

/// Called after the libraries are mapped and before any of them initialises itself (the System V
/// ABI's DT_PREINIT_ARRAY).
[[gnu::section(".preinit_array"), gnu::used]] void (*const preinit)() = guard_library_start;

}  // namespace

void end_library_start() {
  std::set_terminate(terminate_before);
  std::signal(SIGABRT, SIG_DFL);
}

}  // namespace onmesh::tools
