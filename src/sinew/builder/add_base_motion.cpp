#include "sinew/builder/add_parts.hpp"
#include "sinew/builder/find_body.hpp"
#include "sinew/core/error.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/model/base_motion.hpp"
#include "sinew/model/model_data.hpp"

namespace sinew::builder {

void add_base_motion(model::ModelData& data, const model::BaseMotion& motion,
                     const Location& place) {
  const auto* moved =
      mechanics::as<const mechanics::MayHaveBase>(find_body(data, motion.body, place));
  if (moved == nullptr || !moved->has_base()) {
    throw Error(ErrorKind::nothing_fixed, place, "the body has a base motion but no fixed node",
                "fix the region that moves");
  }
  data.base_motions.push_back(motion);
  data.base_motions.back().axis = model::checked_axis(motion.axis, place);
}

}  // namespace sinew::builder
