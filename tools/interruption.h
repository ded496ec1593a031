// SIGINT and SIGTERM: the work stops at the next look, and destructors clean up.
#pragma once

namespace onmesh::tools {

/// Thrown by check_interrupted(); main() turns it into exit code 128 + signal. Not a
/// std::exception, so that nobody takes it for an error of the work it interrupts.
struct Interrupted {
  int signal = 0;
};

/// From now on SIGINT and SIGTERM only set a flag; a second signal of the kind ends the program.
void install_signal_handlers();
/// The signal that came, 0 if none.
int interrupted();
/// \throw Interrupted once a signal came, so that destructors remove temporary files
void check_interrupted();

}  // namespace onmesh::tools
