#include "messages.h"

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <iostream>

#include "interruption.h"

namespace onmesh::tools {
namespace {

// Warnings have to wipe a bar that another place shows.
std::atomic<bool> bar_is_shown{false};

void wipe_bar() {
  if (bar_is_shown.exchange(false)) std::fputs("\r\033[K", stderr);
}

}  // namespace

void warn(const std::string& message) {
  std::string line = message;
  for (char& c : line) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  wipe_bar();
  std::cerr << "onmesh: warning: " << line << '\n';
}

void warn(const std::vector<std::string>& messages) {
  for (const std::string& message : messages) warn(message);
}

struct ProgressBar::State {
  using Clock = std::chrono::steady_clock;
  bool visible = false;
  Clock::time_point next = Clock::now();

  void show(std::string_view stage, double done) {
    const auto now = Clock::now();
    if (!visible || now < next) return;
    next = now + std::chrono::milliseconds(100);
    constexpr int kWidth = 30;
    const double share = done >= 0 && done <= 1 ? done : 0;
    std::string bar(std::size_t(share * kWidth), '#');
    bar.resize(kWidth, '.');
    std::fprintf(stderr, "\r\033[K%-12.*s [%s] %3d%%", int(stage.size()), stage.data(), bar.c_str(),
                 int(100 * share));
    std::fflush(stderr);
    bar_is_shown = true;
  }
};

ProgressBar::ProgressBar(bool quiet) : state_(std::make_unique<State>()) {
  state_->visible = !quiet && ::isatty(STDERR_FILENO) == 1;
}

ProgressBar::~ProgressBar() { wipe_bar(); }

Progress ProgressBar::callback() {
  return [state = state_.get()](std::string_view stage, double done) {
    check_interrupted();
    state->show(stage, done);
  };
}

}  // namespace onmesh::tools
