#include "onmesh/poisson/candidates.h"

#include <CGAL/Random.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/point_generators_3.h>

namespace onmesh {

namespace {

constexpr double kMostInPart = 4096;

void divide(const CandidatePart& part, std::vector<CandidatePart>& parts) {
  if (part.count <= kMostInPart) {
    parts.push_back(part);
    return;
  }
  const auto& c = part.corners;
  const std::array<Vec3, 3> middles = {(c[1] + c[2]) / 2, (c[2] + c[0]) / 2, (c[0] + c[1]) / 2};
  const double count = part.count / 4;
  divide({part.face, {c[0], middles[2], middles[1]}, count}, parts);
  divide({part.face, {c[1], middles[0], middles[2]}, count}, parts);
  divide({part.face, {c[2], middles[1], middles[0]}, count}, parts);
  divide({part.face, middles, count}, parts);
}

}  // namespace

std::vector<CandidatePart> candidate_parts(const TriangleMesh& mesh, const SpacingField& field,
                                           const std::vector<Index>& faces) {
  std::vector<CandidatePart> parts;
  for (const Index f : faces) {
    const double most = field.most(f);
    const double count = kPoissonDensity * mesh.face_area(f) / (most * most);
    divide({f, {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()}, count}, parts);
  }
  return parts;
}

void throw_candidates_at(const CandidatePart& part, SplitMix& random, const DiskSet& disks,
                         ConnectedBall& ball, DartBlock& block) {
  const auto count = std::size_t(part.count + random.uniform());
  if (count == 0) return;
  // CGAL's mesh generators don't tell the face, and draw the point in it from a global generator.
  // So the triangle given to CGAL is that of barycentric coordinates.
  using Point = CGAL::Simple_cartesian<double>::Point_3;
  const auto point = [](const Vec3& p) { return Point(p.x(), p.y(), p.z()); };
  CGAL::Random source(unsigned(random.next() >> 32));
  CGAL::Random_points_in_triangle_3<Point> points(point(part.corners[0]), point(part.corners[1]),
                                                  point(part.corners[2]), source);
  for (std::size_t i = 0; i < count; ++i, ++points) {
    const Vec3 barycentric(points->x(), points->y(), points->z());
    const SurfacePoint candidate{part.face, barycentric.cwiseMax(0.0) / barycentric.sum()};
    const Vec3 position = disks.mesh().position(candidate);
    const double spacing = disks.field().at(part.face, position);
    if (disks.room(candidate, position, spacing, ball, true) < spacing) continue;
    block.add(candidate, position, spacing, random.next(), ball.result());
  }
}

}  // namespace onmesh
