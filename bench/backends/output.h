// The comparison as text, CSV and Markdown.
#pragma once

#include <string>
#include <vector>

#include "backends/measure.h"

namespace onmesh::bench {

/// One line of the table on the terminal, and the lines above the first.
std::string text_header();
std::string text_line(const Row& row);

/// One line per row; a number that was not measured is left empty, and so are all of a row that was
/// skipped, whose last field says why.
std::string csv(const std::vector<Row>& rows);

/// Two tables: accuracy per mesh at the middle kernel size, and cost (medians over the meshes) per
/// kernel size.
std::string markdown(const std::vector<Row>& rows);

}  // namespace onmesh::bench
