#include "sinew/mesh/embedding.hpp"
#include "sinew/scene/grammar_forms.hpp"
#include "sinew/scene/readers.hpp"

namespace sinew::scene {

LoadDescription read_load(const Node::Entry& entry, const ReadContext& context) {
  using Type = LoadDescription::Type;
  const Form form = forms::load_form();
  const Fields fields(entry.value, form);
  LoadDescription load;
  load.name = entry.key;
  load.place = entry.key_place;
  const std::string type = read_text(*entry.value.find(form.telltale));
  load.type = type == "force"          ? Type::force
              : type == "line"         ? Type::line
              : type == "traction"     ? Type::traction
              : type == "acceleration" ? Type::acceleration
              : type == "pressure"     ? Type::pressure
                                       : Type::water;
  fields.read("body", load.body);
  if (fields.table().find("outside") != nullptr) {
    fields.read_choice("outside", load.outside,
                       {{"error", mesh::Outside::error}, {"nearest", mesh::Outside::nearest}});
  }
  if (load.type == Type::line) load.points = read_points(fields, "points", context);
  if (fields.table().find("surface") != nullptr && fields.find("surface") != nullptr) {
    read_surface(fields.below("surface"), load.surface.emplace(), context);
  }
  switch (load.type) {
    case Type::force:
      fields.read("point", load.point);
      fields.read("force", load.vector);
      break;
    case Type::line:
      fields.read("force_per_length", load.vector);
      break;
    case Type::traction:
      fields.read("traction", load.vector);
      break;
    case Type::acceleration:
      fields.read("acceleration", load.vector);
      break;
    case Type::pressure:
      break;
    case Type::water:
      fields.read("density", load.water.density);
      if (fields.find("level") != nullptr) fields.read("level", load.water.level.emplace());
      fields.read("velocity", load.water.velocity);
      fields.read("normal_drag", load.water.normal_drag);
      fields.read("tangential_drag", load.water.tangential_drag);
      fields.read("added_mass", load.water.added_mass);
      break;
  }
  const char* signal = load.type == Type::pressure ? "pressure" : "factor";
  if (fields.find(signal) != nullptr) load.factor = read_signal(fields, signal, context);
  return load;
}

MassDescription read_hung_mass(const Node::Entry& entry) {
  const Form form = forms::mass_form();
  const Fields fields(entry.value, form);
  MassDescription mass;
  mass.name = entry.key;
  mass.place = entry.key_place;
  fields.read("body", mass.body);
  mass.body_place = fields.place("body");
  fields.read("point", mass.point);
  fields.read("mass", mass.mass);
  fields.read_choice("outside", mass.outside,
                     {{"error", mesh::Outside::error}, {"nearest", mesh::Outside::nearest}});
  return mass;
}

MembraneDescription read_membrane(const Node::Entry& entry, const ReadContext& context) {
  const Form form = forms::membrane_form();
  const Fields fields(entry.value, form);
  MembraneDescription membrane;
  membrane.name = entry.key;
  membrane.place = entry.key_place;
  fields.read("body", membrane.body);
  membrane.body_place = fields.place("body");
  read_surface(fields.below("surface"), membrane.surface, context);
  fields.read("thickness", membrane.thickness);
  fields.read("young_modulus", membrane.constants.young_modulus);
  fields.read("poisson_ratio", membrane.constants.poisson_ratio);
  return membrane;
}

}  // namespace sinew::scene
