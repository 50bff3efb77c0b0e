#include "sinew/statics/path_settings.hpp"

namespace sinew::statics {

std::string_view path_event_name(PathEvent event) {
  switch (event) {
    case PathEvent::limit_point:
      return "limit-point";
    case PathEvent::bifurcation:
      return "bifurcation";
    case PathEvent::none:
      break;
  }
  return "none";
}

std::string_view path_end_name(PathEnd end) {
  switch (end) {
    case PathEnd::max_points:
      return "max-points";
    case PathEnd::no_equilibrium:
      return "no-equilibrium";
    case PathEnd::full_load:
      break;
  }
  return "full-load";
}

}  // namespace sinew::statics
