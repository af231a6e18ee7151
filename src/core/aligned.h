// Storage that loads straight into vectors: 64-byte aligned, and large arrays in large pages.
#pragma once

#include <cstddef>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace motes {

inline constexpr std::size_t cache_line_bytes = 64;

/// Memory aligned to a cache line; from a few MiB on to the large pages of the machine, which the
/// kernel is asked for: random access to gigabytes then misses the cache only, not the page table
/// too. Throws std::bad_alloc.
void* allocate_aligned(std::size_t bytes);
void deallocate_aligned(void* p, std::size_t bytes);

template <class T>
struct AlignedAllocator {
  using value_type = T;
  AlignedAllocator() = default;
  template <class U>
  explicit AlignedAllocator(const AlignedAllocator<U>&) {}
  template <class U>
  struct rebind {
    using other = AlignedAllocator<U>;
  };
  T* allocate(std::size_t n) { return static_cast<T*>(allocate_aligned(n * sizeof(T))); }
  void deallocate(T* p, std::size_t n) { deallocate_aligned(p, n * sizeof(T)); }
  template <class U>
  bool operator==(const AlignedAllocator<U>&) const {
    return true;
  }
};

template <class T>
using AlignedVector = std::vector<T, AlignedAllocator<T>>;

/// Leaves new elements as they are: for arrays that threads fill together, each touching its own
/// part first.
template <class T>
struct UninitializedAllocator : AlignedAllocator<T> {
  static_assert(std::is_trivially_copyable_v<T>);
  UninitializedAllocator() = default;
  template <class U>
  explicit UninitializedAllocator(const UninitializedAllocator<U>&) {}
  template <class U>
  struct rebind {
    using other = UninitializedAllocator<U>;
  };
  template <class U, class... Args>
  void construct(U* p, Args&&... args) {
    if constexpr (sizeof...(Args) == 0) {
      ::new (static_cast<void*>(p)) U;
    } else {
      ::new (static_cast<void*>(p)) U(std::forward<Args>(args)...);
    }
  }
};

/// An array whose size is set first and whose elements are all written afterwards.
template <class T>
using UninitializedVector = std::vector<T, UninitializedAllocator<T>>;

}  // namespace motes
