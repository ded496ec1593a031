// What back ends are compared on: meshes with textures, kernels and true distances.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "onmesh/filter/setup.h"
#include "onmesh/nodes/refine.h"
#include "onmesh/samples/samples.h"
#include "support/brute_force.h"

namespace onmesh::bench {

/// A mesh to compare on.
struct Subject {
  std::string name;
  int size = 0;  ///< texels per side of its texture
  std::function<TriangleMesh()> make;
  /// True distances on the mesh up to a radius (mesh units), safe to call from several threads.
  std::function<Distances(const TriangleMesh& mesh, double radius)> truth;
};

/// The built-in meshes; fewer and smaller ones for a smoke test.
std::vector<Subject> built_in_subjects(bool quick);
/// A mesh from a file, with a texture of size x size texels.
Subject subject_from_file(const std::string& path, int size);

/// A subject with one kernel size, prepared as the filter does it, and what is true there.
struct Scene {
  std::string name;
  double sigma_texels = 0;
  FilterSetup setup;
  NodeSurface surface;
  Samples samples;
  Image texture;
  double refine_seconds = 0;  ///< CPU time
  std::function<Distances(const TriangleMesh& mesh, double radius)> truth_on;

  // The texels tried, and what is true around them.
  TexelPoints points;
  std::vector<Neighbourhood> tried;  ///< out to the Gaussian filter's radius
  std::vector<Index> tried_at;       ///< per texel: into tried, or kNone
  std::vector<NodePoint> places;     ///< per texel; face kNone = no claim or more than one

  double sigma() const { return setup.lengths.sigma_spatial; }
  Weights weights(FilterKind kind) const;
  Distances truth(double radius) const { return truth_on(setup.mesh, radius); }
};

/// \param texels how many are tried; chosen at random with a fixed seed among those that one place
///   of the surface claims
/// \throw InputError if the mesh cannot be filtered or has no true distances
Scene make_scene(const Subject& subject, double sigma_texels, std::size_t texels);

/// CPU time of this thread.
double thread_seconds();

}  // namespace onmesh::bench
