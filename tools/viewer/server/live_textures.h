// The textures of the window: as they were read, and reduced for the preview.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "../../surface_inputs.h"
#include "live_options.h"
#include "onmesh/atlas/texel_map.h"
#include "onmesh/base/progress.h"
#include "onmesh/filter/kept_filter.h"

namespace onmesh::tools {

/// Results, one image per texture of the set, and what was done.
struct LiveResult {
  std::vector<Image> images;
  FilterReport report;
};

/// Mesh and textures of one way to read them. One thread at a time.
class LiveTextures {
 public:
  /// Reads the files.
  /// \param words of onmesh filter that say what is read
  /// \throw UsageError, FileError, InputError; UsageError also if there are several maps
  explicit LiveTextures(const std::vector<std::string>& words);

  const SurfaceInputs& inputs() const { return inputs_; }
  double texel_size() const { return texel_size_; }
  double diagonal() const { return inputs_.mesh.diagonal(); }
  const std::vector<Image>& reduced() const { return reduced_; }

  /// Make the reduced textures. \param texels of the full ones, null = not known
  void reduce(const TexelMap* texels);

  /// Filter the reduced textures. \pre reduce()
  /// \throw UsageError, InputError, NumericError
  LiveResult preview(Arguments arguments, const Progress& progress);
  /// Filter the textures, as the command does. The same errors.
  LiveResult run(Arguments arguments, const Progress& progress);
  /// \throw UsageError, FileError, InputError if write() could not write there
  void check_destination(const Arguments& arguments) const;
  /// Write what run() gave, as the command does.
  /// \param arguments with --output
  /// \return what is to be told
  std::vector<std::string> write(const Arguments& arguments, const std::vector<Image>& images);

 private:
  FilterOptions options_of(Arguments& arguments);
  SurfaceTextures reduced_textures() const;
  double noise(RangeWidth::Unit unit);

  SurfaceInputs inputs_;
  double texel_size_ = 0;
  std::vector<Image> reduced_;        ///< per texture
  std::vector<Image> reduced_parts_;  ///< the same of the channels that are filtered, if not all
  std::optional<TexelMap> map_;     ///< of the textures that are filtered, once noise is asked for
  std::optional<KeptFilter> kept_;  ///< of the reduced textures
};

/// A file as it was.
struct FileStamp {
  std::string path;
  std::uint64_t bytes = 0;
  std::filesystem::file_time_type time;
};

/// Those of the mesh and of the textures that lie in files of their own.
std::vector<FileStamp> stamps_of(const SurfaceInputs& inputs);
/// The first one that is another file now; empty if all are as they were.
std::string changed_file(const std::vector<FileStamp>& stamps);

}  // namespace onmesh::tools
