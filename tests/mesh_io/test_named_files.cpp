#include "onmesh/mesh_io/named_files.h"

#include <catch2/catch.hpp>
#include <filesystem>

#include "onmesh/base/error.h"
#include "support/temp_folder.h"

namespace onmesh {
namespace {

namespace fs = std::filesystem;
using Catch::Contains;

/// A mesh in a folder with others around it.
///
///   out.png            beside the mesh's folder
///   model/m.obj        the mesh
///   model/a.png, model/sub/b.png, model/sub/only.png, model/x\y.png
struct Places {
  Places() {
    for (const char* name : {"out.png", "model/m.obj", "model/a.png", "model/sub/b.png",
                             "model/sub/m.mtl", "model/sub/only.png", "model/x\\y.png"}) {
      fs::create_directories((folder.path() / name).parent_path());
      folder.file(name, "");
    }
  }
  fs::path operator/(const std::string& name) const { return folder.path() / name; }
  /// What the name leads to from a file of the model's folder, without that folder.
  std::string find(const std::string& name, const std::string& from = "m.obj",
                   const ReadOptions& options = {}) {
    report = {};
    NamedFiles files(*this / "model/m.obj", options, report);
    const auto found = files.find({name}, *this / "model" / from);
    return found ? found->lexically_relative(*this / "model").string() : "nothing";
  }
  TempFolder folder;
  ReadReport report;
};

TEST_CASE("names are looked for where they say, then by their last part beside the files",
          "[named_files]") {
  Places places;
  struct Case {
    const char *name, *from, *found;
    bool is_assumed;
  };
  for (const Case& c : {Case{"a.png", "m.obj", "a.png", false},
                        {"./a.png", "m.obj", "a.png", false},
                        {"\"a.png\"", "m.obj", "a.png", false},
                        {"sub/b.png", "m.obj", "sub/b.png", false},
                        {"sub\\b.png", "m.obj", "sub/b.png", false},
                        {"sub//..\\sub/b.png", "m.obj", "sub/b.png", false},
                        {"x\\y.png", "m.obj", "x\\y.png", false},
                        {"b.png", "sub/m.mtl", "sub/b.png", false},
                        {"../a.png", "sub/m.mtl", "a.png", false},
                        {"textures/a.png", "m.obj", "a.png", true},
                        {"a.png", "sub/m.mtl", "a.png", true},
                        {"sub/b.png", "sub/m.mtl", "sub/b.png", true},
                        {"C:\\Users\\me\\a.png", "m.obj", "a.png", true},
                        {"c:/a.png", "m.obj", "a.png", true},
                        {"C:a.png", "m.obj", "a.png", true},
                        {"\\\\server\\share\\a.png", "m.obj", "a.png", true},
                        {"//server/a.png", "m.obj", "a.png", true},
                        {"http://host/a.png", "m.obj", "a.png", true},
                        {"file:///home/me/a.png", "m.obj", "a.png", true},
                        {"/home/me/a.png", "m.obj", "a.png", true},
                        {"only.png", "m.obj", "nothing", false},
                        {"~/a.png", "m.obj", "a.png", true},
                        {"$HOME", "m.obj", "nothing", false},
                        {"a%2Epng", "m.obj", "nothing", false},
                        {"sub", "m.obj", "nothing", false},
                        {"", "m.obj", "nothing", false},
                        {"/", "m.obj", "nothing", false},
                        {"..", "m.obj", "nothing", false}}) {
    INFO(c.name);
    CHECK(places.find(c.name, c.from) == c.found);
    CHECK(places.report.warnings.empty());
    CHECK(places.report.assumed.size() == (c.is_assumed ? 1U : 0U));
  }
  CHECK(places.find(std::string("a.png\0b", 7)) == "nothing");
}

TEST_CASE("absolute paths and URLs are never followed", "[named_files]") {
  Places places;
  const std::string absolute = (places / "out.png").string();
  for (const std::string& name : {absolute, "file://" + absolute, "//" + absolute}) {
    INFO(name);
    CHECK(places.find(name) == "nothing");
    // Not in the path for the message either.
    NamedFiles files(places / "model/m.obj", {}, places.report);
    CHECK(files.path_of({name}, places / "model/m.obj") == (places / "model/out.png").string());
  }
}

TEST_CASE("what lies outside the mesh's folder is read with a warning, or refused if confined",
          "[named_files]") {
  Places places;
  ReadOptions confined;
  confined.confine = true;
  CHECK(places.find("../out.png") == "../out.png");
  REQUIRE(places.report.warnings.size() == 1);
  CHECK_THAT(places.report.warnings[0],
             Contains("m.obj: '../out.png' lies outside the mesh's folder"));
  CHECK(places.find("../model/a.png", "m.obj", confined) == "a.png");
  CHECK(places.find("../a.png", "sub/m.mtl", confined) == "a.png");
  for (const char* name : {"../out.png", "..\\out.png", "sub/../../out.png", "../not there.png"}) {
    INFO(name);
    CHECK_THROWS_AS(places.find(name, "m.obj", confined), InputError);
  }
  CHECK_THROWS_WITH(places.find("../out.png", "m.obj", confined),
                    Contains("model/m.obj: '../out.png' lies outside the mesh's folder"));
}

TEST_CASE("links that lead out of the mesh's folder are refused only if confined",
          "[named_files]") {
  Places places;
  ReadOptions confined;
  confined.confine = true;
  fs::create_symlink("../out.png", places / "model/link.png");
  fs::create_directory_symlink("..", places / "model/up");
  fs::create_symlink("a.png", places / "model/inner.png");
  for (const char* name : {"link.png", "up/out.png"}) {
    INFO(name);
    CHECK(places.find(name) == name);
    CHECK(places.report.warnings.empty());
    CHECK_THROWS_AS(places.find(name, "m.obj", confined), InputError);
  }
  CHECK(places.find("inner.png", "m.obj", confined) == "inner.png");
  // A mesh that is found over a link is at home there.
  fs::create_directory_symlink(places / "model", places / "linked");
  ReadReport report;
  NamedFiles files(places / "linked/m.obj", confined, report);
  CHECK(files.find({"a.png"}, places / "linked/m.obj") == places / "linked/a.png");
  CHECK_THROWS_AS(files.find({"link.png"}, places / "linked/m.obj"), InputError);
}

TEST_CASE("a name in the other case of letters is taken if only one file fits", "[named_files]") {
  Places places;
  for (const char* name : {"A.PNG", "SUB/B.png", "C:\\TEXTURES\\A.png", "Sub/../A.png"}) {
    INFO(name);
    const std::string found = places.find(name);
    CHECK(found != "nothing");
    REQUIRE(places.report.warnings.size() == 1);
    CHECK_THAT(places.report.warnings[0],
               Contains("differs in the case of letters") && Contains(found));
  }
  places.folder.file("model/A.png", "");
  CHECK(places.find("A.png") == "A.png");
  CHECK(places.report.warnings.empty());
  CHECK(places.find("a.PNG") == "nothing");  // which one?
  // Folders that differ in case only are both looked into.
  fs::create_directories(places / "model/SUB");
  CHECK(places.find("Sub/B.png") == "sub/b.png");
  places.folder.file("model/SUB/b.png", "");
  CHECK(places.find("Sub/B.png") == "nothing");
}

TEST_CASE("the folder that the mesh is in is not looked for in other cases", "[named_files]") {
  Places places;
  fs::create_directories(places / "MODEL");
  places.folder.file("MODEL/a.png", "");
  CHECK(places.find("A.PNG") == "a.png");
}

TEST_CASE("confined names in the other case are not looked for outside", "[named_files]") {
  Places places;
  ReadOptions confined;
  confined.confine = true;
  CHECK_THROWS_AS(places.find("../OUT.png", "m.obj", confined), InputError);
  CHECK(places.find("sub/OUT.png", "m.obj", confined) == "nothing");
}

TEST_CASE("of several readings of a name the first with a file counts", "[named_files]") {
  Places places;
  const fs::path obj = places / "model/m.obj";
  NamedFiles files(obj, {}, places.report);
  const std::vector<std::string> readings = {"a.png # c", "a.png"};
  CHECK(files.find(readings, obj) == places / "model/a.png");
  places.folder.file("model/a.png # c", "");
  NamedFiles again(obj, {}, places.report);
  CHECK(again.find(readings, obj) == places / "model/a.png # c");
  CHECK(again.path_of({"none.png # c", "none.png"}, obj) == (places / "model/none.png").string());
  CHECK(again.path_of({""}, obj).empty());
}

}  // namespace
}  // namespace onmesh
