#include "sinew/scene/grammar_forms.hpp"
#include "sinew/scene/readers.hpp"

namespace sinew::scene {

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
  read_outside(fields, mass.outside);
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
