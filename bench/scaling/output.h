// The measurements of the whole filter as Markdown and CSV.
#pragma once

#include <string>

#include "scaling/results.h"

namespace onmesh::bench {

/// One table per family: seconds by method, beside OpenCV's 2D filter, and memory.
std::string summary(const Results& results);

/// One table of all benchmarks: how the time is shared out between the stages, and what the nodes
/// did.
std::string details(const Results& results);

/// What the plots show, one line per point: plot (the family), panel, series (a method or OpenCV),
/// x, seconds.
std::string csv(const Results& results);

/// The text with all between the lines "<!-- scaling: begin -->" and "<!-- scaling: end -->"
/// replaced.
///
/// \throw InputError if they are not there
std::string with_summary(const std::string& text, const std::string& summary);

}  // namespace onmesh::bench
