// The shapes of onmesh make-mesh, with the options that each takes.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "arguments.h"
#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh::tools {

/// A shape's parameters as given; remembers which ones the shape asked for.
class ShapeParameters {
 public:
  explicit ShapeParameters(const Arguments& arguments) : arguments_(arguments) {}

  double number(const std::string& name, double fallback);
  int integer(const std::string& name, int fallback);
  std::uint64_t seed() const;
  const std::set<std::string>& known() const { return known_; }

 private:
  const Arguments& arguments_;
  std::set<std::string> known_;
};

struct Shape {
  const char* name;
  const char* help;
  double noise;  ///< of its texture unless --noise says otherwise
  TriangleMesh (*make)(ShapeParameters& p);
};

/// In the order of --help.
const std::vector<Shape>& shape_table();

/// Options that belong to shapes, with their help.
const std::vector<std::pair<const char*, const char*>>& shape_options();

/// \throw UsageError if an option was given that the shape does not take
TriangleMesh make_shape(const Shape& shape, const Arguments& arguments);

}  // namespace onmesh::tools
