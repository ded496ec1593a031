#include "support/run_program.h"

#include <sys/wait.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "support/paths.h"

namespace onmesh {

std::string content_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot open " + path.string());
  return {std::istreambuf_iterator<char>(file), {}};
}

Run Workspace::run(const std::string& arguments) const {
  const std::string streams = (logs_.path() / "log").string();
  const std::string command = "cd '" + folder_.path().string() + "' && exec '" +
                              program().string() + "' " + arguments + " >'" + streams +
                              ".out' 2>'" + streams + ".err' </dev/null";
  const int status = std::system(command.c_str());
  Run run;
  run.code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  run.out = content_of(streams + ".out");
  run.err = content_of(streams + ".err");
  return run;
}

Run Workspace::must(const std::string& arguments) const {
  Run result = run(arguments);
  if (result.code != 0)
    throw std::runtime_error("onmesh " + arguments + " failed (" + std::to_string(result.code) +
                             "): " + result.err);
  return result;
}

std::vector<std::string> Workspace::files() const {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::map<std::string, std::vector<double>> ply_columns(const std::filesystem::path& path) {
  const std::string content = content_of(path);
  const std::size_t body = content.find("end_header\n") + 11;
  std::istringstream header(content.substr(0, body));
  std::vector<std::pair<std::string, std::string>> properties;
  std::size_t count = 0;
  std::string line, word, type, name;
  bool vertices = false;
  while (std::getline(header, line)) {
    std::istringstream words(line);
    words >> word;
    if (word == "element") {
      words >> name;
      vertices = name == "vertex";
      if (vertices) words >> count;
    } else if (word == "property" && vertices) {
      words >> type >> name;
      properties.emplace_back(type, name);
    }
  }
  std::map<std::string, std::vector<double>> columns;
  const char* at = content.data() + body;
  for (std::size_t i = 0; i < count; ++i) {
    for (const auto& [kind, column] : properties) {
      if (kind == "double") {
        double value = 0;
        std::memcpy(&value, at, sizeof value);
        columns[column].push_back(value);
        at += sizeof value;
      } else {
        std::int32_t value = 0;
        std::memcpy(&value, at, sizeof value);
        columns[column].push_back(value);
        at += sizeof value;
      }
    }
  }
  return columns;
}

}  // namespace onmesh
