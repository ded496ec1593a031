// What signals do: SIGINT, SIGTERM, SIGHUP and SIGQUIT end the program within a second.
#pragma once

#include <string>

namespace onmesh::tools {

/// Thrown by check_interrupted(); main() turns it into exit code 128 + signal. Not a
/// std::exception, so that nobody takes it for an error of the work it interrupts.
struct Interrupted {
  int signal = 0;
};

/// From now on a thread of its own waits for these signals. The work stops at its next look, and
/// destructors clean up; if there is none within .8 s the thread removes the temporary files, says
/// so, and ends the program itself. Signals that the program was started to ignore stay ignored.
/// Closed pipes and limits on file size are errors of writing, no signals.
/// \pre no other thread runs
void install_signal_handling();
/// What the thread's message begins with.
void set_program_name(const std::string& name);
/// Where the thread's message goes: a file descriptor.
void say_signals_to(int file);
/// \throw Interrupted once a signal came, so that destructors remove temporary files
void check_interrupted();
/// "interrupted", "terminated", ...
const char* signal_word(int signal);

}  // namespace onmesh::tools
