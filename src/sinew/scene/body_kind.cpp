#include "sinew/scene/body_kind.hpp"

#include <string>
#include <utility>

#include <fmt/format.h>

#include "sinew/builder/model_builder.hpp"
#include "sinew/core/error.hpp"
#include "sinew/scene/grammar_forms.hpp"
#include "sinew/scene/kind_list.hpp"

namespace sinew::scene {

namespace {

KindList<BodyKind>& kinds_of_bodies() {
  static KindList<BodyKind> list("body", {&fem_kind(), &pcc_kind(), &rigid_kind(), &urdf_kind()});
  return list;
}

}  // namespace

void refuse_world(const Node::Entry& body) {
  if (body.key != kWorldName) return;
  throw Error(ErrorKind::bad_argument, body.key_place, "`world` is what joints call the world",
              "give the body another name");
}

void register_body_kind(const BodyKind& kind) { kinds_of_bodies().add(kind); }

Form forms::body_form() {
  std::vector<Choice> choices = kinds_of_bodies().choices();
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
  body.kind = kinds_of_bodies().find(word);
  body.kind->read(fields, context, body);
  return body;
}

void add_body(builder::ModelBuilder& builder, const SceneDescription& scene,
              const BodyDescription& body, const SharedMesh* shared) {
  try {
    const int number = builder.add_body(body.kind->make({scene, body, shared}), body.place);
    if (!body.motion) return;
    model::BaseMotion motion = *body.motion;
    motion.body = number;
    builder.add_base_motion(motion, body.motion_place);
  } catch (const Error& error) {
    throw error.at(body.place);
  }
}

}  // namespace sinew::scene
