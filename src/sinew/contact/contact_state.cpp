#include "sinew/contact/contact_state.hpp"

#include "sinew/constraint/contact.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/model/model.hpp"

namespace sinew::contact {

std::vector<std::string> touching_bodies(const model::Model& model, int contact) {
  const constraint::Contact& touching = model.contact(contact);
  std::vector<std::string> names{model.body(touching.body()).name()};
  if (touching.other_body() >= 0) names.push_back(model.body(touching.other_body()).name());
  return names;
}

}  // namespace sinew::contact
