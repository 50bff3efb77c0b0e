/// @file
/// The grammar of scenes, once: every key with its type, dimension, default and meaning. The
/// checker and its messages (check.hpp), the reader (fields.hpp), overrides, the reference page and
/// the JSON Schema (reference.hpp) all come from these tables, so that they cannot drift apart.
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/core/error.hpp"
#include "sinew/core/quantity.hpp"

namespace sinew::scene {

struct KeyTable;

/// What a value looks like.
enum class Shape {
  quantity,   ///< one or several numbers with a unit: "10 mm", "0 0 190 mm", [0, 0, 0.19]
  unit,       ///< what a number without a unit means: "mm"
  integer,    ///< a whole number
  boolean,    ///< true or false
  text,       ///< free text
  choice,     ///< one word of several
  file,       ///< a path, relative to the scene's folder
  reference,  ///< the name of something defined elsewhere in the scene
  list,       ///< [item, item, ...]
  samples,    ///< [[time, value], ...]
  table,      ///< a map with the keys of a table
  variants,   ///< a map whose keys depend on the word under one of them, such as `type`
  names,      ///< a map from names that the user chooses to items
};

/// Allowed numbers.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool above_min = false;  ///< min itself is not allowed
  bool below_max = false;  ///< max itself is not allowed
  ErrorKind kind = ErrorKind::out_of_range;
};

/// A word that a choice may take.
struct Choice {
  std::string word;
  std::string description;
  bool later = false;                       ///< belongs to a later version
  std::shared_ptr<const KeyTable> table{};  ///< variants: the keys that go with the word
};

/// One way to write a value; a key may offer several that differ in YAML kind or in their keys.
struct Form {
  Shape shape = Shape::text;
  Dimension dimension{};        ///< quantity, samples
  std::string unit;             ///< a customary unit of the dimension, for examples
  int min_count = 1;            ///< numbers of a quantity, items of a list
  int max_count = 1;            ///< see min_count
  Range range;                  ///< of each number
  std::vector<Choice> choices;  ///< choice, variants; reference: words in place of a name
  std::string refers_to;        ///< reference, names: the top-level key whose names are meant
  /// table, variants: the key that tells this form by; choice: the key of the map form that a lone
  /// word is short for
  std::string telltale;
  std::shared_ptr<const KeyTable> table;  ///< table
  std::vector<Form> items;                ///< list, names: the forms of an item
  bool loose = false;                     ///< choice: its letters and digits alone count
  bool later = false;                     ///< belongs to a later version
};

/// One key of a map.
struct Key {
  std::string name;
  std::vector<Form> forms;
  std::string example{};       ///< as it would be written after "name: "
  std::string default_text{};  ///< YAML that means the same as leaving the key out; may be empty
  std::string description{};
  bool required = false;
  bool later = false;       ///< belongs to a later version
  std::string only_with{};  ///< makes sense only beside this key
};

/// Keys of which at most one, or exactly one, may stand in a map.
struct Alternatives {
  std::vector<std::string> keys;
  bool required = false;
};

/// The keys of one kind of map.
struct KeyTable {
  std::string name;  ///< "cable"; the heading in the reference
  std::string description;
  std::vector<Key> keys{};
  std::vector<Alternatives> alternatives{};
  /// Reference: the table that is described in place of this one, which differs in dimension alone.
  std::shared_ptr<const KeyTable> stand_in{};
  /// Reference: the table under which the keys that both have are described.
  std::shared_ptr<const KeyTable> shared{};

  const Key* find(std::string_view key) const;
  /// The names of all keys, for messages and suggestions; keys of later versions left out.
  std::vector<std::string> key_names() const;
  /// The alternatives that hold `key`, or nullptr.
  const Alternatives* alternatives_of(std::string_view key) const;
};

/// The table of a whole scene; everything else hangs from it. Built at the first call.
const KeyTable& grammar();

/// The only form of `key` with the given shape; throws Error(internal) when the table has none: a
/// reader that asks for what the grammar does not offer is a defect of ours.
const Form& form_of(const KeyTable& table, std::string_view key, Shape shape);

/// "an acceleration such as 9.81 m/s^2", "one of volume, even", ... for messages and the reference.
std::string describe(const Form& form);
/// The forms joined by "or".
std::string describe(const std::vector<Form>& forms);

}  // namespace sinew::scene
