#include "onmesh/mesh/segment_tree.h"

#include <catch2/catch.hpp>
#include <set>

#include "onmesh/base/triangle.h"
#include "support/random_vector.h"

namespace onmesh {
namespace {

std::vector<SegmentTree::Segment> random_points(std::size_t count, std::mt19937& random) {
  std::vector<SegmentTree::Segment> points;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 p = random_vector(random);
    points.push_back({p, p});
  }
  return points;
}

/// The points that are visited around a segment. None is visited twice.
std::set<Index> visited(const SegmentTree& tree, const Vec3& a, const Vec3& b, double radius) {
  std::set<Index> numbers;
  tree.visit_near(a, b, radius, [&](Index i) {
    CHECK(numbers.insert(i).second);
    return radius;
  });
  return numbers;
}

TEST_CASE("all points within the radius and their own reach are visited", "[segment_tree]") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0, 0.5);
  const auto points = random_points(500, random);
  std::vector<double> reaches;
  for (std::size_t i = 0; i < points.size(); ++i) reaches.push_back(uniform(random));
  const SegmentTree with(points, reaches), without(points);
  for (int k = 0; k < 50; ++k) {
    const Vec3 a = random_vector(random), b = random_vector(random);
    const double radius = uniform(random);
    const std::set<Index> few = visited(with, a, b, radius), more = visited(without, a, b, radius);
    for (Index i = 0; i < points.size(); ++i) {
      double position = 0;
      const double d2 = squared_distance_to_segment(points[i][0], a, b, &position);
      if (d2 > radius * radius) continue;
      CHECK(more.count(i) == 1);
      if (d2 <= reaches[i] * reaches[i]) CHECK(few.count(i) == 1);
    }
  }
}

TEST_CASE("small neighbours of something large are passed by", "[segment_tree]") {
  std::mt19937 random(4);
  const auto points = random_points(5000, random);
  const SegmentTree tree(points, std::vector<double>(points.size(), 1e-6));
  const double everywhere = 10;
  CHECK(visited(tree, Vec3::Zero(), Vec3::Zero(), everywhere).size() < 50);
}

}  // namespace
}  // namespace onmesh
