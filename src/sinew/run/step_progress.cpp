#include "sinew/run/step_progress.hpp"

namespace sinew::run {

std::string_view search_stage_text(SearchStage stage) {
  switch (stage) {
    case SearchStage::newton:
      return "Newton's method";
    case SearchStage::held_efforts:
      return "with the controller's last choice";
    case SearchStage::last_efforts:
      return "with the efforts of the last step";
    case SearchStage::parts:
      return "along the load in parts";
    case SearchStage::downhill:
      return "downhill with the projected tangent";
    case SearchStage::overdamped:
      return "by overdamped motion";
  }
  return "";
}

}  // namespace sinew::run
