// Where the results of filter and fill go.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arguments.h"
#include "filtered_channels.h"
#include "interruption.h"
#include "messages.h"
#include "onmesh/base/atomic_file.h"
#include "output_names.h"
#include "stopwatch.h"
#include "surface_inputs.h"

namespace onmesh::tools {

/// Everything that a run writes: results, and what they lack if that was asked for. Folders that
/// are made for it are removed again unless write() came to its end.
class Destination {
 public:
  /// Writing over a texture is fine (it is replaced at the end), over the mesh never.
  /// \param output empty: nothing is written
  /// \throw UsageError, FileError, InputError for what could not be written later
  Destination(const Arguments& arguments, const std::string& output, const SurfaceInputs& inputs);

  /// \param inputs receive warnings
  void write(const std::vector<Image>& results, SurfaceInputs& inputs);

  /// Where the result of a texture goes; empty if it is not written.
  std::string path_of(std::size_t texture) const;
  /// A glTF file with its images replaced.
  bool is_gltf() const;

 private:
  void check(const SurfaceInputs& inputs) const;
  std::vector<Image> details_of(const std::vector<Image>& results,
                                const SurfaceInputs& inputs) const;

  std::string output_;
  OutputNames results_, details_;
  std::optional<AtomicFolder> folder_, details_folder_;
};

/// Let work(progress) make the images of what is filtered, per map that is and its textures, and
/// write them. Where no
/// texel of a glTF file can change, it is written as it is. The inputs' warnings and stages, the
/// report's own and those of writing are told together in the end: in inputs.warnings and
/// report.stages.
/// \return the results, per texture
template <class Report, class Work>
std::vector<Image> make_and_write(SurfaceInputs& inputs, Destination& to, bool quiet,
                                  Stopwatch& watch, Report& report, const Work& work) {
  std::vector<Image> results;
  if (std::string why = why_nothing(inputs, to.is_gltf()); !why.empty()) {
    inputs.warnings.push_back(std::move(why));
    results = inputs.images;
  } else {
    ProgressBar bar(quiet);
    results = inputs.whole_images(working_on(inputs, [&] { return work(bar.callback()); }));
  }
  watch.lap();
  check_interrupted();
  add_warnings(report.warnings, inputs.warnings);
  to.write(results, inputs);
  report.stages.insert(report.stages.begin(), inputs.stages.begin(), inputs.stages.end());
  report.stages.push_back(stage("write texture", watch));
  if (!quiet) warn(inputs.warnings);
  return results;
}

/// The beginning of a command's JSON report: options, mesh, textures with what was assumed of them.
nlohmann::json start_report(const char* command, const Arguments& arguments,
                            const SurfaceInputs& inputs, const Destination& to);

}  // namespace onmesh::tools
