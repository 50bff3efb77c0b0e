#include "sinew/linalg/thread_scratch.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "sinew/core/error.hpp"
#include "sinew/linalg/aligned_buffer.hpp"

namespace sinew::linalg {

namespace {

constexpr std::size_t kLine = 8;  // doubles per cache line

struct Memory {
  AlignedBuffer buffer;
  bool leased = false;
};

thread_local Memory memory;

std::size_t whole_lines(std::size_t count) { return (count + kLine - 1) / kLine * kLine; }

}  // namespace

ThreadScratch::ThreadScratch(std::size_t count) {
  if (memory.leased) {
    throw Error(ErrorKind::internal, {}, "this thread's scratch memory is in use", "");
  }
  if (memory.buffer.size() < count) {
    memory.buffer = AlignedBuffer();  // freed first, so that both never exist at a time
    memory.buffer = AlignedBuffer(whole_lines(count));
  }
#ifndef NDEBUG
  // Reading uninitialised values then gives NaN.
  std::fill_n(memory.buffer.data(), memory.buffer.size(), std::numeric_limits<double>::quiet_NaN());
#endif
  memory.leased = true;
}

ThreadScratch::~ThreadScratch() { memory.leased = false; }

double* ThreadScratch::take(std::size_t count) {
  if (count == 0) return nullptr;
  const std::size_t end = used_ + whole_lines(count);
  if (end > memory.buffer.size()) {
    throw Error(ErrorKind::internal, {}, "more scratch memory is taken than was asked for", "");
  }
  return memory.buffer.data() + std::exchange(used_, end);
}

}  // namespace sinew::linalg
