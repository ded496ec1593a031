// A race in the body of a parallel loop, which thread sanitizer must report, and loops without one,
// of which it must say nothing. Built and run with the sanitizer only.
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_reduce.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <cstdio>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

constexpr int kThreads = 4;
using Range = tbb::blocked_range<std::size_t>;

int unguarded = 0;
std::atomic<int> arrived{0};

/// Returns once two threads are in it. Relaxed: the wait must not order what they do.
[[gnu::noinline]] void race_planted_here() {
  arrived.fetch_add(1, std::memory_order_relaxed);
  while (arrived.load(std::memory_order_relaxed) < 2) {
  }
  ++unguarded;
}

void race() {
  tbb::parallel_for(
      0, 2, [](int) { race_planted_here(); }, tbb::simple_partitioner());
}

/// What the library's loops do: write parts of an array, sum, keep scratch memory per thread,
/// throw.
double loops_without_a_race() {
  double total = 0;
  for (int round = 0; round < 20; ++round) {
    std::vector<double> values(50000);
    tbb::parallel_for(Range(0, values.size(), 64), [&](const Range& range) {
      for (std::size_t i = range.begin(); i < range.end(); ++i) values[i] = double(i) + round;
    });
    total += tbb::parallel_reduce(
        Range(0, values.size(), 64), 0.0,
        [&](const Range& range, double sum) {
          for (std::size_t i = range.begin(); i < range.end(); ++i) sum += values[i];
          return sum;
        },
        std::plus<>());
    tbb::enumerable_thread_specific<std::vector<double>> scratch;
    tbb::parallel_for(std::size_t(0), values.size(),
                      [&](std::size_t i) { scratch.local().push_back(values[i]); });
    for (const std::vector<double>& part : scratch) total += double(part.size());
    std::vector<double> left, right;
    tbb::parallel_invoke([&] { left.assign(1000, 1); }, [&] { right.assign(1000, 2); });
    total += left.back() + right.back();
    try {
      tbb::parallel_for(0, 1000, [](int i) {
        if (i == 500) throw std::runtime_error("stop");
      });
    } catch (const std::runtime_error&) {
      ++total;
    }
  }
  return total;
}

}  // namespace

int main(int argc, char** argv) {
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, kThreads);
  const bool without = argc > 1 && std::string(argv[1]) == "--without";
  double total = 0;
  tbb::task_arena(kThreads).execute([&] {
    if (without) {
      total = loops_without_a_race();
    } else {
      race();
    }
  });
  std::printf("%g\n", total + unguarded);
  return 0;
}
