#include "sinew/linalg/aligned_buffer.hpp"

#include <cstdlib>
#include <cstring>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace sinew::linalg {

namespace {
constexpr std::size_t kCacheLine = 64;
constexpr std::size_t kHugePage = std::size_t{2} << 20;
}  // namespace

AlignedBuffer::AlignedBuffer(std::size_t count) : size_(count) {
  if (count == 0) return;
  const std::size_t wanted = count * sizeof(double);
  const std::size_t alignment = wanted >= kHugePage ? kHugePage : kCacheLine;
  const std::size_t bytes = (wanted + alignment - 1) / alignment * alignment;
  auto* const pointer = static_cast<double*>(std::aligned_alloc(alignment, bytes));
  if (pointer == nullptr) throw std::bad_alloc();
  data_.reset(pointer);
#if defined(__linux__)
  // The factor of a large mesh spans thousands of small pages, whose address translation costs a
  // tenth of the factorisation. This is only advice, so a refusal is no error.
  if (alignment == kHugePage) static_cast<void>(madvise(pointer, bytes, MADV_HUGEPAGE));
#endif
  std::memset(static_cast<void*>(pointer), 0, bytes);
}

void AlignedBuffer::Free::operator()(double* pointer) const { std::free(pointer); }

}  // namespace sinew::linalg
