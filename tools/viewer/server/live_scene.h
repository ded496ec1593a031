// What the window shows of mesh and textures as they were read.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "../../arguments.h"
#include "../review.h"
#include "live_distances.h"
#include "live_textures.h"

namespace onmesh::tools {

/// The states that the page has beside the textures as read.
inline constexpr const char* kPreviewName = "preview";
inline constexpr const char* kRunName = "full run";

/// Mesh, textures, and the page made of them. Its textures are missing if the mesh has none: then
/// only its shape can be looked at. One thread at a time.
class LiveScene {
 public:
  /// Reads the files.
  /// \param words of onmesh filter that say what is read
  /// \param arguments of onmesh view
  /// \throw UsageError, FileError, InputError
  LiveScene(const std::vector<std::string>& words, const Arguments& arguments,
            const RenderOptions& camera);
  LiveScene(const LiveScene&) = delete;
  LiveScene& operator=(const LiveScene&) = delete;

  const std::string& page() const { return page_; }
  /// A sentence if there are no textures to filter.
  const std::string& why_no_textures() const { return why_no_textures_; }
  LiveDistances& distances() { return distances_; }
  const std::vector<FileStamp>& stamps() const { return stamps_; }

  /// The textures as that preset reads them: as numbers, or as they are.
  /// \throw InputError if there are none
  LiveTextures& textures(const Arguments& arguments);
  /// Mesh units. \throw UsageError for texels where there are none
  double length_of(const Length& length) const;

  /// The page's answers to results.
  std::string preview_answer(const LiveResult& result, double seconds) const;
  std::string run_answer(const LiveResult& result, double seconds) const;

 private:
  void read_textures();
  nlohmann::json live_json(const Review& review) const;
  nlohmann::json images_json(const std::vector<Image>& images, PageWriter& page) const;

  std::vector<std::string> words_;
  InputMesh mesh_;
  std::unique_ptr<LiveTextures> textures_;  ///< as they are
  std::unique_ptr<LiveTextures> data_;      ///< as numbers, once a preset asks for that
  std::string why_no_textures_;
  TriangleMesh local_;                ///< cleaned, with UVs of each face's own tile
  std::unique_ptr<TexelMap> texels_;  ///< of the textures; null = not known
  std::size_t seams_ = 0;
  LiveDistances distances_;
  std::vector<FileStamp> stamps_;
  std::string page_;
};

}  // namespace onmesh::tools
