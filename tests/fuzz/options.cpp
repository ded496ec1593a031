// An input is an argument list, an argument a line: "filter", "cube.obj", "--sigma-range",
// "50/255".
#include <fcntl.h>
#include <unistd.h>

#include <cctype>
#include <filesystem>
#include <iostream>

#include "flags.h"
#include "fuzz/target.h"
#include "onmesh/filter/length.h"
#include "subcommands.h"
#include "support/temp_folder.h"

using namespace onmesh;

namespace {

/// While it lives the working folder is one that was removed: by relative paths nothing can be
/// read or written.
class NoFiles {
 public:
  NoFiles() : before_(::open(".", O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    static const int kRemoved = removed_folder();
    fuzz::require(before_ >= 0 && ::fchdir(kRemoved) == 0, "cannot leave the working folder");
  }
  ~NoFiles() {
    fuzz::require(::fchdir(before_) == 0, "cannot go back to the working folder");
    ::close(before_);
  }
  NoFiles(const NoFiles&) = delete;
  NoFiles& operator=(const NoFiles&) = delete;

 private:
  static int removed_folder() {
    const TempFolder folder;  // what is opened outlives it
    return ::open(folder.path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  }
  int before_;
};

/// Slashes are for numbers only: as a path, what they are in would lead out of the folder.
bool is_within_folder(const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto digit_at = [&](std::size_t at) {
      return at < text.size() && std::isdigit(static_cast<unsigned char>(text[at])) != 0;
    };
    if (text[i] == '/' && !(i > 0 && digit_at(i - 1) && digit_at(i + 1))) return false;
  }
  return true;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0, end = 0; end != std::string::npos; begin = end + 1) {
    end = text.find('\n', begin);
    lines.push_back(text.substr(begin, end - begin));
  }
  return lines;
}

/// A length that reads is written so that it reads as the same.
void check_length(const std::string& text) {
  fuzz::succeeds([&] {
    const Length length = parse_length("length", text);
    const Length again = parse_length("length", to_string(length));
    fuzz::require(length.value > 0 && again.value == length.value && again.unit == length.unit,
                  "a length is another one once written: " + text);
  });
}

/// What Arguments makes of a value, whatever the option.
void check_values(const std::string& text) {
  boost::program_options::variables_map map;
  map.insert({"value", boost::program_options::variable_value(boost::any(text), false)});
  const tools::Arguments arguments("fuzz", std::move(map), {});
  fuzz::succeeds([&] { arguments.number("value"); });
  fuzz::succeeds([&] { fuzz::require(arguments.bytes("value") >= 1, "no bytes were read"); });
  fuzz::succeeds([&] {
    const std::int64_t value = arguments.integer("value", -5, 1000);
    fuzz::require(value >= -5 && value <= 1000, "a number is out of its range");
  });
  fuzz::succeeds([&] {
    fuzz::require(arguments.numbers("value", 3).size() == 3, "there are not three numbers");
  });
}

/// Parse, and run up to where the first file would be read. What needs none only parses.
void check_arguments(const tools::Subcommand& command, const std::vector<std::string>& list) {
  try {
    const auto arguments = tools::parse(command.describe(), list);
    if (arguments && command.run != tools::run_make_mesh) command.run(*arguments);
  } catch (const OptionError& error) {
    fuzz::require_line(tools::flag_of_field(error.option()) + tools::in_flags(error.problem()));
  } catch (const UsageError&) {  // they quote what was typed, and main() sees to it being one line
  } catch (const InputError&) {
  } catch (const FileError&) {
  } catch (const std::filesystem::filesystem_error&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(data, data + size);
  // No argument holds a zero, and messages quote what main() makes one line of.
  if (!is_within_folder(text) || text.find_first_of(std::string("\0\r", 2)) != std::string::npos)
    return 0;
  std::cout.setstate(std::ios::failbit);  // help is asked for often
  std::vector<std::string> lines = lines_of(text);
  const std::string first = lines.front();
  lines.erase(lines.begin());
  const NoFiles no_files;
  for (const tools::Subcommand& command : tools::subcommands()) {
    if (first == command.name) check_arguments(command, lines);
  }
  std::vector<std::string> names;
  for (const tools::Subcommand& command : tools::subcommands()) names.emplace_back(command.name);
  tools::nearest_name(first, names);
  check_length(first);
  fuzz::succeeds([&] { check_values(first); });
  return 0;
}
