// Writes the first inputs of the target `image` into a folder: one for every kind of image.
#include <algorithm>
#include <iterator>
#include <string>

#include "fuzz/image_extensions.h"
#include "support/image_files.h"
#include "support/image_kinds.h"

namespace {

char number_of(const std::string& extension) {
  const auto begin = std::begin(onmesh::fuzz::kImageExtensions);
  const auto end = std::end(onmesh::fuzz::kImageExtensions);
  return char(std::min(std::find(begin, end, extension) - begin, end - begin - 1));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const std::filesystem::path target = argv[1];
  const onmesh::ImageFolder folder;
  for (const std::string& name : onmesh::write_image_kinds(folder.path())) {
    const std::string extension = std::filesystem::path(name).extension().string().substr(1);
    onmesh::dump(target / name, number_of(extension) + onmesh::slurp(folder / name));
  }
  return 0;
}
