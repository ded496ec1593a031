// Arrays of hundreds of megabytes that are written once, by all threads (internal).
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace onmesh {

/// Leaves new elements as the memory was, so that the threads that fill an array are the first to
/// touch its pages, and asks for large pages, which take a small part of the time to get.
template <class T>
struct LargeAllocator {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);
  using value_type = T;

  LargeAllocator() = default;
  template <class U>
  LargeAllocator(const LargeAllocator<U>&) {}

  T* allocate(std::size_t count) {
    if (!is_large(count)) return std::allocator<T>().allocate(count);
    const std::size_t bytes = count * sizeof(T);
    void* const memory = std::aligned_alloc(kPage, (bytes + kPage - 1) / kPage * kPage);
    if (memory == nullptr) throw std::bad_alloc();
    madvise(memory, bytes, MADV_HUGEPAGE);  // fails harmlessly where there are none
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t count) {
    if (is_large(count)) {
      std::free(memory);
    } else {
      std::allocator<T>().deallocate(memory, count);
    }
  }

  template <class U>
  void construct(U*) {}
  template <class U, class... Values>
  void construct(U* at, Values&&... values) {
    ::new (static_cast<void*>(at)) U{std::forward<Values>(values)...};
  }

  bool operator==(const LargeAllocator&) const { return true; }

 private:
  static constexpr std::size_t kPage = 2 << 20;  // bytes
  static bool is_large(std::size_t count) { return count > 2 * kPage / sizeof(T); }
};

/// resize() does not set new elements.
template <class T>
using LargeArray = std::vector<T, LargeAllocator<T>>;

}  // namespace onmesh
