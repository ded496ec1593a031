#include "subcommands.h"

namespace onmesh::tools {
namespace {

constexpr Subcommand kCommands[] = {
    {"filter", "filter a texture on the mesh's surface", filter_command, run_filter},
    {"fill", "give texels without a value one from the surface around them", fill_command,
     run_fill},
    {"info", "report what is special or wrong about a mesh and its atlas", info_command, run_info},
    {"view", "render the textured mesh as a picture", view_command, run_view},
    {"compare", "measure how two textures differ, and how visible seams are", compare_command,
     run_compare},
    {"distance", "compute geodesic distances from a point", distance_command, run_distance},
    {"refine", "write the nodes that distances are computed between", refine_command, run_refine},
    {"map", "write which texel lies where on the surface", map_command, run_map},
    {"sample", "write Poisson-disk samples of the surface", sample_command, run_sample},
    {"make-mesh", "make a textured test mesh", make_mesh_command, run_make_mesh},
};

}  // namespace

std::span<const Subcommand> subcommands() { return kCommands; }

}  // namespace onmesh::tools
