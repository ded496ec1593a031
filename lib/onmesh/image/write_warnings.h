// What of an image a file does not hold (internal: included by the image sources only).
#pragma once

#include <string>
#include <vector>

#include "onmesh/image/data_window.h"
#include "onmesh/image/file_format.h"
#include "onmesh/image/image_io.h"

namespace onmesh {

/// A line for each thing of the image or its source that the file lacks, without its name.
/// \param types of the file's channels
/// \param windows of the file
std::vector<std::string> write_warnings(const ImageFormat& format, const Image& image,
                                        const ImageWriteOptions& options,
                                        const std::vector<SampleType>& types,
                                        const ImageWindows& windows);

}  // namespace onmesh
