// Filters a small cube through the installed library: exit code 0 if the noise got less.
#include <onmesh/filter/filter.h>
#include <onmesh/procedural/shapes.h>
#include <onmesh/version.h>

#include <cstdio>
#include <cstring>
#include <exception>

namespace {

double roughness(const onmesh::Image& image) {
  double sum = 0;
  for (std::size_t i = 3; i < image.pixels.size(); ++i) {
    const double step = double(image.pixels[i]) - image.pixels[i - 3];
    sum += step * step;
  }
  return sum;
}

}  // namespace

int main() try {
  if (std::strcmp(onmesh::version(), ONMESH_VERSION_STRING) != 0) return 2;

  const onmesh::TriangleMesh mesh = onmesh::make_cube();
  onmesh::SurfaceTextureOptions texture;
  texture.noise = 0.2;
  const onmesh::Image before = onmesh::make_surface_texture(mesh, 64, 64, texture);

  onmesh::FilterOptions options;
  options.kind = onmesh::FilterKind::gaussian;
  options.sigma_spatial = onmesh::parse_length("sigma", "3tx");
  onmesh::FilterReport report;
  const onmesh::Image after = onmesh::filter(mesh, before, options, &report);

  // The same as a surface of tiles, here of one.
  onmesh::SurfaceTextures textures;
  textures.tiles = {{&before, onmesh::Wrap::repeat, 0, 0, "cube"}};
  if (onmesh::filter(mesh, textures, options).at(0).pixels != after.pixels) return 3;

  std::printf("%llu texels filtered with %s\n", static_cast<unsigned long long>(report.texels),
              report.backend.c_str());
  return report.texels > 0 && roughness(after) < roughness(before) ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
