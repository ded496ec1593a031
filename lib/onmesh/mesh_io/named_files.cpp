#include "onmesh/mesh_io/named_files.h"

#include <algorithm>
#include <cctype>
#include <system_error>

#include "onmesh/base/error.h"
#include "onmesh/base/text.h"
#include "onmesh/base/text_scan.h"

namespace onmesh {
namespace fs = std::filesystem;
namespace {

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

std::string without_quotes(const std::string& name) {
  const bool is_quoted = name.size() > 1 && name.front() == '"' && name.back() == '"';
  return is_quoted ? name.substr(1, name.size() - 2) : name;
}

/// A drive's letter, or the scheme of a URL, and a colon.
bool has_scheme(std::string_view name) {
  const std::size_t colon = name.find(':');
  if (colon == std::string_view::npos || colon == 0) return false;
  const std::string_view scheme = name.substr(0, colon);
  const bool is_word = std::all_of(scheme.begin(), scheme.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '+' || c == '-' || c == '.';
  });
  const bool has_path = colon + 1 < name.size() && name[colon + 1] == '/';
  return is_word && (colon == 1 || has_path || lower_case(scheme) == "file");
}

/// Nothing relative to this folder: a path of this or another machine, or a URL.
/// \param name with slashes of one kind
bool is_elsewhere(std::string_view name) { return name.starts_with('/') || has_scheme(name); }

/// The name behind the last slash, of a drive without one behind its colon.
std::string bare_name(std::string_view name) {
  const std::size_t cut = name.find_last_of(has_scheme(name) ? "/:" : "/");
  return std::string(cut == std::string_view::npos ? name : name.substr(cut + 1));
}

/// A path that says "outside" by itself, whatever its links do.
bool is_named_outside(const fs::path& file, const fs::path& folder) {
  std::error_code ignored;
  const fs::path from = fs::absolute(folder.empty() ? "." : folder, ignored).lexically_normal();
  const fs::path relative = fs::absolute(file, ignored).lexically_normal().lexically_relative(from);
  return relative.empty() || *relative.begin() == "..";
}

}  // namespace

bool lies_outside(const fs::path& file, const fs::path& folder) {
  std::error_code failed;
  const fs::path from = fs::weakly_canonical(folder.empty() ? "." : folder, failed);
  if (failed) return true;
  const fs::path to = fs::weakly_canonical(fs::absolute(file, failed), failed);
  if (failed) return true;
  const fs::path relative = to.lexically_relative(from);
  return relative.empty() || *relative.begin() == "..";
}

/// Where a file of that name may be, best first.
std::vector<fs::path> NamedFiles::places_of(const std::string& name, const Path& naming) const {
  std::vector<Path> places;
  // The system would take the name to end there.
  if (name.find('\0') != std::string::npos) return places;
  // Only the name itself may lead out of the mesh's folder, not a guess where it may be.
  const auto add = [&](const Path& place) {
    if (!places.empty() && is_named_outside(place, folder_)) return;
    if (std::find(places.begin(), places.end(), place) == places.end()) places.push_back(place);
  };
  const Path own = naming.parent_path();
  // A backslash may be part of the name.
  if (name.find('/') == std::string::npos && is_file(own / name)) add(own / name);
  std::string path = name;
  std::replace(path.begin(), path.end(), '\\', '/');
  const std::string bare = bare_name(path);
  if (!is_elsewhere(path)) {
    add((own / path).lexically_normal());
    add((folder_ / path).lexically_normal());
  }
  if (bare.empty() || bare == "." || bare == "..") return places;
  add((own / bare).lexically_normal());
  add((folder_ / bare).lexically_normal());
  return places;
}

void NamedFiles::require_inside(const Path& file, const std::string& name,
                                const Path& naming) const {
  if (!options_.confine || !lies_outside(file, folder_)) return;
  throw InputError(naming.string() + ": " + quote(name) +
                   " lies outside the mesh's folder, which is refused (confine)");
}

/// What a folder holds; nothing if it cannot be read.
const std::vector<std::pair<std::string, std::string>>& NamedFiles::names_in(const Path& folder) {
  const auto [at, is_new] = listings_.try_emplace(folder);
  if (!is_new) return at->second;
  std::error_code failed;
  fs::directory_iterator entry(folder.empty() ? Path(".") : folder, failed);
  for (; !failed && entry != fs::directory_iterator(); entry.increment(failed)) {
    const std::string name = entry->path().filename().string();
    at->second.emplace_back(lower_case(name), name);
  }
  std::sort(at->second.begin(), at->second.end());
  return at->second;
}

/// The only file whose path differs in the case of letters at most, from where it leaves that of
/// the naming file or of the mesh: the folders up to there are known.
std::optional<fs::path> NamedFiles::in_any_case(const Path& path, const Path& naming) {
  constexpr std::size_t kMostPaths = 64;  // more is no unique match to be
  std::vector<Path> parts(path.begin(), path.end());
  std::size_t known = 0;
  for (const Path& base : {naming.parent_path().lexically_normal(), folder_.lexically_normal()}) {
    const auto differs = std::mismatch(parts.begin(), parts.end(), base.begin(), base.end()).first;
    known = std::max(known, static_cast<std::size_t>(differs - parts.begin()));
  }
  std::vector<Path> paths(1);
  for (std::size_t i = 0; i < known; ++i) paths[0] /= parts[i];
  parts.erase(parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(known));
  for (const Path& part : parts) {
    std::vector<Path> next;
    for (const Path& folder : paths) {
      if (part == ".." || part == ".") {
        next.push_back(folder / part);
        continue;
      }
      const auto& names = names_in(folder);
      const std::string wanted = lower_case(part.string());
      auto at = std::lower_bound(names.begin(), names.end(), std::pair(wanted, std::string()));
      for (; at != names.end() && at->first == wanted; ++at) next.push_back(folder / at->second);
    }
    if (next.empty() || next.size() > kMostPaths) return std::nullopt;
    paths = std::move(next);
  }
  std::erase_if(paths, [](const Path& found) { return !is_file(found); });
  return paths.size() == 1 ? std::optional(paths[0].lexically_normal()) : std::nullopt;
}

/// The file, once it is told how it differs from what was named.
fs::path NamedFiles::taken(const Path& file, const std::string& name, const Path& naming,
                           bool is_exact) {
  require_inside(file, name, naming);
  const std::string who = naming.string() + ": ";
  if (is_named_outside(file, folder_)) {
    report_.warnings.push_back(who + quote(name) +
                               " lies outside the mesh's folder: " + file.string() + " is read");
  }
  std::string plain = name;
  std::replace(plain.begin(), plain.end(), '\\', '/');
  const Path own = naming.parent_path();
  if (!is_exact) {
    report_.warnings.push_back(who + quote(name) + " is not there; " + file.string() +
                               ", which differs in the case of letters, is taken");
  } else if (file != (own / plain).lexically_normal() && file != own / name) {
    report_.assumed.push_back(who + quote(name) + " is not there: " + file.string() + " is meant");
  }
  return file;
}

std::optional<fs::path> NamedFiles::find_exactly(const std::vector<std::string>& readings,
                                                 const Path& naming) {
  for (const std::string& reading : readings) {
    const std::string name = without_quotes(reading);
    if (name.empty()) continue;
    const std::vector<Path> places = places_of(name, naming);
    if (places.empty()) continue;
    // A name that leads out is refused whether there is such a file or not; one that may be a
    // comment in part only if there is.
    if (&reading == &readings.back()) require_inside(places[0], name, naming);
    std::string plain = name;
    std::replace(plain.begin(), plain.end(), '\\', '/');
    if (!is_elsewhere(plain) && is_file(places[0])) return taken(places[0], name, naming, true);
  }
  return std::nullopt;
}

std::optional<fs::path> NamedFiles::find(const std::vector<std::string>& readings,
                                         const Path& naming) {
  const std::pair key(naming, readings);
  const auto known = found_.find(key);
  if (known != found_.end()) return known->second;
  return found_[key] = search(readings, naming);
}

std::optional<fs::path> NamedFiles::search(const std::vector<std::string>& readings,
                                           const Path& naming) {
  if (auto found = find_exactly(readings, naming)) return found;
  for (const bool is_exact : {true, false}) {
    for (const std::string& reading : readings) {
      const std::string name = without_quotes(reading);
      if (name.empty()) continue;
      for (const Path& place : places_of(name, naming)) {
        if (is_exact && is_file(place)) return taken(place, name, naming, true);
        if (is_exact) continue;
        if (const auto other = in_any_case(place, naming))
          return taken(*other, name, naming, false);
      }
    }
  }
  return std::nullopt;
}

std::string NamedFiles::path_of(const std::vector<std::string>& readings, const Path& naming) {
  if (const auto found = find(readings, naming)) return found->string();
  const std::string name = readings.empty() ? std::string() : without_quotes(readings.back());
  if (name.empty()) return {};
  const std::vector<Path> places = places_of(name, naming);
  return places.empty() ? std::string() : places[0].string();
}

}  // namespace onmesh
