#include "onmesh/mesh_io/gltf/scene.h"

#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <utility>

#include "onmesh/base/text.h"
#include "onmesh/mesh_io/gltf/accessors.h"

namespace onmesh {
namespace {

using Eigen::Matrix4d;

Matrix4d local_matrix(const JsonPlace& node) {
  if (const auto matrix = node.find("matrix")) {
    const std::vector<double> numbers = matrix->numbers(16);
    return Eigen::Map<const Matrix4d>(numbers.data());  // columns first, as Eigen has them
  }
  Eigen::Affine3d local = Eigen::Affine3d::Identity();
  if (const auto translation = node.find("translation")) {
    const std::vector<double> t = translation->numbers(3);
    local.translate(Vec3(t[0], t[1], t[2]));
  }
  if (const auto rotation = node.find("rotation")) {
    const std::vector<double> q = rotation->numbers(4);
    const Eigen::Quaterniond turned(q[3], q[0], q[1], q[2]);
    if (turned.norm() < 1e-6) rotation->fail("is no rotation");
    local.rotate(turned.normalized());
  }
  if (const auto scale = node.find("scale")) {
    const std::vector<double> s = scale->numbers(3);
    local.scale(Vec3(s[0], s[1], s[2]));
  }
  return local.matrix();
}

/// Walks through the nodes of a scene.
class SceneWalk {
 public:
  explicit SceneWalk(GltfFile& file)
      : file_(file), count_(file.root().size_of("nodes")), to_world_(count_) {}

  std::vector<GltfInstance> run();

 private:
  std::vector<Index> roots() const;
  std::vector<Index> all_roots() const;
  Matrix4d bind_matrix(const JsonPlace& skin);

  GltfFile& file_;
  std::size_t count_;
  std::vector<std::optional<Matrix4d>> to_world_;  ///< of the nodes that were reached
};

/// The elements of a list of node numbers.
std::vector<Index> node_list(const JsonPlace& list, std::size_t count) {
  std::vector<Index> nodes;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const JsonPlace place = list.at(i);
    const std::uint64_t node = place.whole_number();
    if (node >= count) place.fail("there is no node " + std::to_string(node));
    nodes.push_back(Index(node));
  }
  return nodes;
}

std::vector<Index> SceneWalk::all_roots() const {
  std::vector<bool> is_child(count_, false);
  for (Index i = 0; i < count_; ++i) {
    const auto children = file_.element("nodes", i).find("children");
    if (!children) continue;
    for (const Index child : node_list(*children, count_)) is_child[child] = true;
  }
  std::vector<Index> roots;
  for (Index i = 0; i < count_; ++i) {
    if (!is_child[i]) roots.push_back(i);
  }
  return roots;
}

std::vector<Index> SceneWalk::roots() const {
  const std::size_t scenes = file_.root().size_of("scenes");
  if (scenes == 0) {
    file_.report().assumed.emplace_back("there is no scene: all nodes are shown");
    return all_roots();
  }
  const auto chosen = file_.root().find_index("scene", scenes);
  if (!chosen)
    file_.report().assumed.emplace_back("no scene is the default: the first one is shown");
  file_.report().read.push_back("scene " + std::to_string(chosen.value_or(0)) + " of " +
                                std::to_string(scenes));
  const auto nodes = file_.element("scenes", chosen.value_or(0)).find("nodes");
  return nodes ? node_list(*nodes, count_) : std::vector<Index>{};
}

Matrix4d SceneWalk::bind_matrix(const JsonPlace& skin) {
  const std::vector<Index> joints = node_list(skin.at("joints"), count_);
  if (joints.empty()) skin.at("joints").fail("is empty");
  const auto bound = skin.find_index("inverseBindMatrices", file_.root().size_of("accessors"));
  std::vector<double> numbers;
  if (bound) numbers = read_numbers(file_, *bound, 16);
  if (bound && numbers.size() < 16 * joints.size())
    skin.at("inverseBindMatrices").fail("has fewer matrices than there are joints");
  const auto placed = [&](std::size_t i) -> Matrix4d {
    Matrix4d joint = to_world_[joints[i]].value_or(Matrix4d::Identity());
    if (!bound) return joint;
    return joint * Eigen::Map<const Matrix4d>(numbers.data() + 16 * i);
  };
  Matrix4d first = placed(0);
  std::size_t moved = 0;
  for (std::size_t i = 1; i < joints.size(); ++i)
    moved += (placed(i) - first).norm() > 1e-3 * first.norm() ? 1 : 0;
  file_.report().assumed.push_back(
      skin.path() + ": its mesh is in the bind pose" +
      (moved == 0 ? "" : ", from which " + count_text(moved, "joint is", "joints are") + " moved"));
  return first;
}

std::vector<GltfInstance> SceneWalk::run() {
  struct Skinned {
    std::size_t instance;
    Index skin;
  };
  std::vector<GltfInstance> instances;
  std::vector<Skinned> skinned;
  // The next node is the last one of the list.
  std::vector<std::pair<Index, Matrix4d>> left;
  const auto add = [&](std::vector<Index> nodes, const Matrix4d& parent) {
    for (; !nodes.empty(); nodes.pop_back()) left.emplace_back(nodes.back(), parent);
  };
  add(roots(), Matrix4d::Identity());
  const std::size_t meshes = file_.root().size_of("meshes");
  const std::size_t skins = file_.root().size_of("skins");
  while (!left.empty()) {
    const auto [number, parent] = left.back();
    left.pop_back();
    const JsonPlace node = file_.element("nodes", number);
    if (to_world_[number]) node.fail("has two parents, or is its own ancestor");
    to_world_[number] = parent * local_matrix(node);
    if (const auto mesh = node.find_index("mesh", meshes)) {
      if (const auto skin = node.find_index("skin", skins))
        skinned.push_back({instances.size(), *skin});
      instances.push_back({*mesh, *to_world_[number]});
    }
    if (const auto children = node.find("children"))
      add(node_list(*children, count_), *to_world_[number]);
  }
  std::map<Index, Matrix4d> bound;  // by skin
  for (const Skinned& s : skinned) {
    const auto [at, is_new] = bound.try_emplace(s.skin);
    if (is_new) at->second = bind_matrix(file_.element("skins", s.skin));
    instances[s.instance].to_world = at->second;
  }
  return instances;
}

}  // namespace

std::vector<GltfInstance> find_instances(GltfFile& file) { return SceneWalk(file).run(); }

}  // namespace onmesh
