#include "onmesh/base/large_array.h"

#include <sys/mman.h>

#include <cstdlib>

namespace onmesh {
namespace {

constexpr std::size_t kHugePage = std::size_t{1} << 21;
/// Smaller ones would waste much of their last page.
constexpr std::size_t kLarge = 4 * kHugePage;

}  // namespace

void* allocate_large(std::size_t bytes) {
  if (bytes < kLarge) {
    void* const memory = std::malloc(bytes > 0 ? bytes : 1);
    if (memory == nullptr) throw std::bad_alloc();
    return memory;
  }
  if (bytes > std::size_t(-1) - kHugePage) throw std::bad_alloc();
  const std::size_t whole = (bytes + kHugePage - 1) / kHugePage * kHugePage;
  void* const memory = std::aligned_alloc(kHugePage, whole);
  if (memory == nullptr) throw std::bad_alloc();
  ::madvise(memory, whole, MADV_HUGEPAGE);  // where that is not possible there are small ones
  return memory;
}

void free_large(void* memory) { std::free(memory); }

}  // namespace onmesh
