// The faces and triangle strips of a PLY file on their way to polygons, whatever they come before.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "onmesh/mesh_io/ply_header.h"
#include "onmesh/mesh_io/ply_properties.h"
#include "onmesh/mesh_io/polygon_mesh.h"
#include "onmesh/mesh_io/reading.h"

namespace onmesh {

/// What is read of the vertices.
struct PlyVertices {
  std::vector<Vec3> positions;
  std::vector<Vec2> uvs;        ///< one per vertex, or none at all
  std::vector<Index> textures;  ///< one per vertex, or none at all
  std::string uv_names;         ///< "s t"
  CoordinatePrecision precision;
};

/// A face or triangle strip as the file has it.
struct PlyFace {
  std::vector<double> corners;  ///< vertex indices
  std::vector<double> uvs;      ///< of all corners, or none
  std::vector<Index> textures;  ///< one for all or one per corner
};

/// Collects faces; with the vertices they become polygons.
class PlyFaces {
 public:
  /// \param file its name, for messages
  /// \param textures that the header names
  PlyFaces(std::string file, std::size_t textures) : file_(std::move(file)), textures_(textures) {}

  /// Vertices are known, so that faces from now on are checked against their number.
  void set_vertex_count(std::size_t count) { vertex_count_ = count; }

  /// The faces or strips that follow are those of this element.
  /// \pre the file is long enough for them
  void begin(const PlyElement& element, const FaceProperties& properties, bool strips);

  /// The texture of a texnumber; kNone if there is none of that number.
  /// \param type of the value: -1 says that there is none, and so do its bits in an unsigned type
  Index texture(double number, PlyType type);

  /// Add a polygon.
  /// \return what is wrong with it; empty if nothing is
  std::string add_face(const PlyFace& face);

  /// Add the triangles of a strip, each of which shares two corners with the one before: every
  /// other one is turned over, so that all face the same way. Those that have a corner twice only
  /// lead on. -1 ends a strip within the list.
  /// \param type of the indices: in an unsigned one the bits of -1 end a strip as well
  /// \return what is wrong with it; empty if nothing is
  std::string add_strip(const PlyFace& strip, PlyType type);

  /// All polygons, with the UVs and textures of their vertices where they have none of their own.
  /// \param report receives what had to be chosen or left out
  /// \throw InputError naming file and face if one has a vertex that does not exist
  PolygonMesh finish(PlyVertices vertices, ReadReport& report);

 private:
  /// Polygons of one element.
  struct Section {
    std::string element;
    std::size_t first = 0;  ///< polygon
    bool strips = false;
    bool has_texture = false;
    std::string uv_name;
  };

  std::string take_corner(double value, Index& vertex);
  std::string out_of_range(Index vertex, std::size_t vertices) const;
  Index texture_of(const PlyFace& face);
  void check_corners(std::size_t vertices) const;
  void set_textures(const PlyVertices& vertices);
  bool set_uvs(const PlyVertices& vertices);
  void warn(ReadReport& report) const;
  void tell_uvs(const PlyVertices& vertices, bool vertex_uvs_used, ReadReport& report) const;

  std::string file_;
  std::size_t textures_ = 0;
  std::optional<std::size_t> vertex_count_;
  bool unchecked_ = false;  ///< faces came before the vertices
  std::vector<Section> sections_;
  PolygonMesh out_;
  std::vector<Vec2> uvs_;  ///< of corners that have one of their own

  // What the report is told.
  std::size_t misfits_ = 0;  ///< lists of UVs that do not fit their corners
  std::string first_misfit_;
  std::size_t mixed_textures_ = 0;    ///< faces whose corners differ
  std::size_t unknown_textures_ = 0;  ///< numbers
};

}  // namespace onmesh
