// Converts loads into nodal forces.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "sinew/builder/add_parts.hpp"
#include "sinew/builder/find_body.hpp"
#include "sinew/builder/hydrostatic.hpp"
#include "sinew/builder/load_settings.hpp"
#include "sinew/core/error.hpp"
#include "sinew/mechanics/bears_loads.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/mesh/line_cuts.hpp"
#include "sinew/model/model_data.hpp"
#include "sinew/model/new_name.hpp"

namespace sinew::builder {

namespace {

constexpr const char* kOfLine = "a point of the line";
/// Three-point Gauss rule on [-1, 1]: points and weights.
constexpr std::array<std::array<double, 2>, 3> kGauss = {
    {{-0.7745966692414834, 5.0 / 9.0}, {0.0, 8.0 / 9.0}, {0.7745966692414834, 5.0 / 9.0}}};

/// Makes the loads of one entry; there are two if both pressure and motion matter.
class LoadMaker {
 public:
  explicit LoadMaker(const LoadSite& site) : body_(site.body), settings_(site.settings) {}

  std::vector<mechanics::Load> make(const PointLoadSettings& load) {
    spread(load.point, load.force, "the point");
    return {dead()};
  }

  // Integrates element by element, where the shape functions along the line are polynomials, of
  // degree 3 at most in undistorted elements; three Gauss points are exact to degree 5.
  std::vector<mechanics::Load> make(const LineLoadSettings& load) {
    if (load.points.rows() < 2) {
      throw Error(ErrorKind::too_few_points, settings_.place,
                  fmt::format("a line needs two points, got {}", load.points.rows()),
                  "give where it begins and ends");
    }
    for (Eigen::Index i = 0; i + 1 < load.points.rows(); ++i) {
      const Vector3 from = load.points.row(i).transpose(), to = load.points.row(i + 1).transpose();
      const std::vector<double> cuts = mesh::line_cuts(mesh(), from, to);
      for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
        spread_evenly(from + cuts[k] * (to - from), from + cuts[k + 1] * (to - from),
                      load.force_per_length);
      }
    }
    return {dead()};
  }

  std::vector<mechanics::Load> make(const SurfaceLoadSettings& load) {
    const Points forces = mechanics::traction_forces(mesh().nodes, load.faces, load.traction);
    for (NodeId node = 0; node < static_cast<NodeId>(forces.rows()); ++node) {
      if (!forces.row(node).isZero(0.0)) forces_[node] = forces.row(node).transpose();
    }
    return {dead()};
  }

  std::vector<mechanics::Load> make(const BodyLoadSettings& load) {
    return {body_.inertial_load(load.acceleration)};
  }

  std::vector<mechanics::Load> make(const PressureLoadSettings& load) {
    return {mechanics::PressureLoad{.faces = load.faces, .pressure = 1.0}};
  }

  std::vector<mechanics::Load> make(const WaterSettings& water) {
    const std::vector<std::pair<const char*, double>> numbers{
        {"density", water.density},
        {"normal_drag", water.normal_drag},
        {"tangential_drag", water.tangential_drag},
        {"added_mass", water.added_mass}};
    for (const auto& [name, value] : numbers) {
      if (value >= 0.0 && std::isfinite(value)) continue;
      throw Error(ErrorKind::out_of_range, settings_.place, fmt::format("{} is {:g}", name, value),
                  "give zero or more");
    }
    return {hydrostatic(body_, water.faces, water.density, water.level),
            mechanics::WaterLoad{.faces = water.faces,
                                 .density = water.density,
                                 .normal_drag = water.normal_drag,
                                 .tangential_drag = water.tangential_drag,
                                 .added_mass = water.added_mass,
                                 .velocity = water.velocity}};
  }

 private:
  const mesh::Mesh& mesh() const { return body_.load_mesh(); }

  // A piece within one element. Outside the mesh, the nearest element is used, which may change
  // along the piece.
  void spread_evenly(const Vector3& from, const Vector3& to, const Vector3& force_per_length) {
    const bool inside = locate(0.5 * (from + to), kOfLine).distance == 0.0;
    const int parts = inside ? 1 : 20;
    const double length = (to - from).norm() / parts;
    for (int part = 0; part < parts; ++part) {
      for (const auto& [at, weight] : kGauss) {
        const double share = (part + 0.5 + 0.5 * at) / parts;
        spread(from + share * (to - from), 0.5 * weight * length * force_per_length, kOfLine);
      }
    }
  }

  mesh::EmbeddedPoint locate(const Vector3& point, const char* what) const {
    return body_.carry(point, settings_.outside,
                       fmt::format("{} of load '{}'", what, settings_.name));
  }

  void spread(const Vector3& point, const Vector3& force, const char* what) {
    const mesh::EmbeddedPoint attached = locate(point, what);
    for (std::size_t k = 0; k < attached.nodes.size(); ++k) {
      const auto found = forces_.try_emplace(attached.nodes[k], Vector3::Zero()).first;
      found->second += attached.weights[k] * force;
    }
  }

  mechanics::DeadLoad dead() const {
    mechanics::DeadLoad load;
    load.forces.resize(static_cast<Eigen::Index>(forces_.size()), 3);
    for (const auto& [node, force] : forces_) {
      load.forces.row(static_cast<Eigen::Index>(load.nodes.size())) = force.transpose();
      load.nodes.push_back(node);
    }
    return load;
  }

  mechanics::BearsLoads& body_;
  const LoadSettings& settings_;
  std::map<NodeId, Vector3> forces_;
};

}  // namespace

std::vector<mechanics::Load> PointLoadSettings::operator()(const LoadSite& site) const {
  return LoadMaker(site).make(*this);
}
std::vector<mechanics::Load> LineLoadSettings::operator()(const LoadSite& site) const {
  return LoadMaker(site).make(*this);
}
std::vector<mechanics::Load> SurfaceLoadSettings::operator()(const LoadSite& site) const {
  return LoadMaker(site).make(*this);
}
std::vector<mechanics::Load> BodyLoadSettings::operator()(const LoadSite& site) const {
  return LoadMaker(site).make(*this);
}
std::vector<mechanics::Load> PressureLoadSettings::operator()(const LoadSite& site) const {
  return LoadMaker(site).make(*this);
}
std::vector<mechanics::Load> WaterSettings::operator()(const LoadSite& site) const {
  return LoadMaker(site).make(*this);
}

int add_load(model::ModelData& data, const LoadSettings& settings) {
  model::check_new_name(data.loads, &model::LoadModel::name, "loads", settings.name,
                        settings.place);
  auto* body = mechanics::as<mechanics::BearsLoads>(find_body(data, settings.body, settings.place));
  if (body == nullptr) {
    throw Error(ErrorKind::wrong_type, settings.place, "this body takes no loads",
                "name a finite-element or a rigid body");
  }
  try {
    model::LoadModel load{settings.name, settings.body, {}, settings.factor, settings.factor_name};
    for (mechanics::Load& part : settings.load({*body, settings})) {
      load.numbers.push_back(body->add_load(std::move(part)));
    }
    data.loads.push_back(std::move(load));
    return static_cast<int>(data.loads.size()) - 1;
  } catch (const Error& error) {
    throw error.at(settings.place);
  }
}

}  // namespace sinew::builder
