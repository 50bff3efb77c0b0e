#include "sinew/scene/values.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include <fmt/format.h>

#include "sinew/core/whole.hpp"
#include "sinew/scene/check.hpp"
#include "sinew/scene/other_words.hpp"

namespace sinew::scene {

namespace {

constexpr std::size_t kLongWord = 100;
constexpr std::size_t kShown = 60;
constexpr std::size_t kListed = 14;

bool fits(const Node& node, const Form& form) {
  switch (form.shape) {
    case Shape::table:
    case Shape::variants:
    case Shape::names:
      return node.is_map();
    case Shape::list:
    case Shape::samples:
      return node.is_list();
    case Shape::quantity:
      return node.kind() == Node::Kind::text || node.kind() == Node::Kind::number ||
             (node.is_list() && form.max_count > 1);
    default:
      return node.is_scalar() && node.kind() != Node::Kind::null;
  }
}

// Reduces "Dragon Skin 30" to "dragonskin30".
std::string letters_and_digits(std::string_view text) {
  std::string result;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) != 0) result += static_cast<char>(std::tolower(byte));
  }
  return result;
}

bool is_word(const std::string& word, const Node& node, const Form& form) {
  if (!form.loose) return word == node.spelling();
  return letters_and_digits(word) == letters_and_digits(node.spelling());
}

bool has_word(const Node& node, const Form& form) {
  return std::any_of(form.choices.begin(), form.choices.end(),
                     [&](const Choice& choice) { return is_word(choice.word, node, form); });
}

[[noreturn]] void throw_wrong_type(const Node& node, const std::vector<Form>& forms,
                                   const std::string& example) {
  const std::string found =
      node.is_scalar() && node.kind() != Node::Kind::null
          ? fmt::format("{} is {}", show(node.spelling()), node_kind_name(node.kind()))
          : fmt::format("found {}", node_kind_name(node.kind()));
  throw Error(ErrorKind::wrong_type, node.place(),
              fmt::format("{}, but this takes {}", found, describe(forms)),
              fmt::format("write for example {}", example));
}

// Whether a list is a vector of numbers, where a list of vectors is also allowed.
bool is_vector(const Node& node) {
  return node.is_list() && !node.items().empty() &&
         node.items().front().kind() == Node::Kind::number;
}

// Selects among several map forms by their telltale keys.
const Form& select_map_form(const Node& node, const std::vector<const Form*>& fitting) {
  std::vector<std::string> telltales;
  for (const Form* form : fitting) {
    if (node.find(form->telltale) != nullptr) return *form;
    telltales.push_back(form->telltale);
  }
  throw Error(ErrorKind::missing_key, node.place(),
              fmt::format("one of {} is missing", join(telltales)),
              fmt::format("add {}: or {}:", telltales.front(), telltales.back()));
}

void check_range(double value, const Form& form, const Location& place,
                 const std::string& written) {
  const Range& range = form.range;
  const bool low = value < range.min || (range.above_min && value == range.min);
  const bool high = value > range.max || (range.below_max && value == range.max);
  if (!low && !high) return;
  std::string wanted;
  if (std::isfinite(range.min)) {
    wanted = fmt::format("{} {}", range.above_min ? "above" : "at least", range.min);
  }
  if (std::isfinite(range.max)) {
    wanted += fmt::format("{}{} {}", wanted.empty() ? "" : " and ",
                          range.below_max ? "below" : "at most", range.max);
  }
  throw Error(range.kind, place, fmt::format("{} is out of range", written),
              fmt::format("it must be {}{}{}", wanted, form.unit.empty() ? "" : " ", form.unit));
}

void check_count(std::size_t count, const Form& form, const Node& node) {
  if (static_cast<int>(count) >= form.min_count && static_cast<int>(count) <= form.max_count) {
    return;
  }
  throw Error(ErrorKind::wrong_length, node.place(),
              fmt::format("found {} number{}", count, count == 1 ? "" : "s"),
              fmt::format("write {}", describe(form)));
}

double read_scalar(const Node& node, const Form& form) {
  if (node.kind() != Node::Kind::text && node.kind() != Node::Kind::number) {
    throw_wrong_type(node, {form}, fmt::format("1 {}", form.unit));
  }
  // Numbers are read as in YAML, including ".inf", so that this is reported as not finite.
  if (node.kind() == Node::Kind::number) {
    const double value = node.as_number();
    if (std::isfinite(value)) return value;
    throw Error(ErrorKind::not_finite, node.place(),
                fmt::format("{} is not finite", node.spelling()), "write a finite number");
  }
  return parse_quantity(node.spelling(), form.dimension, node.place());
}

}  // namespace

const Form& select_form(const Node& node, const std::vector<Form>& forms,
                        const std::string& example) {
  std::vector<const Form*> fitting;
  for (const Form& form : forms) {
    if (fits(node, form)) fitting.push_back(&form);
  }
  if (fitting.empty()) throw_wrong_type(node, forms, example);
  const Form* chosen = fitting.front();
  if (fitting.size() > 1 && node.is_map()) {
    chosen = &select_map_form(node, fitting);
  } else if (fitting.size() > 1 && chosen->shape == Shape::choice && !has_word(node, *chosen)) {
    chosen = fitting[1];
  } else if (fitting.size() > 1 && chosen->shape == Shape::list && is_vector(node)) {
    chosen = fitting[1];
  }
  if (chosen->later) {
    throw_later(node.is_scalar() ? show(node.spelling()) : "this", "write " + describe(forms),
                node.place());
  }
  return *chosen;
}

std::vector<double> read_numbers(const Node& node, const Form& form) {
  std::vector<double> values;
  if (node.is_list()) {
    for (const Node& item : node.items()) {
      values.push_back(read_scalar(item, form));
      check_range(values.back(), form, item.place(), item.spelling());
    }
  } else if (form.max_count == 1 || node.kind() != Node::Kind::text) {
    values.push_back(read_scalar(node, form));
  } else {
    values = parse_list(node.spelling(), form.dimension, -1, node.place());
  }
  check_count(values.size(), form, node);
  for (const double value : values) check_range(value, form, node.place(), show(node.spelling()));
  return values;
}

double read_unit(const Node& node, const Form& form) {
  const std::string& text = node.spelling();
  const bool bare = node.kind() == Node::Kind::text && !text.empty() &&
                    std::isdigit(static_cast<unsigned char>(text.front())) == 0;
  const double value =
      bare ? parse_unit(text, form.dimension, node.place()) : read_scalar(node, form);
  check_range(value, form, node.place(), show(text));
  return value;
}

int read_integer(const Node& node, const Form& form) {
  const double value = node.kind() == Node::Kind::number ? node.as_number() : 0.5;
  if (value != std::floor(value)) {
    throw_wrong_type(node, {form}, fmt::format("{}", form.range.min));
  }
  check_range(value, form, node.place(), node.spelling());
  return whole<int>(value);
}

const Choice& read_choice(const Node& node, const Form& form) {
  std::vector<std::string> words;
  for (const Choice& choice : form.choices) {
    if (!choice.later) words.push_back(choice.word);
  }
  if (!node.is_scalar() || node.kind() == Node::Kind::null) {
    throw_wrong_type(node, {form}, words.front());
  }
  for (const Choice& choice : form.choices) {
    if (!is_word(choice.word, node, form)) continue;
    if (choice.later) throw_later(show(choice.word), "write one of " + join(words), node.place());
    return choice;
  }
  throw Error(ErrorKind::unknown_choice, node.place(),
              fmt::format("{} is not a choice here", show(node.spelling())),
              fmt::format("{}write one of {}", did_you_mean(node.spelling(), words), join(words)));
}

const std::string& read_text(const Node& node) {
  const bool scalar = node.is_scalar() && node.kind() != Node::Kind::null;
  if (!scalar || node.spelling().empty()) {
    throw Error(
        ErrorKind::wrong_type, node.place(),
        fmt::format("found {} instead of text", scalar ? "nothing" : node_kind_name(node.kind())),
        "write a name or a path");
  }
  return node.spelling();
}

std::vector<Sample> read_samples(const Node& node, const Form& form) {
  if (node.items().empty()) {
    throw Error(ErrorKind::empty_list, node.place(), "the list is empty",
                fmt::format("write pairs such as [[0 s, 0 {}]]", form.unit));
  }
  static const Form time = [] {
    Form result;
    result.dimension = dimension::kTime;
    result.unit = "s";
    return result;
  }();
  Form value = form;
  value.max_count = 1;
  std::vector<Sample> samples;
  for (const Node& pair : node.items()) {
    if (!pair.is_list()) {
      throw Error(ErrorKind::wrong_type, pair.place(),
                  fmt::format("found {} instead of a pair", node_kind_name(pair.kind())),
                  fmt::format("write pairs such as [1 s, 0 {}]", form.unit));
    }
    if (pair.items().size() != 2) {
      throw Error(ErrorKind::wrong_length, pair.place(),
                  fmt::format("found {} items instead of time and value", pair.items().size()),
                  fmt::format("write pairs such as [1 s, 0 {}]", form.unit));
    }
    samples.push_back({read_scalar(pair.items()[0], time), read_scalar(pair.items()[1], value)});
  }
  return samples;
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates) {
  if (word.size() > kLongWord) return {};
  std::string nearest = word_for(word, candidates);
  if (nearest.empty()) nearest = nearest_word(word, candidates);
  return nearest.empty() ? std::string() : fmt::format("did you mean '{}'? ", nearest);
}

std::string join(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size() && i < kListed; ++i) {
    text += (i > 0 ? ", " : "") + words[i];
  }
  if (words.size() > kListed) text += fmt::format(" and {} more", words.size() - kListed);
  return text;
}

std::string show(std::string_view text) {
  if (text.size() <= kShown) return fmt::format("'{}'", text);
  return fmt::format("'{}...'", text.substr(0, kShown));
}

}  // namespace sinew::scene
