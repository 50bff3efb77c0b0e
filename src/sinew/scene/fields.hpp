/// @file
/// Reads the values of one map into members of a description. Reading a key that is not in the
/// grammar's table, or has another type there, is a bug and throws Error(internal). So no reader
/// can know a key that the grammar does not.
#pragma once

#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/scene/grammar.hpp"
#include "sinew/scene/node.hpp"
#include "sinew/scene/values.hpp"

namespace sinew::scene {

/// A view of a checked map. If a key is omitted, its member keeps its in-class default.
class Fields {
 public:
  /// @param map a map that check_scene() accepted; must outlive this.
  /// @param table that the map was checked against.
  Fields(const Node& map, const KeyTable& table) : map_(map), table_(table) {}
  /// As above, for a map that is written in a table or variants form.
  Fields(const Node& map, const Form& form);

  const Node& map() const { return map_; }
  const KeyTable& table() const { return table_; }
  /// Whether the table has a key, written or not: kinds differ in their keys.
  bool may_have(std::string_view key) const { return table_.find(key) != nullptr; }

  /// The value of a key, or nullptr if it is omitted.
  const Node* find(std::string_view key) const;
  /// Location of the value; that of the map if the key is omitted.
  Location place(std::string_view key) const;
  /// The form in which the value is written. The key must not be omitted.
  const Form& form(std::string_view key) const;
  /// The fields of the map under `key`; those of an empty map if the key is omitted.
  Fields below(std::string_view key) const;

  /// Sets `value` (SI) and returns true if the map has the key; otherwise returns false.
  bool read(std::string_view key, double& value) const;
  bool read(std::string_view key, Vector3& value) const;
  bool read(std::string_view key, int& value) const;
  bool read(std::string_view key, bool& value) const;
  bool read(std::string_view key, std::string& value) const;
  bool read_numbers(std::string_view key, std::vector<double>& value) const;
  /// Reads a non-zero vector and normalises it. Throws Error(out-of-range) for the zero vector.
  bool read_direction(std::string_view key, Vector3& value) const;
  /// Reads the word of a choice, or of the key that selects a variant.
  bool read_word(std::string_view key, std::string& word) const;

  /// Reads the word of a choice and sets `value` to its meaning.
  template <typename Enum>
  bool read_choice(std::string_view key, Enum& value,
                   std::initializer_list<std::pair<const char*, Enum>> meanings) const {
    std::string word;
    if (!read_word(key, word)) return false;
    for (const auto& [name, meaning] : meanings) {
      if (word == name) {
        value = meaning;
        return true;
      }
    }
    throw_without_meaning(key, word);
  }

 private:
  [[noreturn]] void throw_without_meaning(std::string_view key, const std::string& word) const;

  const Node& map_;
  const KeyTable& table_;
};

/// Normalises a vector. Throws Error(out-of-range) at `place` for the zero vector.
Vector3 unit_vector(const std::vector<double>& numbers, const Location& place);

}  // namespace sinew::scene
