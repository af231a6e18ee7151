// Asks the kernel for large pages where an array is large.
#include "core/aligned.h"

#include <sys/mman.h>

namespace motes {
namespace {

constexpr std::size_t large_page_bytes = std::size_t{1} << 21;

std::align_val_t alignment_of(std::size_t bytes) {
  return std::align_val_t{bytes >= 2 * large_page_bytes ? large_page_bytes : cache_line_bytes};
}

}  // namespace

void* allocate_aligned(std::size_t bytes) {
  void* const p = ::operator new(bytes, alignment_of(bytes));
#ifdef MADV_HUGEPAGE
  // Whole pages only: the rest may be shared with other arrays. A refusal costs nothing but speed.
  if (bytes >= 2 * large_page_bytes) {
    madvise(p, bytes / large_page_bytes * large_page_bytes, MADV_HUGEPAGE);
  }
#endif
  return p;
}

void deallocate_aligned(void* p, std::size_t bytes) { ::operator delete(p, alignment_of(bytes)); }

}  // namespace motes
