#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "layout/include_rules.h"
#include "support/paths.h"
#include "support/temp_folder.h"

namespace onmesh {
namespace {

using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

std::vector<FolderRule> folder_table() {
  return read_folder_table(source_folder() / "lib" / "README.md");
}

std::vector<std::string> public_headers() {
  std::ifstream file(build_folder() / "public_headers.txt");
  std::vector<std::string> names;
  for (std::string name; std::getline(file, name);) names.push_back(name);
  return names;
}

void report(const std::vector<std::string>& broken) {
  for (const std::string& message : broken) FAIL_CHECK(message);
}

// A small library with a table of its own, so that what is planted in it is all there is.
class PlantedLibrary {
 public:
  PlantedLibrary() {
    files_.file("lib/README.md",
                "# Library\n\n"
                "| level | folder | one sentence | may include |\n"
                "|---|---|---|---|\n"
                "| 1 | `base/` | errors and numbers | - |\n"
                "| 2 | `mesh/` | a mesh as arrays; no files | - |\n"
                "| 3 | `nodes/` (`sizes/`) | points that distances run between | mesh |\n\n"
                "| 9 | another table |\n");
    files_.file("lib/onmesh/base/error.h", "#pragma once\n#include <string>\n");
    files_.file("lib/onmesh/mesh/mesh.h", "#include \"onmesh/base/error.h\"\n");
    files_.file("lib/onmesh/nodes/sizes/size.cpp",
                "#include <vector>\n\n#include \"onmesh/nodes/sizes/size.h\"\n"
                "#include \"onmesh/mesh/mesh.h\"\n");
  }
  void plant(const std::string& name, const std::string& content) { files_.file(name, content); }

  std::vector<FolderRule> table() const {
    return read_folder_table(files_.path() / "lib" / "README.md");
  }
  std::vector<std::string> broken() const { return broken_includes(files_.path(), table()); }
  std::vector<std::string> broken_public(const std::vector<std::string>& headers) const {
    return broken_public_headers(files_.path(), headers);
  }

 private:
  TempFolder files_;
};

}  // namespace

TEST_CASE("includes go one way", "[layout]") {
  REQUIRE(folder_table().size() > 10);
  report(broken_includes(source_folder(), folder_table()));
}

TEST_CASE("the folder table says what CMake says", "[layout]") {
  std::vector<FolderRule> table = folder_table();
  std::vector<FolderRule> built = read_folder_uses(build_folder() / "folder_uses.txt");
  const auto by_name = [](const FolderRule& a, const FolderRule& b) { return a.folder < b.folder; };
  std::sort(table.begin(), table.end(), by_name);
  std::sort(built.begin(), built.end(), by_name);
  REQUIRE(table.size() == built.size());
  for (std::size_t i = 0; i < table.size(); ++i) {
    REQUIRE(table[i].folder == built[i].folder);
    INFO(table[i].folder);
    CHECK(table[i].uses == built[i].uses);
  }
}

TEST_CASE("a folder of lib/onmesh uses only folders of lower levels", "[layout]") {
  const std::vector<FolderRule> table = folder_table();
  CHECK(std::is_sorted(table.begin(), table.end(),
                       [](const FolderRule& a, const FolderRule& b) { return a.level < b.level; }));
  for (const FolderRule& rule : table) {
    INFO(rule.folder);
    CHECK(!rule.sentence.empty());
    for (const std::string& use : rule.uses) {
      INFO("uses " << use);
      const auto used = std::find_if(table.begin(), table.end(),
                                     [&](const FolderRule& r) { return r.folder == use; });
      REQUIRE(used != table.end());
      CHECK(used->level < rule.level);
    }
  }
}

TEST_CASE("public headers include only what is installed or public itself", "[layout]") {
  REQUIRE(public_headers().size() > 20);
  report(broken_public_headers(source_folder(), public_headers()));
}

TEST_CASE("a planted include that goes back up is reported with file, line and rule", "[layout]") {
  PlantedLibrary library;
  REQUIRE(library.table().size() == 3);
  CHECK(library.broken().empty());

  library.plant("lib/onmesh/mesh/upwards.cpp",
                "// Looks up.\n#include \"onmesh/mesh/mesh.h\"\n"
                "  #  include \"onmesh/nodes/node.h\"  // wrong\n");
  const std::vector<std::string> broken = library.broken();
  REQUIRE(broken.size() == 1);
  CHECK_THAT(broken[0], StartsWith("lib/onmesh/mesh/upwards.cpp:3: includes "
                                   "\"onmesh/nodes/node.h\" of level 3"));
  CHECK_THAT(broken[0], Contains("mesh/ (a mesh as arrays; no files) may include base"));
}

TEST_CASE("files and includes outside the folders of the table are reported", "[layout]") {
  const auto [name, content, message] = GENERATE(table<const char*, const char*, const char*>({
      {"lib/onmesh/stray.h", "", "lib/onmesh/stray.h: lies in no folder"},
      {"lib/onmesh/extra/file.h", "", "lib/onmesh/extra/file.h: its folder is not in the table"},
      {"lib/onmesh/base/a.cpp", "\n#include \"error.h\"\n", "lib/onmesh/base/a.cpp:2: write"},
      {"lib/onmesh/base/a.cpp", "#include \"onmesh/mesh/mesh.h\"\n", "nothing but itself"},
      {"lib/onmesh/nodes/a.h", "#include \"onmesh/lost/a.h\"\n", "of an unknown folder"},
      {"lib/onmesh/nodes/simd.cpp", "#define HWY_TARGET_INCLUDE \"onmesh/simd.cpp\"\n",
       "simd.cpp:1: HWY_TARGET_INCLUDE names onmesh/simd.cpp, not its own file"},
  }));
  PlantedLibrary library;
  library.plant(name, content);
  const std::vector<std::string> broken = library.broken();
  REQUIRE(broken.size() == 1);
  CHECK_THAT(broken[0], Contains(message));
}

TEST_CASE("a public header that needs a private one or another library is reported", "[layout]") {
  PlantedLibrary library;
  library.plant("lib/onmesh/nodes/open.h",
                "#include <vector>\n#include <Eigen/Core>\n#include \"onmesh/mesh/mesh.h\"\n");
  library.plant("lib/onmesh/nodes/tied.h", "#include <hwy/highway.h>\n");
  CHECK(library.broken_public({"onmesh/nodes/open.h", "onmesh/mesh/mesh.h", "onmesh/base/error.h"})
            .empty());

  const std::vector<std::string> broken =
      library.broken_public({"onmesh/nodes/open.h", "onmesh/nodes/tied.h"});
  REQUIRE(broken.size() == 2);
  CHECK_THAT(broken[0], StartsWith("lib/onmesh/nodes/open.h:3: includes onmesh/mesh/mesh.h"));
  CHECK_THAT(broken[1], StartsWith("lib/onmesh/nodes/tied.h:1: includes hwy/highway.h"));
}

}  // namespace onmesh
