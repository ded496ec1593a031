#include "distance_request.h"

#include <utility>

#include "onmesh/base/text.h"
#include "onmesh/image/image_io.h"
#include "tile_names.h"

namespace onmesh::tools {
namespace {

void read_comparison(const Arguments& arguments, DistanceRequest& request) {
  if (!arguments.has("compare")) return;
  const std::string with = arguments.text("compare");
  if (with != "exact" && with != "all")
    throw UsageError("--compare: '" + with + "' is neither exact nor all");
  request.compare_all = with == "all";
  if (request.exact() && !request.compare_all)
    throw UsageError("--compare exact needs another back end than --distance exact");
  request.compare = true;
}

void check_bridge(const DistanceRequest& request) {
  if (!request.bridge) return;
  if (request.compare)
    throw UsageError("--bridge: exact distances know none, so not with --compare");
  if (request.exact())
    throw UsageError("--bridge: exact distances know none, so not with --distance exact");
}

void read_lengths(const Arguments& arguments, DistanceRequest& request) {
  request.radius = arguments.optional_length("radius");
  request.spacing = arguments.optional_length("spacing");
  request.sigma = arguments.optional_length("sigma");
  if (request.spacing && !request.needs_nodes)
    throw UsageError("--spacing: --distance exact needs no nodes, unless --nodes-ply writes them");
  if (request.sigma && !request.compare) throw UsageError("--sigma is of use only with --compare");
}

bool in_texels(const std::optional<Length>& length) {
  return length && length->unit == Length::Unit::texel;
}

void check_outputs(const Arguments& arguments) {
  for (const char* name : {"output", "nodes-ply"}) {
    if (arguments.has(name)) check_writable_file(arguments.text(name));
  }
  if (!arguments.has("texture") || names_several(arguments.text("texture"))) return;
  check_distance_texture(arguments.text("texture"));
}

}  // namespace

void check_distance_texture(const std::filesystem::path& path) {
  const std::string extension = lower_case(path.extension().string());
  if (extension != ".exr" && extension != ".tif" && extension != ".tiff")
    throw UsageError("--texture: " + path.string() +
                     " must end in .exr or .tif, other formats hold no distances");
  check_writable_image(path, make_image(1, 1, 1));
}

DistanceRequest read_distance_request(const Arguments& arguments) {
  if (arguments.has("vertex") + arguments.has("uv") + arguments.has("point") != 1)
    throw UsageError("give one of --vertex, --uv and --point");
  DistanceRequest request;
  request.method = distance_of(arguments);
  read_comparison(arguments, request);
  request.bridge = bridge_of(arguments);
  check_bridge(request);
  request.needs_nodes = !request.exact() || request.compare || arguments.has("nodes-ply");
  read_lengths(arguments, request);
  request.needs_atlas = in_texels(request.radius) || in_texels(request.spacing) ||
                        in_texels(request.sigma) || in_texels(request.bridge) ||
                        arguments.has("texture");
  const bool has_size = arguments.has("atlas") || arguments.has("resolution");
  if (has_size && !request.needs_atlas)
    throw UsageError(std::string(arguments.has("atlas") ? "-t" : "--resolution") +
                     " is of use only with --texture or lengths in tx");
  check_outputs(arguments);
  wrap_of(arguments);
  return request;
}

DistanceSource find_source(const Arguments& arguments, const InputMesh& input) {
  if (arguments.has("vertex")) {
    return source_at_vertex(input, arguments.integer("vertex", 0, INT64_MAX), "vertex");
  }
  if (arguments.has("uv")) {
    const auto uv = arguments.numbers("uv", 2);
    return source_at_uv(input.cleaned, {uv[0], uv[1]}, "uv");
  }
  const auto p = arguments.numbers("point", 3);
  return naming(input.path, [&] { return source_at_point(input.cleaned, {p[0], p[1], p[2]}); });
}

DistanceLengths resolve_lengths(const DistanceRequest& request, const TriangleMesh& mesh,
                                double texel_size) {
  const auto resolved = [&](const Length& length) {
    return resolve(length, texel_size, mesh.diagonal());
  };
  DistanceLengths lengths;
  if (request.radius) lengths.radius = resolved(*request.radius);
  lengths.spacing =
      request.spacing ? resolved(*request.spacing) : default_spacing(mesh, lengths.radius);
  lengths.sigma = request.sigma ? resolved(*request.sigma) : lengths.radius / 2.5;
  if (request.bridge) lengths.bridge = resolved(*request.bridge);
  return lengths;
}

}  // namespace onmesh::tools
