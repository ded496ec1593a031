#include "onmesh/base/text_scan.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "onmesh/base/error.h"

using namespace onmesh;

TEST_CASE("numbers read whatever C libraries write, and nothing else", "[text_scan]") {
  double value = 0;
  for (const auto& [text, expected] :
       {std::pair{"1.5", 1.5}, {"+2", 2.0}, {"-.5e1", -5.0}, {"1e-999", 0.0}, {"0.0000e0", 0.0}}) {
    INFO(text);
    CHECK(parse_number(text, value));
    CHECK(value == expected);
  }
  for (const char* text : {"nan", "inf", "-inf", "1e999", "1.#QNAN", "-1.#IND"}) {
    INFO(text);
    CHECK(parse_number(text, value));
    CHECK_FALSE(std::isfinite(value));
  }
  for (const char* text : {"", "+", "-", "x", "1x", "1,5", "--1", "+-1", "0x10"}) {
    INFO(text);
    CHECK_FALSE(parse_number(text, value));
  }
}

TEST_CASE("tokens, comments and continued lines are told apart", "[text_scan]") {
  TextScan scan(
      "\xef\xbb\xbf"
      "a b#c # d\r\n e \\\r\n f\\\ng\n\nh",
      "m", Syntax::comments_continuations);
  CHECK(scan.token() == "a");
  CHECK(scan.token() == "b#c");  // a comment begins a token
  CHECK(scan.token().empty());
  scan.next_line();
  CHECK(scan.line() == 2);
  for (const char* token : {"e", "f", "g"}) CHECK(scan.token() == token);
  CHECK(scan.line() == 4);
  CHECK(scan.token().empty());
  CHECK(scan.token_anywhere() == "h");
  CHECK(scan.line() == 6);
  CHECK(scan.at_end());
  CHECK(scan.token_anywhere().empty());

  TextScan plain("# \\\nx", "m", Syntax::plain);
  CHECK(plain.token() == "#");
  CHECK(plain.token() == "\\");
  plain.next_line();
  CHECK(plain.rest_of_line() == "x");
}

TEST_CASE("what does not read is named with file and line", "[text_scan]") {
  const auto error = [](const char* text) -> std::string {
    try {
      TextScan scan(text, "file", Syntax::plain);
      scan.next_line();
      scan.finite("length");
    } catch (const InputError& e) {
      return e.what();
    }
    return "no error";
  };
  CHECK(error("\n1") == "no error");
  CHECK(error("\n") == "file:2: length is missing");
  CHECK(error("\none") == "file:2: length is not a number: 'one'");
  CHECK(error("\ninf") == "file:2: length is not finite: 'inf'");
  CHECK(quote("a\tb") == "'a?b'");
  CHECK(quote(std::string(50, 'x')) == "'" + std::string(40, 'x') + "...'");
}
