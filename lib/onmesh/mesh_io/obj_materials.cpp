#include "onmesh/mesh_io/obj_materials.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "onmesh/base/error.h"
#include "onmesh/base/file_io.h"
#include "onmesh/base/text.h"
#include "onmesh/base/text_scan.h"
#include "onmesh/mesh_io/named_files.h"
#include "onmesh/mesh_io/read_mtl.h"

namespace onmesh {
namespace fs = std::filesystem;
namespace {

/// Bytes.
constexpr std::uintmax_t kLargestMaterialFile = std::uintmax_t{64} << 20;

/// The names of several files in one line, each ending in ".mtl"; what is behind the last is one.
std::vector<std::string> split_at_extensions(const std::string& line) {
  constexpr std::string_view kExtension = ".mtl";
  const std::string lower = lower_case(line);
  std::vector<std::string> names;
  std::size_t begin = 0;
  const auto add = [&](std::size_t end) {
    const std::size_t first = line.find_first_not_of(" \t", begin);
    if (first < end) names.push_back(line.substr(first, end - first));
    begin = end;
  };
  for (std::size_t at = 0; (at = lower.find(kExtension, at)) != std::string::npos;) {
    at += kExtension.size();
    if (at == line.size() || line[at] == ' ' || line[at] == '\t') add(at);
  }
  add(line.size());
  return names;
}

std::vector<std::string> split_at_blanks(const std::string& line) {
  TextScan scan(line, {}, Syntax::plain);
  std::vector<std::string> names;
  while (scan.skip_blank()) names.emplace_back(scan.token());
  return names;
}

/// A material as a file defines it.
struct MaterialDefinition {
  std::string name;  ///< as written
  fs::path file;     ///< that has the texture
  MaterialTexture texture;
  bool is_repeated = false;  ///< has been told of
};

class ObjMaterialReader {
 public:
  ObjMaterialReader(const fs::path& obj, const ReadOptions& options, ReadReport& report)
      : obj_(obj), report_(report), files_(obj, options, report) {}

  ObjMaterials run(const ObjMaterialNames& names) {
    for (const std::string& line : names.libraries) read_line(line);
    const bool any_used =
        std::find(names.is_used.begin(), names.is_used.end(), true) != names.is_used.end();
    if (names.libraries.empty() && any_used) read_namesake();
    return resolve(names);
  }

 private:
  void warn(const std::string& text) { report_.warnings.push_back(obj_.string() + ": " + text); }

  void read_line(const std::string& line) {
    if (line.empty() || !lines_.insert(line).second) return;
    report_.read.push_back("mtllib " + quote(line));
    const std::vector<std::string> readings = readings_of(line);
    if (const auto file = files_.find_exactly(readings, obj_)) return read_file(*file);
    const std::vector<std::string> names = split_at_extensions(readings.back());
    if (names.size() == 1) return read_named(names[0]);
    const auto exists = [&](const std::string& name) {
      return files_.find({name}, obj_).has_value();
    };
    const std::vector<std::string> words = split_at_blanks(readings.back());
    const bool in_words = std::none_of(names.begin(), names.end(), exists) &&
                          std::any_of(words.begin(), words.end(), exists);
    for (const std::string& name : in_words ? words : names) read_named(name);
  }

  /// A single name; names with blanks may still be several.
  void read_named(const std::string& name) {
    if (const auto file = files_.find({name}, obj_)) return read_file(*file);
    const std::vector<std::string> words = split_at_blanks(name);
    const bool in_words = std::any_of(words.begin(), words.end(), [&](const std::string& word) {
      return files_.find({word}, obj_).has_value();
    });
    if (words.size() > 1 && in_words) {
      for (const std::string& word : words) read_named(word);
      return;
    }
    read_file(files_.path_of({name}, obj_));  // says why not
    read_namesake();
  }

  /// The material file with the OBJ's own name, if there is one.
  void read_namesake() {
    const std::string name = obj_.stem().string() + ".mtl";
    const auto file = files_.find({name}, obj_);
    if (!file || read_.count(*file) > 0) return;
    warn(file->string() + " is assumed to define its materials");
    read_file(*file);
  }

  void read_file(const fs::path& path) {
    if (!read_.insert(path).second) return;
    std::string content;
    try {
      content = read_named_file(path, kLargestMaterialFile);
    } catch (const FileError& error) {
      warn(std::string("material file ignored: ") + error.what());
      return;
    }
    const MaterialFile file = read_mtl(content, path.string());
    report_.read.push_back(path.string() + ": " + std::to_string(file.materials.size()) +
                           " newmtl, " + std::to_string(file.textures.size()) + " map_Kd");
    for (const auto& [keyword, count] : file.ignored) {
      report_.ignored.push_back(std::to_string(count) + " " + keyword + " of " + path.string());
    }
    for (const std::string& name : file.materials) define(name, path);
    for (const MaterialTexture& texture : file.textures) add_texture(texture, path);
  }

  void define(const std::string& name, const fs::path& file) {
    const auto [at, is_new] = by_name_.try_emplace(name, definitions_.size());
    if (is_new) {
      definitions_.push_back({name, file, {}, false});
    } else {
      tell_repeated(definitions_[at->second], file, "is defined more than once");
    }
  }

  void add_texture(const MaterialTexture& texture, const fs::path& file) {
    MaterialDefinition& definition = definitions_[by_name_.at(texture.material)];
    if (definition.texture.texture.empty()) {
      definition.texture = texture;
      definition.file = file;
    } else {
      tell_repeated(definition, file, "has several map_Kd");
    }
  }

  void tell_repeated(MaterialDefinition& definition, const fs::path& file, const char* what) {
    if (std::exchange(definition.is_repeated, true)) return;
    report_.assumed.push_back(file.string() + ": material " + quote(definition.name) + " " + what +
                              ": its first texture counts");
  }

  /// A definition, and what the OBJ calls it.
  struct Match {
    const MaterialDefinition* definition = nullptr;
    std::string name;
  };

  /// Names as they are go before those without a comment behind them, and those before names in
  /// another case.
  Match match(const std::string& written, bool is_used) {
    const std::vector<std::string> readings = readings_of(written);
    for (const std::string& reading : readings) {
      for (const auto* names : {&by_name_, &by_cut_name_}) {
        if (const auto at = names->find(reading); at != names->end()) {
          return {&definitions_[at->second], reading};
        }
      }
    }
    for (const std::string& reading : readings) {
      const auto at = by_lower_name_.find(lower_case(reading));
      if (at == by_lower_name_.end() || at->second.size() != 1) continue;
      const MaterialDefinition& definition = definitions_[*at->second.begin()];
      if (is_used) {
        warn("material " + quote(reading) + " is not defined; " + quote(definition.name) +
             ", which differs in the case of letters, is taken");
      }
      return {&definition, reading};
    }
    return {nullptr, readings.back()};
  }

  void index_names() {
    for (std::size_t i = 0; i < definitions_.size(); ++i) {
      const std::string cut = without_comment(definitions_[i].name);
      by_cut_name_.try_emplace(cut, i);
      for (const std::string& name : {definitions_[i].name, cut}) {
        by_lower_name_[lower_case(name)].insert(i);
      }
    }
  }

  ObjMaterials resolve(const ObjMaterialNames& names) {
    index_names();
    ObjMaterials result;
    std::unordered_map<std::string, Index> numbers;
    std::vector<std::string> undefined;
    for (std::size_t i = 0; i < names.materials.size(); ++i) {
      const Match found = match(names.materials[i], names.is_used[i]);
      const auto [at, is_new] =
          numbers.try_emplace(found.name, static_cast<Index>(result.materials.size()));
      result.of_name.push_back(at->second);
      if (found.definition == nullptr && names.is_used[i]) undefined.push_back(found.name);
      if (!is_new) continue;
      result.materials.push_back({found.name, {}});
      result.transforms.push_back(UvTransform::Identity());
      if (found.definition != nullptr) take_over(*found.definition, names.is_used[i], result);
    }
    tell_undefined(undefined);
    tell_options();
    return result;
  }

  /// What the definition says goes into the last material.
  void take_over(const MaterialDefinition& definition, bool is_used, ObjMaterials& result) {
    const MaterialTexture& given = definition.texture;
    if (given.texture.empty()) return;
    Material& material = result.materials.back();
    material.texture = files_.path_of(readings_of(given.texture), definition.file);
    if (given.wrap) material.wrap = *given.wrap;
    result.transforms.back() = scale_and_offset(given.scale, given.offset);
    if (!is_used) return;
    for (const std::string& option : given.ignored) {
      const std::string word = option.substr(0, option.find(' '));
      Unfollowed& known = unfollowed_[{definition.file, word}];
      if (++known.count == 1) known.text = "material " + quote(material.name) + ": " + option;
    }
  }

  void tell_undefined(const std::vector<std::string>& undefined) {
    if (undefined.empty()) return;
    constexpr std::size_t kMost = 8;
    std::string text;
    for (std::size_t i = 0; i < std::min(kMost, undefined.size()); ++i) {
      text += (i == 0 ? "" : ", ") + quote(undefined[i]);
    }
    if (undefined.size() > kMost) {
      text += " and " + std::to_string(undefined.size() - kMost) + " more";
    }
    warn("no material file defines " + text + ", which faces use");
  }

  void tell_options() {
    for (const auto& [key, told] : unfollowed_) {
      report_.warnings.push_back(
          key.first.string() + ": " + told.text + " of map_Kd is not followed" +
          (told.count == 1
               ? std::string()
               : " (nor that of " +
                     count_text(told.count - 1, "other material", "other materials") + ")"));
    }
  }

  /// An option of a file's textures that changes them and is not followed.
  struct Unfollowed {
    std::string text;  ///< of the first material
    std::size_t count = 0;
  };

  fs::path obj_;
  ReadReport& report_;
  NamedFiles files_;
  std::set<std::string> lines_;
  std::set<fs::path> read_;
  std::vector<MaterialDefinition> definitions_;
  std::unordered_map<std::string, std::size_t> by_name_, by_cut_name_;
  std::unordered_map<std::string, std::set<std::size_t>> by_lower_name_;
  std::map<std::pair<fs::path, std::string>, Unfollowed> unfollowed_;
};

}  // namespace

ObjMaterials find_obj_materials(const fs::path& obj, const ObjMaterialNames& names,
                                const ReadOptions& options, ReadReport& report) {
  return ObjMaterialReader(obj, options, report).run(names);
}

}  // namespace onmesh
