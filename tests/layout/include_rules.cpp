#include "layout/include_rules.h"

#include <algorithm>
#include <fstream>
#include <regex>
#include <sstream>
#include <stdexcept>

namespace onmesh {
namespace {

namespace fs = std::filesystem;

/// Made by CMake: no folder's, and everyone's.
constexpr char kVersionHeader[] = "onmesh/version.h";

struct IncludeLine {
  std::size_t number = 0;  ///< from 1
  std::string name;        ///< between the quotes or brackets
  bool quoted = false;
  bool highway = false;  ///< defines HWY_TARGET_INCLUDE
};

std::vector<std::string> lines_of(const fs::path& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot open " + path.string());
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

std::vector<IncludeLine> includes_of(const fs::path& path) {
  static const std::regex include(R"re(\s*#\s*include\s*(["<])([^">]+)[">].*)re");
  static const std::regex highway(R"re(\s*#\s*define\s+HWY_TARGET_INCLUDE\s+"([^"]+)".*)re");
  std::vector<IncludeLine> found;
  const std::vector<std::string> lines = lines_of(path);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    std::smatch match;
    if (std::regex_match(lines[i], match, include))
      found.push_back({i + 1, match[2], match[1] == "\"", false});
    else if (std::regex_match(lines[i], match, highway))
      found.push_back({i + 1, match[1], true, true});
  }
  return found;
}

std::vector<std::string> sorted_words(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;)
    if (word != "-") words.push_back(word);
  std::sort(words.begin(), words.end());
  return words;
}

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(' ');
  return first == std::string::npos ? ""
                                    : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

/// What stands between the bars of a row.
std::vector<std::string> cells_of(const std::string& row) {
  std::vector<std::string> cells;
  std::istringstream stream(row.substr(1));
  for (std::string cell; std::getline(stream, cell, '|');) cells.push_back(trimmed(cell));
  return cells;
}

bool contains(const std::vector<std::string>& list, const std::string& name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

const FolderRule* find_rule(const std::vector<FolderRule>& rules, const std::string& folder) {
  for (const FolderRule& rule : rules)
    if (rule.folder == folder) return &rule;
  return nullptr;
}

/// The rule as a reader of the message needs it.
std::string rule_text(const FolderRule& rule) {
  std::string text = rule.folder + "/ (" + rule.sentence + ") may include";
  if (rule.folder != "base") text += " base";
  for (const std::string& use : rule.uses) text += ' ' + use;
  return text + (rule.folder == "base" ? " nothing but itself" : "");
}

/// What is wrong with one include of a file that the rule is for; empty if nothing is.
std::string complaint(const IncludeLine& include, const std::string& file, const FolderRule& rule,
                      const std::vector<FolderRule>& rules) {
  if (include.highway)
    return include.name == file ? ""
                                : "HWY_TARGET_INCLUDE names " + include.name +
                                      ", not its own file: only one target would be compiled";
  if (!include.quoted || include.name == kVersionHeader) return "";
  const fs::path path = include.name;
  if (*path.begin() != "onmesh" || std::distance(path.begin(), path.end()) < 3)
    return "write \"" + include.name + "\" as \"onmesh/FOLDER/FILE\"";
  const std::string used = *std::next(path.begin());
  if (used == rule.folder || used == "base" || contains(rule.uses, used)) return "";
  const FolderRule* other = find_rule(rules, used);
  return "includes \"" + include.name + "\"" +
         (other ? " of level " + std::to_string(other->level) : " of an unknown folder") +
         ", but " + rule_text(rule);
}

std::vector<fs::path> sources_under(const fs::path& folder) {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const fs::path extension = entry.path().extension();
    if (extension == ".h" || extension == ".cpp") paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

}  // namespace

std::vector<FolderRule> read_folder_table(const fs::path& page) {
  static const std::regex name("`([a-z_]+)/`.*");
  std::vector<FolderRule> rules;
  bool inside = false;
  for (const std::string& line : lines_of(page)) {
    const bool row = line.starts_with('|');
    if (inside && !row) break;
    if (!row || line.starts_with("| level ")) continue;
    inside = true;
    if (line.starts_with("|--")) continue;
    const std::vector<std::string> cells = cells_of(line);
    std::smatch match;
    if (cells.size() != 4 || !std::regex_match(cells[1], match, name))
      throw std::runtime_error(page.string() + ": not a row of the folder table: " + line);
    rules.push_back({std::stoi(cells[0]), match[1], cells[2], sorted_words(cells[3])});
  }
  return rules;
}

std::vector<FolderRule> read_folder_uses(const fs::path& file) {
  std::vector<FolderRule> rules;
  for (const std::string& line : lines_of(file)) {
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos)
      throw std::runtime_error(file.string() + ": no colon in " + line);
    rules.push_back({0, line.substr(0, colon), "", sorted_words(line.substr(colon + 1))});
  }
  return rules;
}

std::vector<std::string> broken_includes(const fs::path& root,
                                         const std::vector<FolderRule>& rules) {
  std::vector<std::string> broken;
  for (const fs::path& path : sources_under(root / "lib" / "onmesh")) {
    const fs::path in_lib = path.lexically_relative(root / "lib");
    const std::string shown = "lib/" + in_lib.string();
    if (std::distance(in_lib.begin(), in_lib.end()) < 3) {
      broken.push_back(shown + ": lies in no folder of lib/onmesh");
      continue;
    }
    const FolderRule* rule = find_rule(rules, *std::next(in_lib.begin()));
    if (!rule) {
      broken.push_back(shown + ": its folder is not in the table of lib/README.md");
      continue;
    }
    for (const IncludeLine& include : includes_of(path)) {
      const std::string what = complaint(include, in_lib.string(), *rule, rules);
      if (!what.empty())
        broken.push_back(shown + ":" + std::to_string(include.number) + ": " + what);
    }
  }
  return broken;
}

std::vector<std::string> broken_public_headers(const fs::path& root,
                                               const std::vector<std::string>& headers) {
  std::vector<std::string> broken;
  for (const std::string& header : headers) {
    for (const IncludeLine& include : includes_of(root / "lib" / header)) {
      const bool allowed = include.quoted
                               ? include.name == kVersionHeader || contains(headers, include.name)
                               : include.name.find_first_of("/.") == std::string::npos ||
                                     include.name.starts_with("Eigen/");
      if (!allowed)
        broken.push_back("lib/" + header + ":" + std::to_string(include.number) + ": includes " +
                         include.name +
                         ", but a public header may include only public headers, the standard "
                         "library and Eigen");
    }
  }
  return broken;
}

}  // namespace onmesh
