// Arrays of hundreds of megabytes that are written once, by all threads.
#pragma once

#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace onmesh {

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
