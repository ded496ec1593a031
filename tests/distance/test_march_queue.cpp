#include "onmesh/distance/march_queue.h"

#include <catch2/catch.hpp>

namespace onmesh::unfold {
namespace {

template <class Queue>
std::vector<Index> pop_all(Queue& queue) {
  std::vector<Index> order;
  while (const std::optional<Index> node = queue.pop()) order.push_back(*node);
  return order;
}

TEST_CASE("a queue gives what was told first, once, and takes it again", "[unfold]") {
  FirstInFirstOut<float> queue(3);
  CHECK_FALSE(queue.pop());
  for (int round = 0; round < 3; ++round) {  // around the end of its memory
    for (const Index node : {2U, 0U, 2U, 1U, 0U}) queue.push(node, 0);
    CHECK(queue.pop() == 2);
    queue.push(2, 0);
    CHECK(pop_all(queue) == std::vector<Index>{0, 1, 2});
  }
}

TEST_CASE("nearest first goes by the least distance a node was told with", "[unfold]") {
  NearestFirst<double> queue(4);
  CHECK_FALSE(queue.pop());
  for (int round = 0; round < 3; ++round) {
    queue.push(0, 3);
    queue.push(1, 2);
    queue.push(2, 5);
    queue.push(3, 2);
    queue.push(2, 1);  // came closer
    queue.push(1, 4);  // did not
    CHECK(pop_all(queue) == std::vector<Index>{2, 1, 3, 0});
  }
}

TEST_CASE("a node that was taken may be farther when it is told again", "[unfold]") {
  NearestFirst<double> queue(2);
  queue.push(0, 1);
  CHECK(queue.pop() == 0);
  queue.push(0, 7);
  queue.push(1, 3);
  CHECK(pop_all(queue) == std::vector<Index>{1, 0});
}

}  // namespace
}  // namespace onmesh::unfold
