#include "onmesh/mesh_io/gltf/json_text.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>

namespace onmesh {

TEST_CASE("a JSON text without changes keeps its bytes", "[json_text]") {
  const std::string text = "\xEF\xBB\xBF {\n\t\"a\" : [ { } ],\r\n \"b\":1.50e+00 }\n\n";
  CHECK(JsonText(text).edited() == text);
}

TEST_CASE("a member's value changes and nothing around it", "[json_text]") {
  const std::string text =
      R"({ "l": [ 7, {"x" : "}]\\\"", "y": {"x": [1, {"y": 0}]}, "z":null} ] })";
  JsonText json(text);
  const auto object = json.element("l", 1);
  json.set(object, "y", 5);
  json.set(object, "x", "a\"b");
  json.set(object, "z", {1, 2});
  CHECK(json.edited() == R"({ "l": [ 7, {"x" : "a\"b", "y": 5, "z":[1,2]} ] })");
  json.set(object, "y", 6);  // the last change counts
  CHECK(json.edited() == R"({ "l": [ 7, {"x" : "a\"b", "y": 6, "z":[1,2]} ] })");
}

TEST_CASE("a new member looks like those that are there", "[json_text]") {
  const std::string text = "{\"l\": [\n  {\n    \"a\": 1\n  }\n]}";
  JsonText json(text);
  json.set(json.element("l", 0), "b", 2);
  json.set(json.element("l", 0), "c", 3);
  CHECK(json.edited() == "{\"l\": [\n  {\n    \"b\": 2,\n    \"c\": 3,\n    \"a\": 1\n  }\n]}");
}

TEST_CASE("members are found as a JSON reader finds them", "[json_text]") {
  // By what escapes stand for, and the last one of a name.
  const std::string text =
      R"({"l":[{"a":0}],"\u006c":[{"o":{"a":1},"\u006f":{"\u0061":2}},{"a":3}]})";
  JsonText json(text);
  json.set(json.object(json.element("l", 0), "o"), "a", -2);
  json.set(json.element("l", 1), "a", -3);
  CHECK(json.edited() ==
        R"({"l":[{"a":0}],"\u006c":[{"o":{"a":1},"\u006f":{"\u0061":-2}},{"a":-3}]})");
  CHECK(nlohmann::json::parse(json.edited())["l"][0]["o"]["a"] == -2);
}

}  // namespace onmesh
