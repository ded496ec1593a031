#include <algorithm>
#include <cmath>
#include <limits>

#include "fuzz/filter_case.h"
#include "onmesh/procedural/shapes.h"

namespace onmesh::fuzz {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Whatever lies between twelve points: edges with many faces, bow ties, intersections.
TriangleMesh make_soup(Input& input) {
  TriangleMesh mesh;
  for (int i = 0; i < 12; ++i) {
    const std::uint8_t xy = input.byte(), zu = input.byte(), v = input.byte();
    mesh.positions.emplace_back(xy % 16, xy / 16, zu % 16);
    mesh.uvs.emplace_back(zu / 16 / 15.0, v / 255.0);
  }
  const std::size_t faces = 1 + input.below(16);
  for (std::size_t f = 0; f < faces; ++f) {
    std::array<Index, 3> corners;
    for (Index& corner : corners) corner = Index(input.below(12));
    mesh.faces.push_back(corners);
    mesh.face_uvs.push_back(corners);
  }
  mesh.face_materials.assign(faces, kNone);
  return mesh;
}

TriangleMesh make_shape(Input& input) {
  switch (input.below(12)) {
    case 0:
      return make_plane(1, 1);
    case 1:
      return make_plane(3, 2);
    case 2:
      return make_cube();
    case 3:
      return make_book(1);
    case 4:
      return make_bow_tie(1);
    case 5:
      return make_moebius(1);
    case 6:
      return make_cone(270, 5, 2);
    case 7:
      return make_sphere(0);
    case 8:
      return make_folded_sheet(4, 2, 1, 175);
    case 9:
      return make_chest();
    case 10:
      return make_u_sheet(1, 1, 0.1);
    default:
      return make_soup(input);
  }
}

/// Coordinates and UVs that something has gone wrong with before.
double odd_number(Input& input) {
  static constexpr double kNumbers[] = {0,    1,   -1,   0.5,   1e-9,  1e-30, 1e-300, 1e3,
                                        -1e6, 1e9, 1e30, -1e30, 1e200, 0.1,   0.3,    1e15};
  return input.pick(kNumbers);
}

/// Atlases of thousands of tiles would be millions of texels: there are none but those that are
/// refused.
double odd_uv(Input& input) {
  static constexpr double kNumbers[] = {0,  1,   0.5, -0.5, 1e-12, 1e-300, 3,         -40,
                                        20, 2e4, 1e6, 1e10, 1e300, kNan,   kInfinity, -kInfinity};
  return input.pick(kNumbers);
}

/// One thing that is wrong with a mesh.
/// \pre it has vertices, UVs and faces
void damage(Input& input, TriangleMesh& mesh) {
  Vec3& vertex = mesh.positions[input.below(mesh.positions.size())];
  const Vec3 other = mesh.positions[input.below(mesh.positions.size())];
  const std::size_t face = input.below(mesh.faces.size());
  const std::size_t corner = input.below(3), next = (corner + 1) % 3;
  std::array<Index, 3>&corners = mesh.faces[face], &uvs = mesh.face_uvs[face];
  const auto add_face = [&](const std::array<Index, 3>& c, const std::array<Index, 3>& uv) {
    if (mesh.faces.size() >= kMostFaces) return;
    mesh.faces.push_back(c);
    mesh.face_uvs.push_back(uv);
    mesh.face_materials.push_back(kNone);
  };
  switch (input.below(20)) {
    case 0:  // a spike, or a vertex in the wrong place
      vertex[int(input.below(3))] = odd_number(input);
      break;
    case 1:  // a needle: beside another vertex
      vertex = other + 1e-9 * Vec3(1, double(input.below(3)), 0.5);
      break;
    case 2:  // vertices at one place
      vertex = other;
      break;
    case 3: {  // a sliver: on the opposite edge, almost
      const Vec3 middle =
          (mesh.positions[corners[next]] + mesh.positions[corners[(next + 1) % 3]]) / 2;
      mesh.positions[corners[corner]] = middle + odd_number(input) * 1e-12 * Vec3(0, 0, 1);
      break;
    }
    case 4:  // a repeated corner
      corners[corner] = corners[next];
      break;
    case 5:  // a face twice, with the same texels or as another sheet
      add_face(corners, uvs);
      break;
    case 6:
      add_face({corners[1], corners[0], corners[2]}, {uvs[1], uvs[0], uvs[2]});
      break;
    case 7: {  // a fin: one more face at an edge
      const auto v = Index(input.below(mesh.positions.size()));
      const auto uv = Index(input.below(mesh.uvs.size()));
      add_face({corners[corner], corners[next], v}, {uvs[corner], uvs[next], uv});
      break;
    }
    case 8:  // no UV area
      uvs[corner] = uvs[next];
      break;
    case 9:  // no UVs
      uvs[corner] = kNone;
      break;
    case 10:
      mesh.uvs[input.below(mesh.uvs.size())][int(input.below(2))] = odd_uv(input);
      break;
    case 11:  // all at one place of the atlas
      std::fill(mesh.uvs.begin(), mesh.uvs.end(), Vec2(0.3, 0.7));
      break;
    case 12: {  // an atlas elsewhere, or of another size
      const double scale = odd_uv(input), shift = odd_uv(input);
      for (Vec2& uv : mesh.uvs) uv = scale * uv + Vec2(shift, 0);
      break;
    }
    case 13:  // a vertex of no face
      mesh.positions.emplace_back(odd_number(input), 0, 0);
      break;
    case 14: {  // thin or huge as a whole
      const int axis = int(input.below(3));
      const double scale = odd_number(input);
      for (Vec3& p : mesh.positions) p[axis] *= scale;
      break;
    }
    case 15: {
      const double scale = odd_number(input);
      for (Vec3& p : mesh.positions) p *= scale;
      break;
    }
    case 16: {  // far from the origin
      const double shift = odd_number(input);
      for (Vec3& p : mesh.positions) p += Vec3(shift, shift, 0);
      break;
    }
    case 17:  // wound the other way
      std::swap(corners[0], corners[1]);
      std::swap(uvs[0], uvs[1]);
      break;
    case 18:  // faces that share no vertices
      mesh = loosen(mesh);
      break;
    default:  // a corner elsewhere
      corners[corner] = Index(input.below(mesh.positions.size()));
  }
}

}  // namespace

TriangleMesh make_mesh(Input& input) {
  TriangleMesh mesh = make_shape(input);
  const std::size_t damages = input.below(8);
  for (std::size_t i = 0; i < damages; ++i) {
    damage(input, mesh);
    if (mesh.uvs.empty()) mesh.uvs.emplace_back(0, 0);
  }
  mesh.materials.resize(2);
  for (Index f = 0; f < mesh.faces.size(); ++f) mesh.face_materials[f] = f % 3 < 2 ? f % 3 : kNone;
  // Readers refuse coordinates that are not finite; factors may have made some.
  for (Vec3& p : mesh.positions) {
    for (double& x : p) {
      if (!(std::abs(x) <= std::numeric_limits<double>::max())) x = 1;
    }
  }
  return mesh;
}

}  // namespace onmesh::fuzz
