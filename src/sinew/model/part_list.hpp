/// @file
/// A read-only list of parts.
#pragma once

#include <cstddef>
#include <iterator>
#include <memory>
#include <vector>

namespace sinew::model {

/// A read-only view of parts owned by a vector of unique_ptr; the vector itself would allow the
/// parts to be modified. Valid as long as the vector.
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

}  // namespace sinew::model
