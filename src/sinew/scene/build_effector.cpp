#include "sinew/builder/effector_settings.hpp"
#include "sinew/builder/model_builder.hpp"
#include "sinew/core/error.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/scene/build_parts.hpp"

namespace sinew::scene {

void add_effector(builder::ModelBuilder& builder, const EffectorDescription& effector,
                  const BodyOf& body_of) {
  const auto [body, model] = body_of(effector.body);
  builder::EffectorSettings settings;
  settings.name = effector.name;
  settings.place = effector.place;
  settings.body = body;
  settings.points = effector.points.points;
  settings.outside = effector.outside;
  if (effector.kind == EffectorDescription::Kind::set) {
    settings.kind = builder::EffectorSettings::Kind::nodes;
    try {
      settings.nodes =
          mesh::select_nodes(model->mesh(), mesh::NamedRegion{effector.set}, effector.name);
    } catch (const Error& error) {
      throw error.at(effector.set_place);
    }
  } else if (effector.kind == EffectorDescription::Kind::orientation) {
    settings.kind = builder::EffectorSettings::Kind::orientation;
  }
  for (Eigen::Index i = 0; i < effector.directions.rows(); ++i) {
    settings.directions.emplace_back(effector.directions.row(i).transpose());
  }
  builder.add_effector(settings);
}

}  // namespace sinew::scene
