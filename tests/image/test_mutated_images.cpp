// Damaged images of all formats end in an image or an error, in a program of their own, so that no
// crash and no hang of a library ends this one.
#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <cstdio>
#include <optional>
#include <sstream>

#include "onmesh/image/image_io.h"
#include "support/image_files.h"
#include "support/image_kinds.h"
#include "support/paths.h"

namespace onmesh {
namespace {

constexpr unsigned kMutations = 300;  // of each file

/// How reading a range of mutations ended early.
struct Failure {
  unsigned number = 0;
  std::string how;
};

/// Read the mutations from `first` on.
/// \return the first that was not read to its end, nothing if all were
std::optional<Failure> read_mutations(const ImageFolder& folder, const std::string& name,
                                      unsigned first) {
  std::ostringstream command;
  command << "exec " << mutation_reader() << ' ' << folder.path() << ' ' << name << ' ' << first
          << ' ' << kMutations << " 2>/dev/null";  // paths are put in quotes
  std::FILE* const output = ::popen(command.str().c_str(), "r");
  REQUIRE(output != nullptr);
  Failure failure{first, {}};
  while (std::fscanf(output, "%u", &failure.number) == 1) {
  }
  const int status = ::pclose(output);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return std::nullopt;
  std::ostringstream how;
  if (WIFSIGNALED(status)) {
    how << "signal " << WTERMSIG(status);
  } else {
    how << "exit code " << WEXITSTATUS(status);
  }
  failure.how = how.str();
  return failure;
}

TEST_CASE("mutated images of every format are read or refused, within memory and time",
          "[image][read_image][slow]") {
  const ImageFolder folder;
  const std::vector<std::string> names = write_image_kinds(folder.path());
  REQUIRE(names.size() > 30);
  for (const std::string& name : names) {
    constexpr int kMostFailures = 5;  // of a file, to be told of
    unsigned first = 0;
    for (int failures = 0; failures < kMostFailures && first < kMutations; ++failures) {
      const std::optional<Failure> failure = read_mutations(folder, name, first);
      if (!failure) break;
      INFO(name << ": mutation " << failure->number << " ended with " << failure->how);
      CHECK(false);
      first = failure->number + 1;
    }
  }
}

}  // namespace
}  // namespace onmesh
