/// @file
/// The grammar of scenes: every key with its type, dimension, default and meaning. The checker and
/// its messages (check.hpp), the reader (fields.hpp), overrides, the reference pages and the JSON
/// Schema (reference.hpp) all use these tables, so that they cannot drift apart.
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/core/error.hpp"
#include "sinew/core/quantity.hpp"
#include "sinew/core/usual_range.hpp"

namespace sinew::scene {

struct KeyTable;

/// The syntactic shape of a value.
enum class Shape {
  quantity,   ///< one or several numbers with a unit: "10 mm", "0 0 190 mm", [0, 0, 0.19]
  unit,       ///< the unit of numbers that are written without one: "mm"
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

/// An interval of allowed numbers.
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

/// One way to write a value. A key may have several forms, which differ in YAML kind or in keys.
struct Form {
  Shape shape = Shape::text;
  Dimension dimension{};        ///< quantity, samples
  Usual usual = Usual::none;    ///< quantity, samples: what it is, by which its size is judged
  std::string unit;             ///< a customary unit of the dimension, for examples
  int min_count = 1;            ///< of the numbers of a quantity, or the items of a list
  int max_count = 1;            ///< see min_count
  Range range;                  ///< of each number
  std::vector<Choice> choices;  ///< choice, variants; reference: words in place of a name
  std::string refers_to;        ///< reference, names: the top-level key that defines the names
  bool takes_planes = false;    ///< reference to a body: it may be a plane
  /// table, variants: the key by which this form is recognised; choice: the key of the map form
  /// that a single word abbreviates
  std::string telltale;
  std::shared_ptr<const KeyTable> table;  ///< table
  std::vector<Form> items;                ///< list, names: the forms of an item
  bool loose = false;                     ///< choice: only letters and digits are compared
  bool later = false;                     ///< belongs to a later version
};

/// One key of a map.
struct Key {
  std::string name;
  std::vector<Form> forms;
  std::string example{};       ///< as it would be written after "name: "
  std::string default_text{};  ///< YAML equivalent to omitting the key; may be empty
  std::string description{};
  bool required = false;
  bool later = false;       ///< belongs to a later version
  std::string only_with{};  ///< the key without which this one is refused
};

/// Keys of which a map may have at most one or, if `required`, must have exactly one.
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
  /// For the reference: the table described in place of this one, if they differ only in dimension.
  std::shared_ptr<const KeyTable> stand_in{};
  /// For the reference: the table that describes the keys that both tables have.
  std::shared_ptr<const KeyTable> shared{};

  const Key* find(std::string_view key) const;
  /// The names of all keys except those of later versions, for messages and suggestions.
  std::vector<std::string> key_names() const;
  /// The group of alternatives that contains `key`, or nullptr.
  const Alternatives* alternatives_of(std::string_view key) const;
};

/// The table of a whole scene, which leads to all other tables. Built at the first call.
const KeyTable& grammar();

/// The only form of `key` with the given shape. Throws Error(internal) if the table has none, since
/// a reader that asks for a form outside the grammar has a bug.
const Form& form_of(const KeyTable& table, std::string_view key, Shape shape);

/// Describes a form for messages and the reference: "an acceleration such as 9.81 m/s^2", "one of
/// volume, even".
std::string describe(const Form& form);
/// Describes several forms, joined by "or".
std::string describe(const std::vector<Form>& forms);

}  // namespace sinew::scene
