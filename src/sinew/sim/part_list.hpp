/// @file
/// A list of parts as those see it who may only read.
#pragma once

#include <cstddef>
#include <iterator>
#include <memory>
#include <vector>

namespace sinew::sim {

/// Parts that others own, each const: a vector of unique_ptr would hand them out to be changed.
/// Valid as long as the vector.
template <typename Part>
class PartList {
 public:
  class Iterator {
   public:
    using value_type = Part;
    using difference_type = std::ptrdiff_t;

    Iterator() = default;
    explicit Iterator(const std::unique_ptr<Part>* at) : at_(at) {}
    const Part& operator*() const { return **at_; }
    const Part* operator->() const { return at_->get(); }
    Iterator& operator++() {
      ++at_;
      return *this;
    }
    Iterator operator++(int) { return Iterator(at_++); }
    bool operator==(const Iterator&) const = default;

   private:
    const std::unique_ptr<Part>* at_ = nullptr;
  };

  explicit PartList(const std::vector<std::unique_ptr<Part>>& parts) : parts_(&parts) {}

  std::size_t size() const { return parts_->size(); }
  bool empty() const { return parts_->empty(); }
  Iterator begin() const { return Iterator(parts_->data()); }
  Iterator end() const { return Iterator(parts_->data() + parts_->size()); }

 private:
  const std::vector<std::unique_ptr<Part>>* parts_;
};

}  // namespace sinew::sim
