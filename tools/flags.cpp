#include "flags.h"

#include <algorithm>
#include <utility>

namespace onmesh::tools {
namespace {

/// Fields whose flags have other names.
const std::pair<const char*, const char*> kRenamed[] = {{"faces", "material"},
                                                        {"filter_alpha", "alpha"}};

bool is_word(char c) { return (c >= 'a' && c <= 'z') || c == '_'; }

bool is_digit(char c) { return c >= '0' && c <= '9'; }

}  // namespace

std::string dashed(const std::string& name) { return (name.size() == 1 ? "-" : "--") + name; }

std::string flag_of_field(const std::string& field) {
  for (const auto& [name, flag] : kRenamed) {
    if (field == name) return dashed(flag);
  }
  std::string name = field;
  std::replace(name.begin(), name.end(), '_', '-');
  return dashed(name);
}

std::string in_flags(const std::string& text) {
  std::string out;
  std::size_t word = 0;  // where the word at hand begins in `out`
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool has_value = i + 1 < text.size() && (is_word(text[i + 1]) || is_digit(text[i + 1]));
    if (text[i] == '=' && word < out.size() && has_value) {
      out = out.substr(0, word) + flag_of_field(out.substr(word)) + ' ';
      word = out.size();
    } else {
      out += text[i];
      if (!is_word(text[i])) word = out.size();
    }
  }
  return out;
}

std::vector<std::string> in_flags(std::vector<std::string> texts) {
  for (std::string& text : texts) text = in_flags(text);
  return texts;
}

}  // namespace onmesh::tools
