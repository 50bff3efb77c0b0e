#include "sinew/scene/fields.hpp"

#include <fmt/format.h>

#include "sinew/scene/check.hpp"

namespace sinew::scene {

Fields::Fields(const Node& map, const Form& form) : Fields(map, table_of(map, form)) {}

const Node* Fields::find(std::string_view key) const {
  if (table_.find(key) == nullptr) {
    throw Error(ErrorKind::internal, map_.place(),
                fmt::format("the grammar's {} has no key {}", table_.name, key), "report this");
  }
  return map_.find(key);
}

Location Fields::place(std::string_view key) const {
  const Node* node = find(key);
  return node != nullptr ? node->place() : map_.place();
}

const Form& Fields::form(std::string_view key) const {
  const Node* node = find(key);
  const Key& entry = *table_.find(key);
  return select_form(node != nullptr ? *node : map_, entry.forms, entry.example);
}

Fields Fields::below(std::string_view key) const {
  static const Node empty = Node::map();
  const Node* node = find(key);
  if (node != nullptr) return {*node, form(key)};
  return {empty, *form_of(table_, key, Shape::table).table};
}

bool Fields::read(std::string_view key, double& value) const {
  const Node* node = find(key);
  if (node == nullptr) return false;
  const Form& written = form(key);
  value = written.shape == Shape::unit
              ? read_unit(*node, written)
              : scene::read_numbers(*node, form_of(table_, key, Shape::quantity)).front();
  return true;
}

bool Fields::read(std::string_view key, Vector3& value) const {
  const Node* node = find(key);
  if (node == nullptr) return false;
  const std::vector<double> numbers =
      scene::read_numbers(*node, form_of(table_, key, Shape::quantity));
  value = Vector3(numbers.at(0), numbers.at(1), numbers.at(2));
  return true;
}

bool Fields::read(std::string_view key, int& value) const {
  const Node* node = find(key);
  if (node != nullptr) value = read_integer(*node, form_of(table_, key, Shape::integer));
  return node != nullptr;
}

bool Fields::read(std::string_view key, bool& value) const {
  const Node* node = find(key);
  if (node != nullptr) value = node->as_boolean();
  return node != nullptr;
}

bool Fields::read(std::string_view key, std::string& value) const {
  const Node* node = find(key);
  if (node != nullptr) value = read_text(*node);
  return node != nullptr;
}

bool Fields::read_numbers(std::string_view key, std::vector<double>& value) const {
  const Node* node = find(key);
  if (node != nullptr) value = scene::read_numbers(*node, form_of(table_, key, Shape::quantity));
  return node != nullptr;
}

bool Fields::read_direction(std::string_view key, Vector3& value) const {
  std::vector<double> numbers;
  if (!read_numbers(key, numbers)) return false;
  value = unit_vector(numbers, place(key));
  return true;
}

bool Fields::read_word(std::string_view key, std::string& word) const {
  const Node* node = find(key);
  if (node != nullptr) word = scene::read_choice(*node, form_of(table_, key, Shape::choice)).word;
  return node != nullptr;
}

void Fields::throw_without_meaning(std::string_view key, const std::string& word) const {
  throw Error(ErrorKind::internal, place(key),
              fmt::format("the reader does not know {} of {}", word, key), "report this");
}

Vector3 unit_vector(const std::vector<double>& numbers, const Location& place) {
  const Vector3 vector(numbers.at(0), numbers.at(1), numbers.at(2));
  const double length = vector.stableNorm();
  if (length > 0.0) return vector / length;
  throw Error(ErrorKind::out_of_range, place, "the vector has no length",
              "write a direction such as 0 0 1");
}

}  // namespace sinew::scene
