/// @file
/// A list of kinds that programs may extend before the grammar is made from it.
#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/scene/grammar_forms.hpp"

namespace sinew::scene {

/// Kinds of one sort, told apart by their words. They must outlive the list.
template <class Kind>
class KindList {
 public:
  /// @param sort for messages: "body". @param kinds in the order of the reference.
  KindList(const char* sort, std::vector<const Kind*> kinds)
      : sort_(sort), kinds_(std::move(kinds)) {}

  const std::vector<const Kind*>& all() const { return kinds_; }
  /// The kind with a word, or null.
  const Kind* find(std::string_view word) const {
    const auto found = std::ranges::find(kinds_, word, &Kind::word);
    return found == kinds_.end() ? nullptr : *found;
  }
  /// The kind with a word. Throws Error(internal) if there is none.
  const Kind& get(std::string_view word) const {
    if (const Kind* found = find(word)) return *found;
    throw Error(ErrorKind::internal, {},
                fmt::format("no kind of {} has the word '{}'", sort_, word));
  }
  /// Appends a kind. Throws Error: duplicate-key (its word is taken), bad-argument (use() or
  /// choices() was called, and the kind would be missing there).
  void add(const Kind& kind) {
    const std::string_view word = std::invoke(&Kind::word, kind);
    if (find(word) != nullptr) {
      throw Error(ErrorKind::duplicate_key,
                  {.item = fmt::format("the kind of {} '{}'", sort_, word)},
                  "there is a kind of this word", "choose another word");
    }
    if (in_use_) {
      throw Error(ErrorKind::bad_argument, {.item = fmt::format("the kind '{}'", word)},
                  "the grammar is in use", "register kinds before the first scene is read");
    }
    kinds_.push_back(&kind);
  }
  /// The kinds for the grammar, to which no more are added.
  const std::vector<const Kind*>& use() {
    in_use_ = true;
    return kinds_;
  }
  /// The words of the grammar, with their tables.
  std::vector<Choice> choices() {
    std::vector<Choice> choices;
    for (const Kind* kind : use()) {
      choices.push_back({.word = std::string(std::invoke(&Kind::word, *kind)),
                         .description = kind->description,
                         .table = kind->table()});
    }
    return choices;
  }

 private:
  const char* sort_;
  std::vector<const Kind*> kinds_;
  bool in_use_ = false;
};

}  // namespace sinew::scene
