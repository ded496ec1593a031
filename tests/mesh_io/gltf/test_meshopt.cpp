#ifdef ONMESH_HAS_MESHOPT
#include <meshoptimizer.h>
#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "onmesh/mesh_io/gltf/read_gltf.h"
#include "support/gltf_square.h"
#include "support/refused.h"

namespace onmesh {
namespace {

using Catch::Matchers::Contains;
using nlohmann::json;

}  // namespace

TEST_CASE("EXT_meshopt_compression is unpacked", "[read_gltf][meshopt]") {
  GltfBuilder gltf = gltf_square();
  const TriangleMesh plain = parse_gltf(gltf.glb());
  const auto pack = [&](int view, const json& how, const std::vector<unsigned char>& packed) {
    const int stored = gltf.add_view(std::string(packed.begin(), packed.end()));
    json extension = gltf.json["bufferViews"][stored];
    extension.update(how);
    gltf.json["bufferViews"][view]["extensions"]["EXT_meshopt_compression"] = extension;
    gltf.json["bufferViews"][view]["byteOffset"] = 1'000'000;  // of no account now
  };
  const float positions[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  std::vector<unsigned char> packed(meshopt_encodeVertexBufferBound(4, 12));
  packed.resize(meshopt_encodeVertexBuffer(packed.data(), packed.size(), positions, 4, 12));
  pack(gltf.json["accessors"][0]["bufferView"],
       {{"count", 4}, {"byteStride", 12}, {"mode", "ATTRIBUTES"}}, packed);
  const unsigned indices[] = {0, 1, 2, 0, 2, 3};
  packed.resize(meshopt_encodeIndexBufferBound(6, 4));
  packed.resize(meshopt_encodeIndexBuffer(packed.data(), packed.size(), indices, 6));
  const int index_view = gltf.json["accessors"][2]["bufferView"];
  pack(index_view, {{"count", 6}, {"byteStride", 2}, {"mode", "TRIANGLES"}}, packed);
  gltf.json["extensionsRequired"] = {"EXT_meshopt_compression"};
  const TriangleMesh mesh = parse_gltf(gltf.glb());
  CHECK(mesh.positions == plain.positions);
  // The codec may turn a triangle's corners round.
  CHECK(signed_area(mesh) == signed_area(plain));

  json& extension = gltf.json["bufferViews"][index_view]["extensions"]["EXT_meshopt_compression"];
  extension["byteLength"] = 3;
  CHECK_THAT(error_of(read_gltf, "m.glb", gltf.glb()), Contains("compressed data are damaged"));
  extension["count"] = 9007199254740992;
  CHECK_THAT(error_of(read_gltf, "m.glb", gltf.glb()), Contains("would become much larger"));
}

}  // namespace onmesh

#endif
