// What the program's users call the options: flags. The library knows fields of structs.
#pragma once

#include <string>
#include <vector>

#include "onmesh/base/error.h"

namespace onmesh::tools {

/// "--name", or "-n" for names of one letter.
std::string dashed(const std::string& name);

/// The flag of a field of the library's options: "--sigma-spatial" for "sigma_spatial".
std::string flag_of_field(const std::string& field);

/// A text of the library with flags instead of fields: "--overlap first" for "overlap=first".
std::string in_flags(const std::string& text);
/// The same for each of several texts.
std::vector<std::string> in_flags(std::vector<std::string> texts);

/// Calls work(), which is about options only by their fields; an InputError comes out in flags.
/// (main() does it for OptionErrors.)
template <class Work>
auto with_flags(Work work) {
  try {
    return work();
  } catch (const InputError& error) {
    throw InputError(in_flags(error.what()));
  }
}

}  // namespace onmesh::tools
