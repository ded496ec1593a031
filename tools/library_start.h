// What goes wrong before main() begins.
#pragma once

namespace onmesh::tools {

/// Libraries that images need run code of their own before main(), such as starting threads, and
/// end the program by abort() where a limit forbids that. Until this is called, such an end is one
/// line on stderr and exit code 3. To be called first in main().
void end_library_start();

}  // namespace onmesh::tools
