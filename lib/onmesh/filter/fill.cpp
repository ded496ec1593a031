#include "onmesh/filter/fill.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "onmesh/atlas/chart_mask.h"
#include "onmesh/atlas/gutter.h"
#include "onmesh/atlas/harmonic_fill.h"
#include "onmesh/base/face_error.h"
#include "onmesh/base/text.h"
#include "onmesh/filter/check_options.h"
#include "onmesh/filter/memory_plan.h"
#include "onmesh/filter/on_threads.h"
#include "onmesh/filter/prepare_mesh.h"
#include "onmesh/filter/result_values.h"
#include "onmesh/filter/stages.h"

namespace onmesh {
namespace {

/// What the stages that filter() has, too, take.
FilterOptions filter_options(const FillOptions& options) {
  FilterOptions result;
  result.kind = FilterKind::gaussian;  // nothing is compared
  result.gutter = options.gutter;
  result.weld = options.weld;
  result.threads = options.threads;
  result.max_memory = options.max_memory;
  return result;
}

/// Alpha has a value where it is finite, and not 0 if that says that there is none.
bool has_alpha(float alpha, bool clear_is_missing) {
  return std::isfinite(alpha) && !(clear_is_missing && alpha == 0);
}

/// Per texel 0 if it has no value by mask or alpha, else more; empty if neither says so.
std::vector<float> value_weights(const PreparedMesh& prepared, const SurfaceTextures& textures,
                                 bool clear_is_missing) {
  std::vector<const Image*> masks;
  for (const TextureTile& tile : textures.tiles) masks.push_back(tile.sample_mask);
  std::vector<float> weights = chart_mask(prepared.mesh, prepared.map, masks);
  const ConstTexelValues codes = textures.values();
  const int alpha = codes.alpha_channel();
  if (alpha < 0) return weights;
  for (Index t = 0; t < codes.size(); ++t) {
    if (has_alpha(codes[t][alpha], clear_is_missing)) continue;
    if (weights.empty()) weights.resize(codes.size(), 1);
    weights[t] = 0;
  }
  return weights;
}

/// Covered texels by what becomes of them, ascending.
struct Holes {
  std::vector<Index> missing;
  std::vector<Index> clear;    ///< their colours are nobody's
  std::vector<Index> unknown;  ///< both
};

Holes find_holes(const WorkingValues& working, bool clear_is_missing) {
  const ConstTexelValues codes = working.textures().values();
  const int alpha = codes.alpha_channel();
  Holes holes;
  for (Index t = 0; t < codes.size(); ++t) {
    if (working.map().coverage[t] != Coverage::covered) continue;
    const float* const values = working.straight().values_of(t);
    const bool is_missing = !std::all_of(values, values + working.channels().size(),
                                         [](float v) { return std::isfinite(v); });
    const bool is_clear = !is_missing && !clear_is_missing && alpha >= 0 && codes[t][alpha] == 0;
    if (is_missing) holes.missing.push_back(t);
    if (is_clear) holes.clear.push_back(t);
    if (is_missing || is_clear) holes.unknown.push_back(t);
  }
  return holes;
}

/// Fill the holes, and alpha where it has no value.
/// \return how many texels are left
std::uint64_t fill_holes(const PreparedMesh& prepared, const WorkingValues& working,
                         const Holes& holes, bool clear_is_missing, const TexelValues& values) {
  const ConstTexelValues codes = working.textures().values();
  const int alpha = codes.alpha_channel();
  std::vector<int> channels = working.channels();
  const bool fills_alpha =
      alpha >= 0 && std::any_of(holes.missing.begin(), holes.missing.end(), [&](Index t) {
        return !has_alpha(codes[t][alpha], clear_is_missing);
      });
  if (fills_alpha) channels.push_back(alpha);
  const std::uint64_t left =
      harmonic_fill(prepared.mesh, prepared.map, holes.unknown, channels, values);
  for (const Index t : holes.missing) {
    if (fills_alpha && has_alpha(codes[t][alpha], clear_is_missing))
      values[t][alpha] = codes[t][alpha];
  }
  for (const Index t : holes.clear) {
    const float* own = working.straight().values_of(t);
    for (const int c : working.channels()) values[t][c] = *own++;
    if (fills_alpha) values[t][alpha] = codes[t][alpha];
  }
  return left;
}

std::vector<Image> run_fill(const TriangleMesh& mesh, const SurfaceTextures& textures,
                            const FillOptions& options, FillReport& report,
                            const Progress& progress) {
  const FilterOptions shared = filter_options(options);
  Stages stages(report.stages, progress);
  stages.begin("texel map");
  check_arrays(mesh);
  check_options(shared, mesh.faces.size());
  check_textures(textures, mesh.faces.size());
  if (options.clear_is_missing) check_alpha(textures);
  const PreparedMesh prepared = prepare_mesh(mesh, textures, shared);
  report.warnings = prepared.warnings;
  stages.end();

  return with_face_numbers(prepared.cleaning.kept, [&] {
    stages.begin("fill");
    const WorkingValues working(textures, prepared.map, shared,
                                value_weights(prepared, textures, options.clear_is_missing));
    const Holes holes = find_holes(working, options.clear_is_missing);
    report.texels = working.covered();
    report.missing = holes.missing.size();
    if (report.missing > 0 && holes.unknown.size() == working.covered())
      throw InputError("no texel on the surface has a value: there is nothing to fill from");
    require_memory_to_fill(textures, holes.unknown.size(), shared);
    std::vector<Image> images;
    for (const TextureTile& tile : textures.tiles) images.push_back(*tile.image);
    if (holes.missing.empty()) {
      stages.end();
      return images;
    }
    const ResultValues results(working, images);
    report.left = fill_holes(prepared, working, holes, options.clear_is_missing, results.values());
    if (report.left > 0) {
      report.warnings.push_back(count_text(report.left, "texel", "texels") +
                                " on parts where no texel has a value: they stay as they are");
    }
    stages.end();

    stages.begin("gutter");
    std::vector<Index> gutter;
    if (options.gutter > 0) {
      gutter = fill_gutter(prepared.mesh, prepared.map, options.gutter, results.values());
      report.gutter = gutter.size();
    }
    results.encode(gutter);
    stages.end();
    return images;
  });
}

}  // namespace

std::vector<Image> fill(const TriangleMesh& mesh, const SurfaceTextures& textures,
                        const FillOptions& options, FillReport* report, const Progress& progress) {
  FillReport unused;
  FillReport& out = report != nullptr ? *report : unused;
  out = {};
  return on_threads(options.threads,
                    [&] { return run_fill(mesh, textures, options, out, progress); });
}

}  // namespace onmesh
