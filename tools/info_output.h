// What onmesh info says: as JSON, and as text for people.
#pragma once

#include "info_findings.h"

namespace onmesh::tools {

void print_json(const InputMesh& input, const Findings& findings);
void print_text(const InputMesh& input, const Findings& findings);

}  // namespace onmesh::tools
