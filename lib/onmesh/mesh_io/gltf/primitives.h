// The triangles of glTF meshes (internal).
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "onmesh/mesh_io/gltf/gltf_file.h"
#include "onmesh/mesh_io/gltf/materials.h"

namespace onmesh {

/// A primitive: triangles of one material.
struct GltfPart {
  std::vector<double> positions;  ///< three per vertex, of the mesh
  std::vector<Index> corners;     ///< three per triangle
  std::vector<Vec2> uvs;          ///< one per vertex, or none; placed on the texture, v up
  std::vector<double> normals;    ///< three per vertex, or none; of any length
  Index material = kNone;
  bool is_single = false;  ///< positions are stored as floats, else as integers

  std::size_t vertices() const { return positions.size() / 3; }
};

/// Reads meshes and counts what is in them.
class GltfPrimitives {
 public:
  /// \pre all outlive this
  GltfPrimitives(GltfFile& file, const std::vector<GltfSlotUvs>& slots, const ReadOptions& options)
      : file_(file),
        slots_(slots),
        options_(options),
        accessors_(file.root().size_of("accessors")) {}

  /// The primitives of a mesh that have triangles.
  /// \throw InputError naming the place in the JSON
  std::vector<GltfPart> read_mesh(Index mesh);

  /// Tell the file's report what was read and what was not.
  void report() const;

 private:
  std::optional<GltfPart> read_part(const JsonPlace& primitive);
  void read_plain(const JsonPlace& primitive, std::uint64_t mode, GltfPart& part);
  void read_draco(const JsonPlace& primitive, std::uint64_t mode, const JsonPlace& packed,
                  GltfPart& part);
  std::vector<double> read_attribute(const JsonPlace& primitive, const std::string& name,
                                     int components, std::size_t vertices);
  std::string uv_name(Index material) const;
  bool has_uvs(const JsonPlace& primitive, Index material);
  std::vector<Vec2> place_uvs(const std::vector<double>& stored, Index material) const;
  void note_attributes(const JsonPlace& primitive);

  GltfFile& file_;
  const std::vector<GltfSlotUvs>& slots_;  ///< per material
  const ReadOptions& options_;
  std::size_t accessors_;
  std::map<std::string, std::size_t> read_counts_, ignored_counts_;
  std::size_t lost_uvs_ = 0;    ///< primitives without the coordinates that their texture is for
  std::string first_lost_uvs_;  ///< the first of them
};

}  // namespace onmesh
