// What signals and limits do to a run.
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "support/paths.h"
#include "tools/tool_checks.h"

using namespace onmesh;
using Catch::Contains;

namespace {

void wait_for(int milliseconds) {
  std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
}

/// Whether the process runs the program already, and a thread of its own waits for SIGTERM. That it
/// is blocked does not tell: libraries block all signals for moments while they are loaded.
bool waits_for_signals(pid_t process) {
  const std::string folder = "/proc/" + std::to_string(process);
  std::error_code error;
  if (!std::filesystem::equivalent(folder + "/exe", program(), error)) return false;
  std::ifstream status(folder + "/status");
  const auto holds = [](const std::string& line, int signal) {
    return (std::stoull(line.substr(line.find(':') + 1), nullptr, 16) >> (signal - 1) & 1) != 0;
  };
  bool blocks = false, ignores = false;
  for (std::string line; std::getline(status, line);) {
    if (line.rfind("SigBlk:", 0) == 0) blocks = holds(line, SIGTERM);
    if (line.rfind("SigIgn:", 0) == 0) ignores = holds(line, SIGPIPE) && holds(line, SIGXFSZ);
  }
  return blocks && ignores;
}

/// Starts the program, sends a signal some time after it waits for one, and returns the exit code;
/// -signal if that killed it.
int code_after(int signal, int milliseconds, std::vector<std::string> arguments) {
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    std::string name = "onmesh";
    std::vector<char*> pointers{name.data()};
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    ::execv(program().c_str(), pointers.data());
    ::_exit(99);
  }
  for (int i = 0; i < 6000 && !waits_for_signals(child); ++i) wait_for(10);
  wait_for(milliseconds);
  ::kill(child, signal);
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

}  // namespace

TEST_CASE("an interrupted run leaves the target as it was and nothing else behind",
          "[tools][interruption][slow]") {
  const Workspace space;
  space.must("make-mesh noisy-cube -o m.obj -t m.png --size 1024");
  space.file("o.png", "what was there before");
  const auto files = space.files();
  // Far more work than the time until the signal.
  const std::vector<std::string> arguments{
      "filter",  (space / "m.obj").string(), "-o",  (space / "o.png").string(),
      "--quiet", "--sigma-spatial",          "30tx"};
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) {
    CHECK(code_after(signal, 700, arguments) == 128 + signal);
    CHECK(space.files() == files);
    CHECK(content_of(space / "o.png") == "what was there before");
  }
}

TEST_CASE("a signal ends a run that waits for its input", "[tools][interruption]") {
  const Workspace space;
  const std::string pipe = (space / "pipe.obj").string();
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  CHECK(code_after(SIGTERM, 0, {"info", pipe}) == 128 + SIGTERM);
}

TEST_CASE("a limit on file size is an error of writing", "[tools][interruption]") {
  const Workspace space;
  space.must("make-mesh noisy-cube -o m.obj -t m.png --size 256");
  const auto files = space.files();
  for (const char* const output : {"o.png", "o.exr", "o.tif"}) {
    INFO(output);
    const std::string command = "ulimit -f 16; '" + program().string() + "' filter '" +
                                (space / "m.obj").string() + "' -o '" + (space / output).string() +
                                "' --quiet --sigma-spatial 2tx 2>/dev/null";
    const int status = std::system(command.c_str());
    REQUIRE(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == 4);
    CHECK(space.files() == files);
  }
}

TEST_CASE("standard output that cannot be written is an error", "[tools][interruption]") {
  const std::string command =
      "( '" + program().string() + "' filter --help; echo $? >&2 ) 2>&1 >/dev/full | grep -q '^4$'";
  CHECK(std::system(command.c_str()) == 0);
}
