// The notice about cables whose points dent the material.
#include <cmath>

#include <fmt/format.h>

#include "sinew/fem/fem_body_settings.hpp"
#include "sinew/fem/fem_model.hpp"
#include "sinew/fem/has_elements.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/mesh/quality.hpp"
#include "sinew/scene/build_parts.hpp"

namespace sinew::scene {

namespace {

// Fraction of the body's size below which a dent gives no notice.
constexpr double kDent = 0.01;

}  // namespace

// The displacement under a point force F in a medium of modulus E is unbounded (Kelvin); on a mesh
// with edge h it is about F/(E h). If the tension has no limit, F is the force that strains the
// section of the body by a tenth.
std::optional<Notice> bare_points_notice(const ActuatorDescription& actuator,
                                         const mechanics::BodyModel& body) {
  const auto& cable = *actuator.as<CableDescription>();
  const auto* own = mechanics::as<const fem::HasElements>(body);
  if (own == nullptr || body.mesh().quadratic.empty() || cable.settings.guide_radius > 0.0) {
    return std::nullopt;
  }
  const mesh::Mesh& mesh = body.mesh();
  const double modulus = fem::stiffest_modulus(own->settings().elements);
  const double volume = own->elements().volume();
  const double edge = mesh::mean_edge(mesh, volume);
  const Vector3 extent = mesh.nodes.colwise().maxCoeff() - mesh.nodes.colwise().minCoeff();
  const double size = extent.norm();
  const double most = cable.settings.tension.max;
  const double force = std::isfinite(most) ? most : 0.1 * modulus * volume / size;
  const double dent = force / (modulus * edge);
  if (dent < kDent * size) return std::nullopt;
  return Notice{
      cable.guide_radius_given ? NoticeLevel::remark : NoticeLevel::warning,
      NoticeKind::bare_points, actuator.place,
      fmt::format("cable '{}' pulls at single points of quadratic elements: {:.2g} N dent "
                  "the material by about {:.2g} mm at each, and more on a finer mesh",
                  actuator.name, force, 1e3 * dent),
      fmt::format("write the radius of its tube, for instance guide_radius: {:.1g} mm",
                  1e3 * 0.5 * edge)};
}

}  // namespace sinew::scene
