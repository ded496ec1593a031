// The comparison as text, CSV, Markdown and plots.
#pragma once

#include <string>
#include <vector>

#include "backends/measure.h"

namespace onmesh::compare {

/// One line of the table on the terminal, and the lines above the first.
std::string text_header();
std::string text_line(const Row& row);

/// One line per row; a number that was not measured is left empty, and so are all of a row that was
/// skipped, whose last field says why.
std::string csv(const std::vector<Row>& rows);

/// Two tables: accuracy per mesh at the middle kernel size, and cost (medians over the meshes) per
/// kernel size.
std::string markdown(const std::vector<Row>& rows);

/// Writes backend-errors.svg, backend-psnr.svg and backend-times.svg into the folder.
/// \throw FileError
void write_plots(const std::string& folder, const std::vector<Row>& rows);

}  // namespace onmesh::compare
