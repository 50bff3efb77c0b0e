#include "sinew/statics/path_obstacle.hpp"

#include <fmt/format.h>

#include "sinew/constraint/shape_contact.hpp"
#include "sinew/run/run.hpp"

namespace sinew::statics {

std::optional<Error> find_path_obstacle(const run::Run& run) {
  const contact::ContactPlanes& planes = run.world.contacts().planes();
  for (std::size_t i = 0; i < planes.contacts().size(); ++i) {
    const constraint::ShapeContact* contact = planes.shape(i);
    if (contact == nullptr || !contact->curved() || contact->friction().sticking == 0.0) continue;
    return Error(ErrorKind::not_in_this_version,
                 {.item = fmt::format("contact '{}'", contact->name())},
                 "paths along curved surfaces with friction are not followed yet",
                 "step through the load in time");
  }
  for (const model::ContactModel& contact : run.model->contacts()) {
    if (contact.aggregate == 0.0) continue;
    return Error(ErrorKind::not_in_this_version,
                 {.item = fmt::format("contact '{}'", contact.name)},
                 "paths with aggregated contact are not followed yet",
                 "leave `aggregate` out, or step through the load in time");
  }
  for (std::size_t i = 0; i < run.model->contacts().size(); ++i) {
    const constraint::Contact& contact = run.model->contact(static_cast<int>(i));
    if (contact.other_body() < 0 && !contact.is_found_anew()) continue;
    return Error(ErrorKind::not_in_this_version, {.item = "follow_path"},
                 "paths on which bodies touch each other are not followed yet",
                 "step through the load in time");
  }
  if (run.world.joints().block_count() > 0) {
    return Error(ErrorKind::bad_argument, {.item = "follow_path"},
                 "paths do not pass limits and friction of joints",
                 "step through the load in time");
  }
  if (!run.model->guides().empty()) {
    return Error(ErrorKind::bad_argument, {.item = "follow_path"},
                 "cables with friction have no path of their own", "step through the load in time");
  }
  return {};
}

}  // namespace sinew::statics
