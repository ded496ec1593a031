// A cursor over a text file, token by token and line by line: what the text readers share.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace onmesh {

/// A piece of a file for an error message: short, printable, on one line.
std::string quote(std::string_view text);

/// The value of a numeric token, independent of the locale; not finite for "nan", "inf", overflow
/// and the "1.#QNAN" of old C libraries. A number too small for a double is 0.
/// \return false if the token is no number
bool parse_number(std::string_view token, double& value);

/// What a format's lines may hold besides tokens.
enum class Syntax {
  plain,
  comments,                ///< a '#' at the start of a token ends the line
  comments_continuations,  ///< and a backslash before the line's end joins it with the next
};

/// Lines end with LF, CR LF or CR. Tokens are separated by blanks.
class TextScan {
 public:
  /// \param text must outlive the scan; a byte order mark of UTF-8 at its start is skipped
  /// \param file the name that error messages begin with
  TextScan(std::string_view text, std::string file, Syntax syntax);

  bool at_end() const { return at_ == end_; }
  std::size_t remaining() const { return static_cast<std::size_t>(end_ - at_); }  ///< bytes
  std::size_t line() const { return line_; }                                      ///< from 1
  const char* position() const { return at_; }
  void set_line(std::size_t line) { line_ = line; }

  /// Go to the line's next token.
  /// \return false at the line's end
  bool skip_blank();

  /// The next token of this line; empty at the line's end.
  std::string_view token();

  /// The next token of this or a later line; empty at the file's end.
  std::string_view token_anywhere();

  /// What is left of this line without blanks at its ends; comments and continuations count as
  /// text.
  std::string_view rest_of_line();

  /// Skip the rest of this line and the lines that continue it. A comment is not continued: it may
  /// well end with a Windows path.
  void next_line();

  /// The number that comes next on this line; may be NaN or infinite.
  /// \param what names the number in error messages
  /// \throw InputError if it is missing or is no number
  double number(const char* what) { return number(token(), what); }
  /// The same of a token that was taken already.
  double number(std::string_view text, const char* what) const;
  /// The number that comes next on this line.
  /// \param token if given, receives the number as the text has it
  /// \throw InputError also if it is not finite
  double finite(const char* what, std::string_view* token = nullptr);

  /// \throw InputError naming the file and the current line
  [[noreturn]] void fail(const std::string& what) const { fail_at(line_, what); }
  /// \throw InputError naming the file and that line
  [[noreturn]] void fail_at(std::size_t line, const std::string& what) const;

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

// These two take most of the time of reading.

inline bool TextScan::skip_blank() {
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

inline std::string_view TextScan::token() {
  if (!skip_blank()) return {};
  const char* const begin = at_;
  while (at_ != end_ && !is_blank(*at_)) ++at_;
  // A continuation may follow a token without a space.
  if (continuations_ && at_ != end_ && (*at_ == '\n' || *at_ == '\r') && at_ - begin > 1 &&
      at_[-1] == '\\')
    --at_;
  return {begin, static_cast<std::size_t>(at_ - begin)};
}

}  // namespace onmesh
