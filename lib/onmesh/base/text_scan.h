// A cursor over a text file, token by token and line by line: what the text readers share.
#pragma once

#include <charconv>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>

#include "onmesh/base/error.h"

namespace onmesh {

/// A piece of a file for an error message: short, printable, on one line.
inline std::string quote(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  std::string result = "'";
  for (const char c : text.substr(0, kLongest)) {
    result += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
  }
  return result + (text.size() > kLongest ? "...'" : "'");
}

/// The value of a numeric token, independent of the locale; not finite for "nan", "inf", overflow
/// and the "1.#QNAN" of old C libraries. A number too small for a double is 0. \return false if the
/// token is no number
inline bool parse_number(std::string_view token, double& value) {
  const char* begin = token.data();
  const char* const end = begin + token.size();
  if (token.size() > 1 && *begin == '+' && begin[1] != '-' && begin[1] != '+') ++begin;
  const auto [last, error] = std::from_chars(begin, end, value);
  if (error == std::errc::result_out_of_range && last == end) {
    const std::size_t exponent = token.find_first_of("eE");
    const std::size_t digit = token.find_first_of("123456789.");
    const bool small =
        exponent != std::string_view::npos ? token[exponent + 1] == '-' : token[digit] == '.';
    value = small ? 0 : std::numeric_limits<double>::infinity();
    return true;
  }
  if (error == std::errc() && last == end) return true;
  if (error == std::errc() && *last == '#' && last[-1] == '.') {
    value = std::numeric_limits<double>::quiet_NaN();
    return true;
  }
  return false;
}

/// What a format's lines may hold besides tokens.
enum class Syntax {
  plain,
  comments,                ///< a '#' at the start of a token ends the line
  comments_continuations,  ///< and a backslash before the line's end joins it with the next
};

/// Lines end with LF, CR LF or CR.
class TextScan {
 public:
  TextScan(std::string_view text, std::string file, Syntax syntax)
      : at_(text.data()),
        end_(at_ + text.size()),
        file_(std::move(file)),
        comments_(syntax != Syntax::plain),
        continuations_(syntax == Syntax::comments_continuations) {
    if (text.starts_with("\xef\xbb\xbf")) at_ += 3;  // UTF-8 byte order mark
  }

  bool at_end() const { return at_ == end_; }
  std::size_t remaining() const { return static_cast<std::size_t>(end_ - at_); }
  std::size_t line() const { return line_; }
  const char* position() const { return at_; }
  void set_line(std::size_t line) { line_ = line; }

  /// Go to the line's next token.
  /// \return false at the line's end
  bool skip_blank() {
    while (at_ != end_) {
      if (*at_ == ' ' || *at_ == '\t' || *at_ == '\f' || *at_ == '\v') {
        ++at_;
      } else if (*at_ == '\\' && continuations_ && at_ + 1 != end_ &&
                 (at_[1] == '\n' || at_[1] == '\r')) {
        ++at_;
        skip_line_end();
      } else {
        return *at_ != '\n' && *at_ != '\r' && !(comments_ && *at_ == '#');
      }
    }
    return false;
  }

  /// The next token of this line; empty at the line's end.
  std::string_view token() {
    if (!skip_blank()) return {};
    const char* const begin = at_;
    while (at_ != end_ && !is_blank(*at_)) ++at_;
    // A continuation may follow a token without a space.
    if (continuations_ && at_ != end_ && (*at_ == '\n' || *at_ == '\r') && at_ - begin > 1 &&
        at_[-1] == '\\')
      --at_;
    return {begin, static_cast<std::size_t>(at_ - begin)};
  }

  /// The next token of this or a later line; empty at the file's end.
  std::string_view token_anywhere() {
    while (!skip_blank()) {
      if (at_end()) return {};
      next_line();
    }
    return token();
  }

  /// What is left of this line without blanks at its ends; comments and continuations count as
  /// text.
  std::string_view rest_of_line() {
    while (at_ != end_ && (*at_ == ' ' || *at_ == '\t')) ++at_;
    const char* const begin = at_;
    while (at_ != end_ && *at_ != '\n' && *at_ != '\r') ++at_;
    const char* last = at_;
    while (last != begin && (last[-1] == ' ' || last[-1] == '\t')) --last;
    return {begin, static_cast<std::size_t>(last - begin)};
  }

  /// Skip the rest of this line and the lines that continue it. A comment is not continued: it may
  /// well end with a Windows path.
  void next_line() {
    const bool comment = !skip_blank() && at_ != end_ && *at_ == '#';
    for (;;) {
      while (at_ != end_ && *at_ != '\n' && *at_ != '\r') ++at_;
      if (at_ == end_) return;
      const bool continued = continuations_ && !comment && at_ != start_ && at_[-1] == '\\';
      skip_line_end();
      if (!continued) return;
    }
  }

  /// The number that comes next on this line; may be NaN or infinite.
  double number(const char* what) { return number(token(), what); }
  double number(std::string_view text, const char* what) const {
    double value = 0;
    if (text.empty()) fail(std::string(what) + " is missing");
    if (!parse_number(text, value)) fail(std::string(what) + " is not a number: " + quote(text));
    return value;
  }
  /// The same, refused unless finite.
  double finite(const char* what) {
    const std::string_view text = token();
    const double value = number(text, what);
    if (!std::isfinite(value)) fail(std::string(what) + " is not finite: " + quote(text));
    return value;
  }

  [[noreturn]] void fail(const std::string& what) const { fail_at(line_, what); }
  [[noreturn]] void fail_at(std::size_t line, const std::string& what) const {
    throw InputError(file_ + ":" + std::to_string(line) + ": " + what);
  }

 private:
  static bool is_blank(char c) {
    return c == ' ' || c == '\n' || c == '\t' || c == '\r' || c == '\f' || c == '\v';
  }
  void skip_line_end() {
    if (*at_ == '\r' && at_ + 1 != end_ && at_[1] == '\n') ++at_;
    ++at_;
    ++line_;
  }

  const char* at_;
  const char* end_;
  const char* start_ = at_;
  std::size_t line_ = 1;
  std::string file_;
  bool comments_;
  bool continuations_;
};

}  // namespace onmesh
