// Reads mutations of an image file, within limits of memory and time:
//
//     onmesh_read_mutations FOLDER NAME FIRST END
//
// for the mutations FIRST to END - 1 of the file NAME. Each number is printed before that mutation
// is read, so that the last one printed is the one that ended the program. Splices are with the
// other files of the folder.
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <vector>

#include "image/mutated_bytes.h"
#include "onmesh/base/error.h"
#include "onmesh/image/image_io.h"
#include "support/image_files.h"

namespace fs = std::filesystem;

namespace {

constexpr unsigned kSeconds = 10;

/// Address space, bytes: the program and its libraries take some 500 MB before they do anything.
constexpr rlim_t kAddressSpace = rlim_t{3} << 30;

/// Sanitizers reserve more address space than there is memory.
constexpr bool kSanitized =
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    true;
#else
    false;
#endif

std::vector<fs::path> files_of(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

void read_mutation(const std::string& bytes, const std::string& other, unsigned number,
                   const fs::path& path) {
  std::cout << number << std::endl;
  onmesh::dump(path, onmesh::mutated(bytes, other, number));
  ::alarm(kSeconds);
  try {
    onmesh::read_image(path);
  } catch (const onmesh::InputError&) {
  } catch (const onmesh::FileError&) {
  }
  ::alarm(0);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) return 2;
  const fs::path folder = argv[1], name = argv[2];
  const auto first = unsigned(std::atoi(argv[3])), end = unsigned(std::atoi(argv[4]));
  rlimit limit{kAddressSpace, kAddressSpace};
  if (!kSanitized && ::setrlimit(RLIMIT_AS, &limit) != 0) return 2;
  std::vector<std::string> others;
  for (const fs::path& file : files_of(folder)) others.push_back(onmesh::slurp(file));
  const std::string bytes = onmesh::slurp(folder / name);
  const onmesh::ImageFolder work;
  for (unsigned number = first; number < end; ++number) {
    read_mutation(bytes, others[number % others.size()], number,
                  work / ("mutated" + name.extension().string()));
  }
  return 0;
}
