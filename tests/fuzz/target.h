// What fuzz targets are made of. Each is a program that calls LLVMFuzzerTestOneInput() with many
// inputs: Clang's libFuzzer makes them up, replay_main.cpp reads them from files.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <string>

#include "onmesh/base/error.h"

/// The target: whatever the bytes are, it returns. All else is a finding.
/// \return 0
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace onmesh::fuzz {

/// Ends the program, which is a finding, unless `holds`.
inline void require(bool holds, const std::string& otherwise) {
  if (holds) return;
  std::cerr << "finding: " << otherwise << '\n';
  std::abort();
}

/// What onmesh says is one line, and not empty.
inline void require_line(const std::string& text) {
  const bool breaks =
      std::any_of(text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; });
  require(!text.empty() && !breaks, "a message is not one line: \"" + text + "\"");
}

/// Calls work(). Errors of onmesh are a good answer to any input; others pass through and end the
/// program.
/// \return whether there was none
template <class Work>
bool succeeds(Work work) {
  try {
    work();
    return true;
  } catch (const UsageError& error) {
    require_line(error.what());
  } catch (const InputError& error) {
    require_line(error.what());
  } catch (const FileError& error) {
    require_line(error.what());
  } catch (const NumericError& error) {
    require_line(error.what());
  }
  return false;
}

}  // namespace onmesh::fuzz
