// The extensions that the first byte of an input of the target `image` chooses from.
#pragma once

namespace onmesh::fuzz {

/// "dat" is no format's: the content alone tells.
inline constexpr const char* kImageExtensions[] = {"png", "jpg", "tif", "exr",  "tga", "bmp",
                                                   "ppm", "sgi", "hdr", "webp", "psd", "dat"};

}  // namespace onmesh::fuzz
