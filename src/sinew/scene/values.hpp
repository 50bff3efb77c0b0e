/// @file
/// From a node to numbers and words, as a form of the grammar says. Shared by the checker and the
/// reader, so that what was accepted is what is read.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sinew/scene/grammar.hpp"
#include "sinew/scene/node.hpp"

namespace sinew::scene {

/// The form that `node` is written in. Throws Error(wrong-type) when it is none of them (naming
/// what is expected, with `example`), Error(missing-key) when no map form can be told by its key,
/// Error(not-in-this-version) for a form of a later version.
const Form& select_form(const Node& node, const std::vector<Form>& forms,
                        const std::string& example);

/// The numbers of a quantity (SI), from "10 mm", "0 0 190 mm", 0.19 or a list of such. Throws
/// Error: wrong-type, wrong-length, wrong-dimension, unknown-unit, not-a-number, not-finite, and
/// the kind of the form's range.
std::vector<double> read_numbers(const Node& node, const Form& form);

/// What one unit is (SI): "mm" is 0.001. Throws as read_numbers().
double read_unit(const Node& node, const Form& form);

/// Throws Error(wrong-type), Error(out-of-range).
int read_integer(const Node& node, const Form& form);

/// A word of a choice. Throws Error(wrong-type), Error(unknown-choice) with a suggestion,
/// Error(not-in-this-version).
const Choice& read_choice(const Node& node, const Form& form);

/// Free text, a path or a name. Throws Error(wrong-type) when it is empty or no scalar.
const std::string& read_text(const Node& node);

/// A pair of a samples form: time (s), value (SI).
struct Sample {
  double time = 0.0;
  double value = 0.0;
};
/// The pairs of a samples form. Throws as read_numbers(), and Error(empty-list).
std::vector<Sample> read_samples(const Node& node, const Form& form);

/// "did you mean 'mass'? " or nothing.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates);

/// "a, b, c", cut after a dozen.
std::string join(const std::vector<std::string>& words);

/// A user's text as shown in a message: in quotes, cut when long.
std::string show(std::string_view text);

}  // namespace sinew::scene
