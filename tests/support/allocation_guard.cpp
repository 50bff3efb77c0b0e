// Replaces the C library's allocation functions, which operator new and Eigen's aligned allocations
// call.
#include "allocation_guard.hpp"

#include <atomic>
#include <cstdlib>

namespace {
std::atomic<long> count{0};
[[maybe_unused]] void note() { count.fetch_add(1, std::memory_order_relaxed); }
}  // namespace

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define SINEW_COUNTS_ALLOCATIONS 1
extern "C" {
// NOLINTBEGIN(bugprone-reserved-identifier): glibc's names
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t number, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
// NOLINTEND(bugprone-reserved-identifier)

void* malloc(std::size_t size) {
  note();
  return __libc_malloc(size);
}
void* calloc(std::size_t number, std::size_t size) {
  note();
  return __libc_calloc(number, size);
}
void* realloc(void* block, std::size_t size) {
  note();
  return __libc_realloc(block, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  note();
  return __libc_memalign(alignment, size);
}
void* memalign(std::size_t alignment, std::size_t size) {
  note();
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** block, std::size_t alignment, std::size_t size) {
  note();
  *block = __libc_memalign(alignment, size);
  return *block == nullptr ? 12 : 0;
}
}
#endif

namespace sinew::testing {

bool counts_allocations() {
#ifdef SINEW_COUNTS_ALLOCATIONS
  return true;
#else
  return false;
#endif
}

long allocations() { return count.load(std::memory_order_relaxed); }

}  // namespace sinew::testing
