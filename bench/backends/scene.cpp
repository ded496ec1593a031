#include "backends/scene.h"

#include <tbb/parallel_for.h>
#include <time.h>

#include <filesystem>
#include <memory>
#include <random>

#include "onmesh/base/error.h"
#include "onmesh/kernel/radius.h"
#include "onmesh/measure/mesh_report.h"
#include "onmesh/measure/nearby_geodesics.h"
#include "onmesh/mesh_io/read_mesh.h"
#include "onmesh/procedural/shapes.h"
#include "onmesh/procedural/texture.h"
#include "support/closed_forms.h"

namespace onmesh::bench {
namespace {

constexpr double kSigmaRange = 0.2;

Distances exact_truth(const TriangleMesh& mesh, double radius) {
  const auto geodesics = std::make_shared<NearbyGeodesics>(mesh, radius);
  return [geodesics](const SurfacePoint& source, const std::vector<SurfacePoint>& targets) {
    return geodesics->distances(source, targets);
  };
}

Subject subject(std::string name, int size, TriangleMesh mesh,
                std::function<Distances(const TriangleMesh&, double)> truth = exact_truth) {
  return {std::move(name), size, [mesh = std::move(mesh)] { return mesh; }, std::move(truth)};
}

std::vector<NodePoint> places_of_texels(const Samples& samples, std::size_t texels) {
  std::vector<NodePoint> places(texels);
  std::vector<bool> seen(texels, false);
  for (Index f = 0; f + 1 < samples.face_offsets.size(); ++f) {
    for (Index i = samples.face_offsets[f]; i < samples.face_offsets[f + 1]; ++i) {
      const Sample& s = samples.samples[i];
      places[s.texel] = seen[s.texel] ? NodePoint{} : NodePoint{f, {1.0 - s.b1 - s.b2, s.b1, s.b2}};
      seen[s.texel] = true;
    }
  }
  return places;
}

/// Random samples of different texels that nothing else claims. Where there are few of those, some
/// tries fail, and fewer are chosen.
std::vector<std::size_t> choose_centres(const Scene& scene, std::size_t count) {
  const std::vector<Index> overlapped = scene.setup.map.overlapped();
  std::vector<bool> taken(scene.setup.map.coverage.size(), false);
  for (const Index texel : overlapped) taken[texel] = true;
  std::vector<std::size_t> centres;
  std::mt19937 random(42);
  for (std::size_t i = 0; i < 100 * count && centres.size() < count; ++i) {
    const std::size_t x = random() % scene.points.points.size();
    const Index texel = scene.points.texels[x];
    if (taken[texel]) continue;
    taken[texel] = true;
    centres.push_back(x);
  }
  return centres;
}

}  // namespace

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

Weights Scene::weights(FilterKind kind) const {
  const bool bilateral = kind == FilterKind::bilateral;
  return {sigma(), sigma() * (bilateral ? 2.5 : 3.0), bilateral ? kSigmaRange : 0};
}

std::vector<Subject> built_in_subjects(bool quick) {
  const auto flat = [](const TriangleMesh& mesh, double) { return sheet_distances(mesh); };
  const auto cone = [](const TriangleMesh& mesh, double) { return cone_distances(mesh, 270); };
  const auto book = [](const TriangleMesh& mesh, double) { return book_distances(mesh); };
  if (quick) {
    return {subject("cube", 64, make_cube(1)), subject("book", 64, make_book(1), book)};
  }
  // The leaves of the sheet are two texels apart, less than the nodes are.
  return {subject("U-sheet", 128, make_u_sheet(0.5, 1, 2.0 / 128), flat),
          subject("cone", 128, make_cone(270, 36, 4), cone),
          subject("cube", 256, make_cube(1)),
          subject("sphere", 192, make_sphere(3)),
          subject("torus", 192, make_torus(32, 16)),
          subject("saddle", 128, make_saddle(16)),
          subject("blob", 192, make_blob(3, 1)),
          subject("book", 256, make_book(2), book)};
}

Subject subject_from_file(const std::string& path, int size) {
  return {std::filesystem::path(path).stem().string(), size, [path] { return read_mesh(path); },
          [path](const TriangleMesh& mesh, double radius) {
            if (!report_mesh(mesh).manifold())
              throw InputError(path + ": not manifold, so exact distances are not known");
            return exact_truth(mesh, radius);
          }};
}

Scene make_scene(const Subject& subject, double sigma_texels, std::size_t texels) {
  Scene scene;
  scene.name = subject.name;
  scene.sigma_texels = sigma_texels;
  scene.texture = make_texture(subject.size, subject.size, Pattern::checker, 0.3, 7);
  FilterOptions options;
  options.sigma_spatial = {sigma_texels, Length::Unit::texel};
  options.sigma_range = kSigmaRange;
  scene.setup = set_up_filter(subject.make(), one_texture(scene.texture, options), options);
  const TriangleMesh& mesh = scene.setup.mesh;

  scene.points = texel_points(mesh, scene.texture.width, scene.texture.height);
  const std::vector<std::size_t> centres = choose_centres(scene, texels);
  if (centres.empty()) throw InputError(subject.name + ": several places claim every texel");
  scene.tried_at.assign(scene.setup.map.coverage.size(), kNone);
  for (std::size_t i = 0; i < centres.size(); ++i)
    scene.tried_at[scene.points.texels[centres[i]]] = Index(i);

  RefineOptions refine_options;
  refine_options.spacing = scene.setup.lengths.curved_spacing;
  refine_options.finest = scene.setup.lengths.finest_spacing;
  const double start = thread_seconds();
  scene.surface = refine(mesh, scene.setup.cleaning, refine_options);
  scene.refine_seconds = thread_seconds() - start;
  scene.samples = texel_samples(scene.setup.map, scene.surface);
  scene.places = places_of_texels(scene.samples, scene.setup.map.coverage.size());

  scene.truth_on = subject.truth;
  const double radius = scene.weights(FilterKind::gaussian).radius;
  const Distances distances = scene.truth(largest_distance(radius));
  scene.tried.resize(centres.size());
  tbb::parallel_for(std::size_t(0), centres.size(), [&](std::size_t i) {
    scene.tried[i] = neighbourhood(scene.points, centres[i], radius, distances);
  });
  return scene;
}

}  // namespace onmesh::bench
