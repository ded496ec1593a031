// The options of the window's page, read as those of onmesh filter are.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "../../arguments.h"
#include "onmesh/filter/options.h"

namespace onmesh::tools {

/// What a page says of options as words of the command line. Only what says how to filter is taken:
/// no option that names a file.
/// \param options names as in FilterOptions: {"sigma_spatial": "4tx", "guides": ["self:0.1"], ...}
/// \throw UsageError for anything else
std::vector<std::string> words_of(const nlohmann::json& options);

/// The arguments of onmesh filter.
/// \param words without the subcommand
/// \throw UsageError
Arguments filter_arguments(const std::vector<std::string>& words);

/// What lengths in texels and widths in noise are multiples of: of the textures as they are.
struct FullScale {
  double texel_size = 0;  ///< mesh units
  /// The noise of the values that are filtered, by its median or its mean; 0 = not known.
  std::function<double(RangeWidth::Unit)> noise;
};

/// The options with plain numbers, so that they mean the same to textures of another size. Noise of
/// what is no value of its own, or is smoothed before it is compared, stays a multiple.
FilterOptions with_numbers(FilterOptions options, const FullScale& scale);

}  // namespace onmesh::tools
