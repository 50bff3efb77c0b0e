#include "sinew/scene/renamed_words.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

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

struct MovedKey {
  std::string_view table, old, current;
};

constexpr std::string_view kSoft = "body: type fem", kArm = "body: type pcc";
constexpr std::array kMovedKeys = {
    MovedKey{kSoft, "position", "pose.position"},
    MovedKey{kSoft, "rotation", "pose.rotation"},
    MovedKey{kSoft, "initial_velocity", "velocity"},
    MovedKey{kSoft, "base", "motion"},
    MovedKey{kArm, "position", "pose.position"},
    MovedKey{kArm, "direction", "pose.direction"},
    MovedKey{kArm, "side", "pose.side"},
};

// Moves the entry at `index` of a map to a place where there is nothing yet. Returns false if there
// is something.
bool move_entry(Node& map, std::size_t index, std::string_view to) {
  const std::size_t dot = to.find('.');
  const std::string key(to.substr(0, dot));
  Node* there = map.find(key);
  Node::Entry& entry = map.entries()[index];
  if (dot == std::string_view::npos) {
    if (there != nullptr) return false;
    entry.key = key;
    return true;
  }
  const std::string below(to.substr(dot + 1));
  if (there == nullptr) {
    Node around = Node::map();
    around.set_place(entry.value.place());
    around.set(below, std::move(entry.value));
    around.entries().back().key_place = entry.key_place;
    entry.key = key;
    entry.value = std::move(around);
    return true;
  }
  if (!there->is_map() || there->find(below) != nullptr) return false;
  there->set(below, std::move(entry.value));
  there->entries().back().key_place = entry.key_place;
  map.entries().erase(map.entries().begin() + static_cast<std::ptrdiff_t>(index));
  return true;
}

/// Replaces what has other names now: keys that have moved, and words.
class Renaming {
 public:
  const std::vector<Notice>& notices() const { return notices_; }

  void replace_keys(Node& map, const KeyTable& table) {
    move_keys(map, table);
    const std::vector<std::string> known = table.key_names();
    for (Node::Entry& entry : map.entries()) {
      if (const auto word = current_word(entry.key, known)) {
        notices_.push_back(moved_notice(entry.key, *word, entry.key_place));
        entry.key = *word;
      }
      if (const Key* key = table.find(entry.key)) replace_in_value(entry.value, key->forms);
    }
  }

 private:
  void move_keys(Node& map, const KeyTable& table) {
    for (std::size_t k = 0; k < map.entries().size();) {
      const std::string old = map.entries()[k].key;
      const Location place = map.entries()[k].key_place;
      const std::size_t before = map.entries().size();
      const std::string_view to = moved_key(old, table);
      const bool moved = !to.empty() && move_entry(map, k, to);
      if (moved) notices_.push_back(moved_notice(old, to, place));
      if (map.entries().size() == before) ++k;
    }
  }

  void replace_word(Node& node, const Form& form) {
    std::vector<std::string> known;
    for (const Choice& choice : form.choices) known.push_back(choice.word);
    if (const auto word = current_word(node.spelling(), known)) {
      Location place = node.place();
      notices_.push_back(moved_notice(node.spelling(), *word, place));
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

  std::vector<Notice> notices_;
};

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

std::string_view moved_key(std::string_view key, const KeyTable& table) {
  const auto found = std::ranges::find_if(kMovedKeys, [&](const MovedKey& moved) {
    return moved.table == table.name && moved.old == key;
  });
  return found == kMovedKeys.end() ? std::string_view() : found->current;
}

std::string written(std::string_view path) {
  const std::size_t dot = path.find('.');
  if (dot == std::string_view::npos) return std::string(path);
  return fmt::format("{}: {{{}: ...}}", path.substr(0, dot), path.substr(dot + 1));
}

Notice moved_notice(std::string_view old, std::string_view current, const Location& place) {
  return {NoticeLevel::warning, NoticeKind::renamed_word, place,
          fmt::format("'{}' has another name now", old), fmt::format("write {}", written(current))};
}

std::vector<Notice> replace_old_words(Node& scene) {
  Renaming renaming;
  if (scene.is_map()) renaming.replace_keys(scene, grammar());
  return renaming.notices();
}

}  // namespace sinew::scene
