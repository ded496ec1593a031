// Runs the onmesh program as a user does, in a folder of its own.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/temp_folder.h"

namespace onmesh {

std::string content_of(const std::filesystem::path& path);

struct Run {
  int code = -1;  ///< exit code; -signal if it was killed
  std::string out, err;
  nlohmann::json json() const { return nlohmann::json::parse(out); }
};

class Workspace {
 public:
  /// Arguments as in a shell, relative paths within the folder.
  Run run(const std::string& arguments) const;
  /// The same where success is taken for granted. \throw std::runtime_error if there is none
  Run must(const std::string& arguments) const;

  std::filesystem::path operator/(const std::string& name) const { return folder_.path() / name; }
  std::filesystem::path file(const std::string& name, const std::string& content) const {
    return folder_.file(name, content);
  }
  bool has(const std::string& name) const { return std::filesystem::exists(*this / name); }
  /// Names of all files, so that a test can tell whether something was left behind.
  std::vector<std::string> files() const;

 private:
  TempFolder folder_, logs_;
};

/// The vertex properties of a PLY as the program writes it (binary, double and int columns).
std::map<std::string, std::vector<double>> ply_columns(const std::filesystem::path& path);

}  // namespace onmesh
