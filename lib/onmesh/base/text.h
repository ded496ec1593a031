// Numbers in sentences.
#pragma once

#include <cstdint>
#include <string>

namespace onmesh {

/// "1 face", "3 faces": the count and the word, or words, that go with it.
inline std::string count_text(std::uint64_t count, const char* one, const char* many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

}  // namespace onmesh
