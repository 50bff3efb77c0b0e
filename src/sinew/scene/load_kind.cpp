#include "sinew/scene/load_kind.hpp"

#include "sinew/builder/model_builder.hpp"
#include "sinew/mechanics/bears_loads.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/scene/build_parts.hpp"
#include "sinew/scene/grammar_forms.hpp"
#include "sinew/scene/kind_list.hpp"

namespace sinew::scene {

namespace {

KindList<LoadKind>& kinds_of_loads() {
  static KindList<LoadKind> list(
      "load", {&force_load_kind(), &line_load_kind(), &traction_kind(), &acceleration_kind(),
               &pressure_load_kind(), &water_kind()});
  return list;
}

}  // namespace

void register_load_kind(const LoadKind& kind) { kinds_of_loads().add(kind); }

const LoadKind& load_kind(std::string_view word) { return kinds_of_loads().get(word); }

std::vector<mesh::Face> LoadSite::faces(const SurfaceDescription& surface) const {
  if (bears == nullptr) return {};
  return faces_of(surface, bears->load_mesh());
}

Form forms::load_form() { return variants("type", kinds_of_loads().choices()); }

LoadDescription read_load(const Node::Entry& entry, const ReadContext& context) {
  LoadDescription load;
  load.name = entry.key;
  load.place = entry.key_place;
  const Form& form = form_of(grammar(), "loads", Shape::names).items.front();
  const Fields fields(entry.value, form);
  load.kind = &load_kind(read_text(*entry.value.find(form.telltale)));
  fields.read("body", load.body);
  if (fields.may_have("outside")) read_outside(fields, load.outside);
  load.kind->read(fields, context, load);
  const char* signal = load.kind->signal;
  if (fields.find(signal) != nullptr) load.factor = read_signal(fields, signal, context);
  return load;
}

void add_load(builder::ModelBuilder& builder, const LoadDescription& load, const BodyOf& body_of) {
  const auto [body, model] = body_of(load.body);
  builder::LoadSettings settings;
  settings.name = load.name;
  settings.place = load.place;
  settings.body = body;
  settings.outside = load.outside;
  settings.factor = load.factor;
  settings.factor_name = {load.kind->signal, load.kind->signal_unit};
  settings.load = load.kind->make({load, mechanics::as<const mechanics::BearsLoads>(*model)});
  builder.add_load(settings);
}

double water_head(const SceneDescription& scene, const std::string& body,
                  const mechanics::BodyModel& model, const std::vector<mesh::Face>& faces) {
  const auto* bears = mechanics::as<const mechanics::BearsLoads>(model);
  if (bears == nullptr) return 0.0;
  double head = 0.0;
  for (const LoadDescription& load : scene.loads) {
    if (load.kind->head == nullptr || load.body != body) continue;
    head += load.kind->head({load, bears}, faces);
  }
  return head;
}

}  // namespace sinew::scene
