#include "interruption.h"

#include <csignal>

namespace onmesh::tools {
namespace {

// Signal handlers can reach nothing but globals.
volatile std::sig_atomic_t received_signal = 0;

extern "C" void on_signal(int signal) { received_signal = signal; }

}  // namespace

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

}  // namespace onmesh::tools
