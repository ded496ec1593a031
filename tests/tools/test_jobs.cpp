#include "viewer/server/jobs.h"

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <stdexcept>
#include <thread>

using namespace onmesh::tools;

namespace {

/// Goes on until it is cancelled.
std::string work_forever(const onmesh::Progress& progress) {
  for (;;) {
    progress("forever", 0.5);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

int begin(Jobs& jobs, const std::string& kind, bool is_replaceable, Jobs::Work work) {
  Job busy;
  const auto number = jobs.start(kind, is_replaceable, std::move(work), busy);
  return number ? *number : -1;
}

}  // namespace

TEST_CASE("a job's result is kept, a failed one tells why") {
  Jobs jobs;
  const int good = begin(jobs, "run", false, [](auto&) { return "result"; });
  CHECK(*jobs.wait(good)->result == "result");
  const int bad = begin(jobs, "other", false,
                        [](auto&) -> std::string { throw std::runtime_error("a reason"); });
  const auto failed = jobs.wait(bad);
  CHECK(failed->state == JobState::failed);
  CHECK(failed->message == "a reason");
  CHECK(failed->result == nullptr);
  CHECK(*jobs.last("run")->result == "result");
  CHECK(jobs.last()->number == bad);
  CHECK_FALSE(jobs.wait(99));
}

TEST_CASE("a second job is refused while one runs, until that is cancelled") {
  Jobs jobs;
  const int first = begin(jobs, "run", false, work_forever);
  Job busy;
  CHECK_FALSE(jobs.start("preview", true, work_forever, busy));
  CHECK(busy.kind == "run");
  CHECK_FALSE(jobs.start("run", false, work_forever, busy));
  CHECK(jobs.cancel());
  CHECK(jobs.wait(first)->state == JobState::cancelled);
  const int next = begin(jobs, "preview", true, [](auto&) { return "x"; });
  CHECK(jobs.wait(next)->state == JobState::done);
  CHECK_FALSE(jobs.cancel());
}

TEST_CASE("a newer preview takes the place of those before") {
  Jobs jobs;
  const int first = begin(jobs, "preview", true, work_forever);
  const int second = begin(jobs, "preview", true, work_forever);
  const int third = begin(jobs, "preview", true, [](auto&) { return "third"; });
  REQUIRE(third > second);
  const auto last = jobs.wait(third);
  REQUIRE(last->state == JobState::done);
  CHECK(*last->result == "third");
  for (const int number : {first, second}) {
    const auto before = jobs.wait(number);
    CHECK((!before || before->state == JobState::cancelled));
  }
}

TEST_CASE("the end cancels what runs and lets nobody wait") {
  Jobs jobs;
  const int number = begin(jobs, "run", false, work_forever);
  std::thread waiting([&] { jobs.wait(number); });
  jobs.end();
  waiting.join();
}
