#include "interruption.h"

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <mutex>
#include <system_error>
#include <thread>

#include "onmesh/base/atomic_file.h"

namespace onmesh::tools {
namespace {

constexpr std::chrono::milliseconds kPatience(800);

// Signals reach nothing but globals. Trivial ones, as the thread may outlive main().
std::atomic<int> received_signal = 0;
std::atomic<int> message_file = STDERR_FILENO;
std::mutex name_mutex;
char program_name[64] = "onmesh";

extern "C" void on_signal(int signal) { received_signal = signal; }

bool is_ignored(int signal) {
  struct sigaction action {};
  return sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

/// The end of a program whose work does not stop by itself.
[[noreturn]] void end_at_once(int signal) {
  remove_temporaries();
  {
    const std::lock_guard lock(name_mutex);
    ::dprintf(message_file, "%s: %s\n", program_name, signal_word(signal));
  }
  ::_exit(128 + signal);
}

void wait_for_signals(sigset_t signals) {
  int signal = 0;
  while (sigwait(&signals, &signal) != 0) {
  }
  received_signal = signal;
  // A second signal need not wait.
  const timespec patience{0, std::chrono::nanoseconds(kPatience).count()};
  sigtimedwait(&signals, nullptr, &patience);
  end_at_once(signal);
}

}  // namespace

void install_signal_handling() {
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) {
    if (!is_ignored(signal)) sigaddset(&signals, signal);
  }
  // All threads that come later have the mask of this one.
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  try {
    std::thread(wait_for_signals, signals).detach();
  } catch (const std::system_error&) {
    // No thread may be had: the work stops at its next look, or not at all.
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) {
      if (sigismember(&signals, signal) == 1) std::signal(signal, on_signal);
    }
    pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
  }
}

void set_program_name(const std::string& name) {
  const std::lock_guard lock(name_mutex);
  std::snprintf(program_name, sizeof program_name, "%s", name.c_str());
}

void say_signals_to(int file) { message_file = file; }

void check_interrupted() {
  if (const int signal = received_signal; signal != 0) throw Interrupted{signal};
}

const char* signal_word(int signal) {
  switch (signal) {
    case SIGINT:
      return "interrupted";
    case SIGHUP:
      return "hung up";
    case SIGQUIT:
      return "quit";
    default:
      return "terminated";
  }
}

}  // namespace onmesh::tools
