/// @file
/// Reads the values of one map into members of a description. A key that is not in the grammar's
/// table, or not of the asked type there, is a defect of ours and throws Error(internal): so no
/// reader can know a key that the grammar does not.
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

/// A view of a checked map. Keys that are left out leave the members at their in-class defaults.
class Fields {
 public:
  /// @param map a map that check_scene() accepted; must outlive this.
  /// @param table what it was checked against.
  Fields(const Node& map, const KeyTable& table) : map_(map), table_(table) {}
  /// The same for a map of a table or variants form.
  Fields(const Node& map, const Form& form);

  const Node& map() const { return map_; }
  const KeyTable& table() const { return table_; }

  /// The value of a key of the table, or nullptr.
  const Node* find(std::string_view key) const;
  /// Where the value stands; where the map stands when it is left out.
  Location place(std::string_view key) const;
  /// The form in which a value that stands is written.
  const Form& form(std::string_view key) const;
  /// The fields of the map under `key`; of an empty map when it is left out.
  Fields below(std::string_view key) const;

  /// Each returns true when the key stands, and then sets `value` (SI).
  bool read(std::string_view key, double& value) const;
  bool read(std::string_view key, Vector3& value) const;
  bool read(std::string_view key, int& value) const;
  bool read(std::string_view key, bool& value) const;
  bool read(std::string_view key, std::string& value) const;
  bool read_numbers(std::string_view key, std::vector<double>& value) const;
  /// A vector of any length but zero, made a unit vector. Throws Error(out-of-range) for zero.
  bool read_direction(std::string_view key, Vector3& value) const;
  /// The word of a choice, or of the key that tells a variants form.
  bool read_word(std::string_view key, std::string& word) const;

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

/// A unit vector of the same direction. Throws Error(out-of-range) for zero, at `place`.
Vector3 unit_vector(const std::vector<double>& numbers, const Location& place);

}  // namespace sinew::scene
