// The part of command.h that talks to the user and the system while a command runs.
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>

#include "command.h"
#include "onmesh/version.h"

namespace onmesh::tools {
namespace {

// Signal handlers can reach nothing but globals.
volatile std::sig_atomic_t received_signal = 0;
std::atomic<bool> bar_is_shown{false};

extern "C" void on_signal(int signal) { received_signal = signal; }

void wipe_bar() {
  if (bar_is_shown.exchange(false)) std::fputs("\r\033[K", stderr);
}

std::string scaled(double value, const char* unit) {
  char text[48];
  std::snprintf(text, sizeof text,
                value < 10    ? "%.2f %s"
                : value < 100 ? "%.1f %s"
                              : "%.0f %s",
                value, unit);
  return text;
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

void install_signal_handlers() {
  struct sigaction action = {};
  action.sa_handler = on_signal;
  action.sa_flags =
      SA_RESTART | SA_RESETHAND;  // files in flight go on; a second signal ends at once
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

int interrupted() { return received_signal; }

void check_interrupted() {
  if (received_signal != 0) throw Interrupted{received_signal};
}

nlohmann::json new_report(const std::string& command) {
  return {{"onmesh", onmesh::version()}, {"command", command}};
}

void print_report(nlohmann::json report) {
  report["peak_memory_bytes"] = peak_memory_bytes();
  // Paths need not be UTF-8; what is not is replaced instead of refused.
  std::cout << report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << std::endl;
  if (!std::cout) throw FileError("standard output: cannot write the report");
}

std::uint64_t peak_memory_bytes() {
  struct rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return std::uint64_t(usage.ru_maxrss) * 1024;
}

std::string format_seconds(double seconds) {
  if (seconds >= 120) return scaled(seconds / 60, "min");
  return seconds >= 1 ? scaled(seconds, "s") : scaled(seconds * 1000, "ms");
}

std::string format_bytes(std::uint64_t bytes) {
  const char* const units[] = {"B", "KB", "MB", "GB", "TB"};
  int unit = 0;
  double value = double(bytes);
  while (value >= 1000 && unit < 4) value /= 1000, ++unit;
  return unit == 0 ? std::to_string(bytes) + " B" : scaled(value, units[unit]);
}

std::string format_count(std::uint64_t count) {
  std::string digits = std::to_string(count);
  for (std::size_t i = digits.size(); i > 3; i -= 3) digits.insert(i - 3, 1, ',');
  return digits;
}

}  // namespace onmesh::tools
