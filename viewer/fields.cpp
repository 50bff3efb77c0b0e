#include "fields.hpp"

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

#include "sinew/fem/has_material.hpp"
#include "sinew/fem/solid_elements.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/sim/row_efforts.hpp"

namespace sinew::viewer {

namespace {

void put_nodes(const Points& points, std::span<const NodeId> nodes, std::vector<float>& list) {
  for (const NodeId node : nodes) {
    for (int c = 0; c < 3; ++c) list.push_back(static_cast<float>(points(node, c)));
  }
}

}  // namespace

const std::vector<FieldInfo>& list_fields() {
  static const std::vector<FieldInfo> list = [] {
    std::vector<FieldInfo> all = {
        {"displacement", "Displacement", "m", "distance from the place at rest",
         [](const mechanics::Body& body, const sim::Simulation&, const fem::NodalMean*) {
           return fem::displacement_field(body);
         }}};
    const auto add = [&](FieldInfo info, const auto& values) {
      info.values = [values](const mechanics::Body& body, const sim::Simulation& simulation,
                             const fem::NodalMean* mean) {
        const auto* own = mechanics::as<const fem::HasMaterial>(body);
        return own == nullptr
                   ? std::vector<double>(static_cast<std::size_t>(body.positions().rows()), 0.0)
                   : values(*own, simulation, *mean);
      };
      all.push_back(std::move(info));
    };
    for (const fem::ElementFieldInfo& info : fem::element_fields()) {
      add({info.name, info.label, info.unit, info.description, {}},
          [field = info.field](const fem::HasMaterial& body, const sim::Simulation&,
                               const fem::NodalMean& mean) {
            return mean(fem::element_field(body, field));
          });
    }
    add({"actuator_force", "Actuators' force", "N", "force of the actuators on each node", {}},
        [](const fem::HasMaterial& body, const sim::Simulation& simulation, const fem::NodalMean&) {
          return fem::row_force_field(body, sim::split_efforts(simulation).actuation);
        });
    return all;
  }();
  return list;
}

PickFrame values_of(const sim::Simulation& simulation, const Picked& at,
                    const std::vector<int>& materials) {
  constexpr auto kNone = std::numeric_limits<float>::quiet_NaN();
  const mechanics::Body& body = simulation.body(at.body);
  const mesh::Mesh& mesh = body.model().mesh();
  PickFrame pick{.at = at, .volume = kNone};
  pick.fields.assign(list_fields().size(), kNone);
  const auto* own = mechanics::as<const fem::HasMaterial>(body);
  const auto set_material_fields = [&](const std::vector<double>& values) {  // after displacement
    std::ranges::transform(values, pick.fields.begin() + 1,
                           [](double value) { return static_cast<float>(value); });
  };
  const NodeId node = at.number;
  std::span<const NodeId> nodes(&node, 1);
  if (at.kind == PickKind::element) {
    nodes = fem::ElementList(mesh).nodes(at.number);
    if (!materials.empty()) pick.material = materials[static_cast<std::size_t>(at.number)];
    if (own != nullptr) {
      const fem::ElementValues values = fem::element_values(*own, at.number);
      pick.volume = static_cast<float>(values.volume);
      set_material_fields(values.fields);
    }
  } else {
    const Points moved = body.positions().row(node) - mesh.nodes.row(node);
    pick.fields.front() = static_cast<float>(moved.norm());
    if (own != nullptr) {
      set_material_fields(fem::node_fields(*own, node));
      const auto forces = fem::row_force_field(*own, sim::split_efforts(simulation).actuation);
      pick.fields.back() = static_cast<float>(forces[static_cast<std::size_t>(node)]);
    }
  }
  put_nodes(body.positions(), nodes, pick.positions);
  put_nodes(mesh.nodes, nodes, pick.rest);
  return pick;
}

}  // namespace sinew::viewer
