#include "onmesh/base/text_scan.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "onmesh/base/error.h"

namespace onmesh {

std::string quote(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  std::string result = "'";
  for (const char c : text.substr(0, kLongest)) {
    result += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
  }
  return result + (text.size() > kLongest ? "...'" : "'");
}

bool parse_number(std::string_view token, double& value) {
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

TextScan::TextScan(std::string_view text, std::string file, Syntax syntax)
    : at_(text.data()),
      end_(at_ + text.size()),
      file_(std::move(file)),
      comments_(syntax != Syntax::plain),
      continuations_(syntax == Syntax::comments_continuations) {
  if (text.starts_with("\xef\xbb\xbf")) at_ += 3;  // UTF-8 byte order mark
}

std::string_view TextScan::token_anywhere() {
  while (!skip_blank()) {
    if (at_end()) return {};
    next_line();
  }
  return token();
}

std::string_view TextScan::rest_of_line() {
  while (at_ != end_ && (*at_ == ' ' || *at_ == '\t')) ++at_;
  const char* const begin = at_;
  while (at_ != end_ && *at_ != '\n' && *at_ != '\r') ++at_;
  const char* last = at_;
  while (last != begin && (last[-1] == ' ' || last[-1] == '\t')) --last;
  return {begin, static_cast<std::size_t>(last - begin)};
}

void TextScan::next_line() {
  const bool comment = !skip_blank() && at_ != end_ && *at_ == '#';
  for (;;) {
    while (at_ != end_ && *at_ != '\n' && *at_ != '\r') ++at_;
    if (at_ == end_) return;
    const bool continued = continuations_ && !comment && at_ != start_ && at_[-1] == '\\';
    skip_line_end();
    if (!continued) return;
  }
}

double TextScan::number(std::string_view text, const char* what) const {
  double value = 0;
  if (text.empty()) fail(std::string(what) + " is missing");
  if (!parse_number(text, value)) fail(std::string(what) + " is not a number: " + quote(text));
  return value;
}

double TextScan::finite(const char* what, std::string_view* token) {
  const std::string_view text = this->token();
  if (token != nullptr) *token = text;
  const double value = number(text, what);
  if (!std::isfinite(value)) fail(std::string(what) + " is not finite: " + quote(text));
  return value;
}

void TextScan::fail_at(std::size_t line, const std::string& what) const {
  throw InputError(file_ + ":" + std::to_string(line) + ": " + what);
}

}  // namespace onmesh
