/// @file
/// Arrays of doubles aligned to cache lines; large ones use huge pages if the system has them.
#pragma once

#include <cstddef>
#include <memory>

namespace sinew::linalg {

/// An array of a fixed number of doubles, initially zero.
class AlignedBuffer {
 public:
  AlignedBuffer() = default;
  explicit AlignedBuffer(std::size_t count);

  double* data() { return data_.get(); }
  const double* data() const { return data_.get(); }
  std::size_t size() const { return size_; }
  std::size_t bytes() const { return size_ * sizeof(double); }

 private:
  struct Free {
    void operator()(double* pointer) const;
  };
  std::unique_ptr<double, Free> data_;
  std::size_t size_ = 0;
};

}  // namespace sinew::linalg
