// What was given on the command line, by the names of the options.
#pragma once

#include <boost/program_options/variables_map.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "flags.h"
#include "onmesh/base/error.h"
#include "onmesh/filter/length.h"
#include "onmesh/filter/range_width.h"

namespace onmesh::tools {

/// The parsed arguments of a subcommand. Options are asked for by name, without dashes; whatever
/// is wrong with a value is a UsageError that names the option.
class Arguments {
 public:
  /// \param usage the subcommand's name and synopsis, for messages
  /// \param as_given all that stood on the command line behind the subcommand
  Arguments(std::string usage, boost::program_options::variables_map values,
            std::vector<std::string> as_given)
      : usage_(std::move(usage)), values_(std::move(values)), as_given_(std::move(as_given)) {}

  /// Whether there is a value, be it the default.
  bool has(const std::string& name) const { return values_.count(name) > 0; }
  /// Whether it was given: the default does not count, nor does a flag that was left out.
  bool given(const std::string& name) const;
  /// Options with their values in force: text, texts or flags.
  const boost::program_options::variables_map& values() const { return values_; }

  /// All that stood on the command line behind the subcommand.
  const std::vector<std::string>& as_given() const { return as_given_; }

  /// Give an option another default, as --preset does.
  /// \param value text, or one of several texts
  void set_default(const std::string& name, const std::string& value);

  /// \throw UsageError if the option was not given and has no default, or is empty
  std::string text(const std::string& name) const;
  std::optional<std::string> optional_text(const std::string& name) const;
  /// A positional argument; if it is missing the message shows the usage.
  std::string argument(const std::string& name) const;
  /// All values of an option that may be given several times.
  /// \throw UsageError if one is empty
  std::vector<std::string> texts(const std::string& name) const;
  bool flag(const std::string& name) const { return values_[name].as<bool>(); }

  /// A finite number; "50/255" is one, too.
  double number(const std::string& name) const;
  /// A number of bytes: "8G" is 8 * 2^30.
  /// \throw UsageError if it is none, or less than 1
  std::uint64_t bytes(const std::string& name) const;
  /// \throw UsageError unless it is in [low, high]
  double number(const std::string& name, double low, double high) const;
  std::int64_t integer(const std::string& name, std::int64_t low, std::int64_t high) const;
  /// So many finite numbers with commas between them.
  std::vector<double> numbers(const std::string& name, std::size_t count) const;
  /// A positive length: "0.2", "8tx" or "1%".
  Length length(const std::string& name) const;
  std::optional<Length> optional_length(const std::string& name) const;
  /// The width of a range weight: "0.1", "25/255" or "2n".
  RangeWidth width(const std::string& name) const;

  /// The enumerator whose name was given.
  template <typename Enum>
  Enum choice(const std::string& name,
              const std::vector<std::pair<std::string, Enum>>& known) const {
    const std::string value = text(name);
    std::string names;
    for (const auto& [known_name, enumerator] : known) {
      if (value == known_name) return enumerator;
      names += (names.empty() ? "" : ", ") + known_name;
    }
    throw UsageError(dashed(name) + ": '" + value + "' is not one of " + names);
  }

  /// \throw UsageError if `name` and one of the others were both given
  void refuse_together(const std::string& name, const std::vector<std::string>& others) const;
  /// \throw UsageError if one of the names was given without `needed`
  void require_with(const std::vector<std::string>& names, const std::string& needed) const;

 private:
  std::string usage_;
  boost::program_options::variables_map values_;
  std::vector<std::string> as_given_;
};

/// Finite numbers with commas between them.
/// \throw UsageError naming the option
std::vector<double> numbers_in(const std::string& option, const std::string& list);

}  // namespace onmesh::tools
