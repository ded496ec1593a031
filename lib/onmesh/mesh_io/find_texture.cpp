#include "onmesh/mesh_io/find_texture.h"

#include <algorithm>
#include <system_error>

namespace onmesh {
namespace fs = std::filesystem;
namespace {

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

}  // namespace

std::string find_texture(std::string name, const fs::path& folder) {
  if (name.size() > 1 && name.front() == '"' && name.back() == '"') {
    name = name.substr(1, name.size() - 2);
  }
  if (name.empty()) return {};
  if (is_file(folder / name)) return (folder / name).lexically_normal().string();
  std::replace(name.begin(), name.end(), '\\', '/');
  const fs::path plain = (folder / name).lexically_normal();
  if (!is_file(plain)) {
    const fs::path beside = folder / fs::path(name).filename();
    if (is_file(beside)) return beside.lexically_normal().string();
  }
  return plain.string();
}

}  // namespace onmesh
