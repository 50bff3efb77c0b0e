#include "sinew/linalg/factor_memory.hpp"

#include <algorithm>
#include <thread>
#include <utility>

namespace sinew::linalg {

FactorMemory::FactorMemory(std::size_t doubles) : doubles_(doubles) {
  free_.reserve(std::max(1U, std::thread::hardware_concurrency()));
}

AlignedBuffer FactorMemory::take() {
  {
    const std::lock_guard lock(mutex_);
    if (!free_.empty()) {
      AlignedBuffer buffer = std::move(free_.back());
      free_.pop_back();
      return buffer;
    }
  }
  return AlignedBuffer(doubles_);
}

void FactorMemory::give_back(AlignedBuffer buffer) {
  const std::lock_guard lock(mutex_);
  if (free_.size() < free_.capacity()) free_.push_back(std::move(buffer));
}

}  // namespace sinew::linalg
