#include "sinew/scene/renamed_words.hpp"

#include <algorithm>
#include <array>

#include "sinew/scene/grammar.hpp"

namespace sinew::scene {

namespace {

struct RenamedWord {
  std::string_view old, current;
};

// A word may still be in use elsewhere: loads and sensors are of type pressure.
constexpr std::array kRenamedWords = {
    RenamedWord{"center", "centre"},     RenamedWord{"pressure", "chamber"},  // type of an actuator
    RenamedWord{"rotated", "corotated"},                                      // tangent
    RenamedWord{"eigen-ldlt", "block"},  RenamedWord{"eigen-llt", "block"},   // factorisation
};

void replace_in_value(Node& node, const std::vector<Form>& forms);

void replace_keys(Node& map, const KeyTable& table) {
  const std::vector<std::string> known = table.key_names();
  for (Node::Entry& entry : map.entries()) {
    if (const auto word = current_word(entry.key, known)) entry.key = *word;
    if (const Key* key = table.find(entry.key)) replace_in_value(entry.value, key->forms);
  }
}

void replace_word(Node& node, const Form& form) {
  std::vector<std::string> known;
  for (const Choice& choice : form.choices) known.push_back(choice.word);
  if (const auto word = current_word(node.spelling(), known)) {
    Location place = node.place();
    node = Node::text(*word);
    node.set_place(std::move(place));
  }
}

void replace_in_variants(Node& map, const Form& form) {
  Node* word = map.find(form.telltale);
  if (word == nullptr) return;
  replace_word(*word, form);
  const auto chosen = std::ranges::find(form.choices, word->spelling(), &Choice::word);
  if (chosen != form.choices.end() && chosen->table) replace_keys(map, *chosen->table);
}

void replace_in_value(Node& node, const std::vector<Form>& forms) {
  for (const Form& form : forms) {
    if (node.is_scalar()) {
      if (form.shape == Shape::choice) replace_word(node, form);
    } else if (node.is_list()) {
      for (Node& item : node.items()) replace_in_value(item, form.items);
    } else if (form.shape == Shape::table) {
      replace_keys(node, *form.table);
    } else if (form.shape == Shape::variants) {
      replace_in_variants(node, form);
    } else if (form.shape == Shape::names) {
      for (Node::Entry& entry : node.entries()) replace_in_value(entry.value, form.items);
    }
  }
}

}  // namespace

std::optional<std::string> current_word(std::string_view word,
                                        const std::vector<std::string>& known) {
  const auto found = std::ranges::find(kRenamedWords, word, &RenamedWord::old);
  if (found == kRenamedWords.end()) return std::nullopt;
  const auto is_known = [&](std::string_view each) {
    return std::ranges::find(known, each) != known.end();
  };
  if (is_known(word) || !is_known(found->current)) return std::nullopt;
  return std::string(found->current);
}

void replace_renamed_words(Node& scene) {
  if (scene.is_map()) replace_keys(scene, grammar());
}

}  // namespace sinew::scene
