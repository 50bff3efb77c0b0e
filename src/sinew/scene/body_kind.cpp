#include "sinew/scene/body_kind.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "sinew/builder/model_builder.hpp"
#include "sinew/core/error.hpp"
#include "sinew/scene/grammar_forms.hpp"

namespace sinew::scene {

namespace {

// Whether the grammar has been made, in which later kinds would be missing.
bool& body_form_is_made() {
  static bool made = false;
  return made;
}

std::vector<const BodyKind*>& list_of_bodies() {
  static std::vector<const BodyKind*> all = {&fem_kind(), &pcc_kind(), &rigid_kind(), &urdf_kind()};
  return all;
}

}  // namespace

void refuse_world(const Node::Entry& body) {
  if (body.key != kWorldName) return;
  throw Error(ErrorKind::bad_argument, body.key_place, "`world` is what joints call the world",
              "give the body another name");
}

const std::vector<const BodyKind*>& body_kinds() { return list_of_bodies(); }

void register_body_kind(const BodyKind& kind) {
  const std::string_view word = kind.word;
  if (std::ranges::find(list_of_bodies(), word, &BodyKind::word) != list_of_bodies().end()) {
    throw Error(ErrorKind::duplicate_key, {.item = fmt::format("the kind of body '{}'", word)},
                "there is a kind of this word", "choose another word");
  }
  if (body_form_is_made()) {
    throw Error(ErrorKind::bad_argument, {.item = fmt::format("the kind '{}'", word)},
                "the grammar is in use", "register kinds before the first scene is read");
  }
  list_of_bodies().push_back(&kind);
}

Form forms::body_form() {
  body_form_is_made() = true;
  std::vector<Choice> choices;
  for (const BodyKind* kind : body_kinds()) {
    choices.push_back(
        {.word = kind->word, .description = kind->description, .table = kind->table()});
  }
  choices.push_back({.word = "reduced", .description = "Reduced elements.", .later = true});
  choices.push_back({.word = "rod", .description = "A slender rod.", .later = true});
  return variants("type", std::move(choices));
}

BodyDescription read_body(const Node::Entry& entry, const ReadContext& context) {
  BodyDescription body;
  body.name = entry.key;
  body.place = entry.key_place;
  refuse_world(entry);
  const Form& form = form_of(grammar(), "bodies", Shape::names).items.front();
  const Fields fields(entry.value, form);
  const std::string word = read_text(*entry.value.find(form.telltale));
  // The grammar allows no other word.
  body.kind = *std::ranges::find(list_of_bodies(), word, &BodyKind::word);
  body.kind->read(fields, context, body);
  return body;
}

void add_body(builder::ModelBuilder& builder, const SceneDescription& scene,
              const BodyDescription& body, const SharedMesh* shared) {
  try {
    const int number = builder.add_body(body.kind->make({scene, body, shared}), body.place);
    if (!body.base) return;
    model::BaseMotion motion = *body.base;
    motion.body = number;
    builder.add_base_motion(motion, body.base_place);
  } catch (const Error& error) {
    throw error.at(body.place);
  }
}

}  // namespace sinew::scene
