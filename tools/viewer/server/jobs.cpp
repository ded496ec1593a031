#include "jobs.h"

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <new>
#include <thread>
#include <utility>
#include <vector>

namespace onmesh::tools {
namespace {

/// Thrown by the progress of a job that is cancelled. Not a std::exception, so that nobody takes it
/// for an error of the work.
struct JobCancelled {};

struct Entry {
  Job job;
  Jobs::Work work;
  bool is_replaceable = false;
  bool is_cancelled = false;
};

}  // namespace

struct Jobs::State {
  mutable std::mutex mutex;
  mutable std::condition_variable changed;
  std::vector<std::shared_ptr<Entry>> entries;  ///< the last of each kind, oldest first
  std::shared_ptr<Entry> running, waiting;
  int number = 0;
  bool ends = false;
  std::thread thread;

  void work();
  void run(Entry& entry);
  void forget(const std::string& kind);
};

std::string name_of(JobState state) {
  switch (state) {
    case JobState::waiting:
      return "waiting";
    case JobState::running:
      return "running";
    case JobState::done:
      return "done";
    case JobState::failed:
      return "failed";
    default:
      return "cancelled";
  }
}

/// What is over of that kind.
void Jobs::State::forget(const std::string& kind) {
  std::erase_if(entries,
                [&](const auto& entry) { return entry->job.kind == kind && entry->job.is_over(); });
}

void Jobs::State::work() {
  std::unique_lock lock(mutex);
  for (;;) {
    changed.wait(lock, [&] { return ends || waiting; });
    if (ends) break;
    running = std::exchange(waiting, nullptr);
    forget(running->job.kind);
    running->job.state = JobState::running;
    lock.unlock();
    run(*running);
    lock.lock();
    running = nullptr;
    changed.notify_all();
  }
}

void Jobs::State::run(Entry& entry) {
  const Progress progress = [&](std::string_view stage, double fraction) {
    const std::lock_guard lock(mutex);
    if (entry.is_cancelled || ends) throw JobCancelled{};
    if (entry.job.stage != stage) entry.job.stage = stage;
    entry.job.fraction = fraction;
  };
  JobState state = JobState::done;
  std::shared_ptr<const std::string> result;
  std::string message;
  try {
    progress("start", 0);
    result = std::make_shared<const std::string>(entry.work(progress));
  } catch (const std::bad_alloc&) {
    state = JobState::failed;
    message = "There is not enough memory";
  } catch (const std::exception& error) {
    state = JobState::failed;
    message = error.what();
  } catch (...) {  // it was cancelled, or the program is
    state = JobState::cancelled;
  }
  const std::lock_guard lock(mutex);
  entry.work = nullptr;
  entry.job.state = state;
  entry.job.message = std::move(message);
  entry.job.result = std::move(result);
}

Jobs::Jobs() : state_(std::make_unique<State>()) {
  state_->thread = std::thread([state = state_.get()] { state->work(); });
}

Jobs::~Jobs() {
  end();
  state_->thread.join();
}

std::optional<int> Jobs::start(const std::string& kind, bool is_replaceable, Work work, Job& busy) {
  State& state = *state_;
  const std::lock_guard lock(state.mutex);
  for (const auto& other : {state.running, state.waiting}) {
    if (!other || other->job.is_over()) continue;
    const bool makes_way = is_replaceable && other->is_replaceable && other->job.kind == kind;
    if (makes_way || (other->is_cancelled && !state.waiting)) continue;
    busy = other->job;
    return std::nullopt;
  }
  if (state.running) state.running->is_cancelled = true;
  if (state.waiting) state.waiting->job.state = JobState::cancelled;
  auto entry = std::make_shared<Entry>();
  entry->job.number = ++state.number;
  entry->job.kind = kind;
  entry->work = std::move(work);
  entry->is_replaceable = is_replaceable;
  state.waiting = entry;
  state.entries.push_back(entry);
  state.changed.notify_all();
  return entry->job.number;
}

std::optional<Job> Jobs::last() const {
  const std::lock_guard lock(state_->mutex);
  if (state_->entries.empty()) return std::nullopt;
  return state_->entries.back()->job;
}

std::optional<Job> Jobs::last(const std::string& kind) const {
  const std::lock_guard lock(state_->mutex);
  const auto& entries = state_->entries;
  const auto found = std::find_if(entries.rbegin(), entries.rend(),
                                  [&](const auto& entry) { return entry->job.kind == kind; });
  if (found == entries.rend()) return std::nullopt;
  return (*found)->job;
}

std::optional<Job> Jobs::wait(int number) const {
  std::unique_lock lock(state_->mutex);
  std::shared_ptr<Entry> entry;
  for (const auto& each : state_->entries)
    if (each->job.number == number) entry = each;
  if (!entry) return std::nullopt;
  state_->changed.wait(lock, [&] { return state_->ends || entry->job.is_over(); });
  return entry->job;
}

bool Jobs::cancel() {
  const std::lock_guard lock(state_->mutex);
  const bool is_there = state_->running || state_->waiting;
  if (state_->running) state_->running->is_cancelled = true;
  if (state_->waiting) state_->waiting->job.state = JobState::cancelled;
  state_->waiting = nullptr;
  state_->changed.notify_all();
  return is_there;
}

void Jobs::end() {
  const std::lock_guard lock(state_->mutex);
  state_->ends = true;
  state_->changed.notify_all();
}

}  // namespace onmesh::tools
