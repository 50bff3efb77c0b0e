/// @file
/// Converts a node to numbers and words, according to a form of the grammar. The checker and the
/// reader share this file, so that values are read exactly as they were checked.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sinew/scene/grammar.hpp"
#include "sinew/scene/node.hpp"

namespace sinew::scene {

/// Selects the form in which `node` is written. Throws Error(wrong-type) if no form matches (the
/// message says what is expected, with `example`), Error(missing-key) if a map has the telltale key
/// of none, Error(not-in-this-version) for a form of a later version.
const Form& select_form(const Node& node, const std::vector<Form>& forms,
                        const std::string& example);

/// Reads the numbers of a quantity (SI) from "10 mm", "0 0 190 mm", 0.19 or a list of these. Throws
/// Error: wrong-type, wrong-length, wrong-dimension, unknown-unit, not-a-number, not-finite, and
/// the kind of the form's range.
std::vector<double> read_numbers(const Node& node, const Form& form);

/// Reads the size of a unit (SI): "mm" is 0.001. Throws what read_numbers() throws.
double read_unit(const Node& node, const Form& form);

/// Reads an integer. Throws Error: wrong-type, and the kind of the form's range.
int read_integer(const Node& node, const Form& form);

/// Reads a word of a choice. Throws Error(wrong-type), Error(unknown-choice) with a suggestion,
/// Error(not-in-this-version).
const Choice& read_choice(const Node& node, const Form& form);

/// Reads free text, a path or a name. Throws Error(wrong-type) if it is empty or not a scalar.
const std::string& read_text(const Node& node);

/// A pair of a samples form: time (s), value (SI).
struct Sample {
  double time = 0.0;
  double value = 0.0;
};
/// Reads the pairs of a samples form. Throws what read_numbers() throws, and Error(empty-list).
std::vector<Sample> read_samples(const Node& node, const Form& form);

/// "did you mean 'mass'? ", or an empty string if no candidate is close.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates);

/// "a, b, c", cut after 14 words.
std::string join(const std::vector<std::string>& words);

/// A user's text for a message: in quotes, cut if long.
std::string show(std::string_view text);

}  // namespace sinew::scene
