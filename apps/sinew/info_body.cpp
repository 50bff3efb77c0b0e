#include "info_body.hpp"

#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "sinew/core/error.hpp"
#include "sinew/fem/element_count.hpp"
#include "sinew/fem/fem_model.hpp"
#include "sinew/fem/has_elements.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/mesh/solid.hpp"
#include "sinew/mesh/surface.hpp"
#include "sinew/mesh/topology.hpp"
#include "sinew/pcc/arm.hpp"
#include "sinew/pcc/has_arm.hpp"

namespace sinew::cli {

namespace {

using nlohmann::ordered_json;

ordered_json square(const Matrix3& m) {
  return {triple(m.row(0)), triple(m.row(1)), triple(m.row(2))};
}

void add_arm(ordered_json& json, std::string& text, const pcc::Arm& arm) {
  double mass = 0.0;
  for (const pcc::Segment& segment : arm.settings().segments) mass += segment.mass;
  json["bodies"].push_back({{"name", arm.settings().name},
                            {"segments", arm.segments()},
                            {"coordinates", arm.coordinates()},
                            {"length_m", arm.length()},
                            {"mass_kg", mass}});
  text += fmt::format(
      "  body {}: {} segments of constant curvature, {} coordinates, "
      "{:.4g} mm, {:.4g} g\n",
      arm.settings().name, arm.segments(), arm.coordinates(), 1e3 * arm.length(), 1e3 * mass);
}

// The error of a check of a surface; none if it passes.
std::optional<Error> defect(const mesh::Surface& surface, void (*check)(const mesh::Surface&)) {
  try {
    check(surface);
    return {};
  } catch (const Error& error) {
    return error;
  }
}

void add_triangles(ordered_json& json, std::string& text, const mesh::Mesh& mesh) {
  const mesh::Surface surface = mesh::boundary_surface(mesh);
  const bool closed = !defect(surface, mesh::require_closed);
  json["triangles"] = surface.triangles.size();
  json["closed"] = closed;
  text += fmt::format("    {} triangles, {}", surface.triangles.size(), closed ? "closed" : "open");
  if (closed) {
    const double volume = mesh::solid_moments(surface).volume;
    json["volume_m3"] = volume;
    text += fmt::format(", {:.6g} cm^3", 1e6 * volume);
  }
  text += "\n";
}

void add_rigid(ordered_json& json, std::string& text, const mechanics::BodyModel& body,
               const mechanics::HasShape& shape) {
  constexpr double kRounding = 1e-12;  // m
  const Vector3 centre =
      shape.own_centre().unaryExpr([](double x) { return std::abs(x) < kRounding ? 0.0 : x; });
  const Matrix3 inertia = shape.own_inertia();
  ordered_json entry = {{"name", body.name()},
                        {"shape", shape.shape_name()},
                        {"mass_kg", shape.mass()},
                        {"centre_of_mass_m", triple(centre)},
                        {"inertia_kg_m2", square(inertia)}};
  text += fmt::format(
      "  body {}: rigid {}, {:.4g} g, centre of mass {:.4g} {:.4g} {:.4g} mm, moments of inertia "
      "{:.4g} {:.4g} {:.4g} kg m^2\n",
      body.name(), shape.shape_name(), 1e3 * shape.mass(), 1e3 * centre.x(), 1e3 * centre.y(),
      1e3 * centre.z(), inertia(0, 0), inertia(1, 1), inertia(2, 2));
  if (body.mesh().hexahedra.empty()) add_triangles(entry, text, body.mesh());
  json["bodies"].push_back(entry);
}

}  // namespace

ordered_json triple(const Vector3& v) { return {v.x(), v.y(), v.z()}; }

void add_solid(ordered_json& json, std::string& text, const mesh::Surface& surface) {
  if (const auto open = defect(surface, mesh::require_closed)) {
    json["closed"] = false;
    json["defect"] = open->message();
    text += fmt::format("  not closed: {}\n", open->message());
    return;
  }
  const mesh::SolidMoments moments = mesh::solid_moments(surface);
  const Matrix3 inertia = moments.inertia();
  json["closed"] = true;
  json["volume_m3"] = moments.volume;
  json["centre_m"] = triple(moments.centre);
  json["inertia_m5"] = square(inertia);
  text += fmt::format(
      "  closed, encloses {:.6g} cm^3{}\n  centre of volume {:.6g} {:.6g} {:.6g} mm, moments of "
      "inertia per density {:.4g} {:.4g} {:.4g} m^5\n",
      1e6 * std::abs(moments.volume), moments.volume < 0.0 ? "; its triangles face inwards" : "",
      1e3 * moments.centre.x(), 1e3 * moments.centre.y(), 1e3 * moments.centre.z(), inertia(0, 0),
      inertia(1, 1), inertia(2, 2));
  if (const auto none = defect(surface, mesh::require_solid)) {
    json["defect"] = none->message();
    if (none->kind() == ErrorKind::self_crossing) text += fmt::format("  {}\n", none->message());
  }
}

void add_body(ordered_json& json, std::string& text, const mechanics::BodyModel& body) {
  if (const auto* arm = mechanics::as<const pcc::HasArm>(body))
    return add_arm(json, text, arm->arm());
  if (const auto* shape = mechanics::as<const mechanics::HasShape>(body)) {
    return add_rigid(json, text, body, *shape);
  }
  const auto* material = mechanics::as<const fem::HasElements>(body);
  if (material == nullptr) {
    json["bodies"].push_back({{"name", body.name()}});
    text += fmt::format("  body {}\n", body.name());
    return;
  }
  const fem::FemModel& model = material->elements();
  ordered_json elements = ordered_json::object();
  for (const auto& [element, count] : fem::count_elements(model)) {
    elements[std::string(element)] = count;
  }
  json["bodies"].push_back({{"name", body.name()},
                            {"elements", elements},
                            {"nodes", body.mesh().node_count()},
                            {"free_nodes", model.free_count()},
                            {"tetrahedra", body.mesh().tetrahedra.size()},
                            {"hexahedra", body.mesh().hexahedra.size()},
                            {"mass_kg", model.total_mass()},
                            {"volume_m3", model.volume()}});
  text += fmt::format("  body {}: {} nodes ({} free), {}, {:.4g} g, {:.4g} cm^3\n", body.name(),
                      body.mesh().node_count(), model.free_count(), fem::describe_elements(model),
                      1e3 * model.total_mass(), 1e6 * model.volume());
}

}  // namespace sinew::cli
