#include "sinew/core/part_visitor.hpp"

#include <array>

namespace sinew {

PartVisitor& PartVisitor::list(std::string_view name, std::string_view unit, double value) {
  if (list_ == nullptr) return *this;
  std::string path = path_;
  if (!path.empty() && !name.empty()) path += '.';
  path += name;
  list_->push_back({std::move(path), std::string(unit), value});
  return *this;
}

PartVisitor& PartVisitor::number(std::string_view name, std::string_view unit,
                                 const Vector3& value) {
  hash_.add(value);
  if (list_ == nullptr) return *this;
  constexpr std::array kAxes{".x", ".y", ".z"};
  for (std::size_t c = 0; c < kAxes.size(); ++c) {
    list(std::string(name) + kAxes[c], unit, value[static_cast<Eigen::Index>(c)]);
  }
  return *this;
}

PartVisitor& PartVisitor::number(std::string_view name, std::string_view unit,
                                 const std::optional<double>& value) {
  hash_.add(value);
  if (value) list(name, unit, *value);
  return *this;
}

PartVisitor& PartsVisitor::part(const std::string& name, const std::optional<std::string>& path) {
  return parts_.emplace_back(Part{prefix_ + name, {path.value_or(path_), list_}}).visitor;
}

void PartsVisitor::enter(std::string prefix, std::string path) {
  prefix_ = std::move(prefix);
  path_ = std::move(path);
}

std::vector<NamedHash> PartsVisitor::hashes() const {
  std::vector<NamedHash> result;
  for (const Part& part : parts_) result.push_back({part.name, part.visitor.hash()});
  return result;
}

}  // namespace sinew
