#include "messages.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <mutex>

#include "interruption.h"
#include "onmesh/image/image_io.h"

namespace onmesh::tools {
namespace {

// Warnings have to wipe a bar that another place shows.
std::atomic<bool> bar_is_shown{false};

// The process has one stderr.
struct Silence {
  std::mutex mutex;
  int users = 0;
  int before = -1;  // where stderr went; -1 = it still goes there
};
Silence silence;

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

QuietLibraries::QuietLibraries() {
  const std::lock_guard lock(silence.mutex);
  if (silence.users++ > 0) return;
  std::fflush(stderr);
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (nowhere < 0) return;
  silence.before = ::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
  if (silence.before >= 0) {
    say_signals_to(silence.before);
    ::dup2(nowhere, STDERR_FILENO);
  }
  ::close(nowhere);
}

QuietLibraries::~QuietLibraries() {
  const std::lock_guard lock(silence.mutex);
  if (--silence.users > 0 || silence.before < 0) return;
  std::fflush(stderr);
  ::dup2(silence.before, STDERR_FILENO);
  say_signals_to(STDERR_FILENO);
  ::close(silence.before);
  silence.before = -1;
}

Image read_texture(const std::filesystem::path& path, std::vector<std::string>& warnings) {
  const QuietLibraries quiet;
  return read_image(path, &warnings);
}

Image read_texture(const std::filesystem::path& path) {
  std::vector<std::string> warnings;
  Image image = read_texture(path, warnings);
  warn(warnings);
  return image;
}

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
