#include "onmesh/filter/stages.h"

#include <catch2/catch.hpp>
#include <chrono>
#include <thread>
#include <utility>

namespace onmesh {
namespace {

TEST_CASE("stages are timed one by one and announced from 0 to 1", "[stages]") {
  FilterReport report;
  std::vector<std::pair<std::string, double>> told;
  const Progress progress = [&](std::string_view stage, double done) {
    told.emplace_back(stage, done);
  };
  Stages stages(report.stages, progress);
  stages.begin("long");
  std::this_thread::sleep_for(std::chrono::milliseconds(30));
  stages.advance(0.5);
  stages.end();
  stages.begin("short");
  stages.end();
  using Told = std::vector<std::pair<std::string, double>>;
  CHECK(told == Told{{"long", 0}, {"long", 0.5}, {"long", 1}, {"short", 0}, {"short", 1}});
  REQUIRE(report.stages.size() == 2);
  CHECK(report.stages[0].stage == "long");
  CHECK(report.stages[0].seconds >= 0.03);
  CHECK(report.stages[1].seconds < report.stages[0].seconds);
  CHECK(report.stages[1].peak_memory_bytes >= report.stages[0].peak_memory_bytes);
  CHECK(report.stages[0].peak_memory_bytes > 1'000'000);
}

TEST_CASE("stages without a listener are timed alike", "[stages]") {
  FilterReport report;
  const Progress nobody;
  Stages stages(report.stages, nobody);
  stages.begin("alone");
  stages.advance(0.5);
  stages.end();
  CHECK(report.stages.size() == 1);
}

}  // namespace
}  // namespace onmesh
