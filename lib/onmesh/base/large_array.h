// Arrays of hundreds of megabytes that are written once, by all threads.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace onmesh {

/// Memory for an array, aligned for anything. What is large is asked for in huge pages where the
/// system has them: an array that is written once is otherwise a quarter of a million page faults
/// per gigabyte.
/// \throw std::bad_alloc if there is not so much
void* allocate_large(std::size_t bytes);
/// \param memory from allocate_large(); null is fine
void free_large(void* memory);

/// Leaves new elements as the memory was, so that the threads that fill an array are the first to
/// touch its pages.
template <class T>
struct RawAllocator : std::allocator<T> {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);
  /// The same for elements of another type, as the standard's containers ask for it.
  template <class U>
  struct rebind {
    /// That type.
    using other = RawAllocator<U>;
  };

  /// As allocate_large().
  T* allocate(std::size_t count) {
    if (count > std::size_t(-1) / sizeof(T)) throw std::bad_array_new_length();
    return static_cast<T*>(allocate_large(count * sizeof(T)));
  }
  /// As free_large().
  void deallocate(T* elements, std::size_t) { free_large(elements); }

  /// Without values an element stays as it is.
  template <class U>
  void construct(U*) {}
  /// With values it is made from them.
  template <class U, class... Values>
  void construct(U* at, Values&&... values) {
    ::new (static_cast<void*>(at)) U{std::forward<Values>(values)...};
  }
};

/// resize() does not set new elements.
template <class T>
using LargeArray = std::vector<T, RawAllocator<T>>;

}  // namespace onmesh
