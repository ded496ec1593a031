// onmesh filter --report page.html.
#pragma once

#include "../arguments.h"
#include "../destination.h"
#include "../surface_inputs.h"
#include "onmesh/filter/report.h"

namespace onmesh::tools {

/// The page of a run that is over: textures before and after, what was asked for and what was
/// found. \param results per texture of the inputs \param seconds for all of it \throw FileError if
/// it cannot be written
void write_filter_page(const std::string& path, const Arguments& arguments,
                       const SurfaceInputs& inputs, const Destination& to,
                       std::vector<Image> results, const FilterReport& report, double seconds);

}  // namespace onmesh::tools
