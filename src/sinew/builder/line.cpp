#include "sinew/builder/line.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "sinew/constraint/cable.hpp"
#include "sinew/core/whole.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/model/model_data.hpp"

namespace sinew::builder {

namespace {

constexpr double kMaxGuides = 1e4;  // between two points

}  // namespace

LinePath set_guides(LinePath written, double spacing) {
  if (spacing <= 0.0 || written.points.rows() < 2) return written;
  const std::vector<Location>& places = written.places;
  const std::vector<int>& bodies = written.bodies;
  std::vector<Vector3> all{written.points.row(0)};
  LinePath result;
  result.bodies.push_back(bodies.front());
  if (!places.empty()) result.places.push_back(places.front());
  for (Eigen::Index i = 1; i < written.points.rows(); ++i) {
    const Vector3 from = written.points.row(i - 1), to = written.points.row(i);
    // The tolerance keeps lengths that are multiples of the spacing, up to rounding, from getting
    // an extra guide.
    const double parts = std::ceil((to - from).norm() / spacing - 1e-6);
    if (!(parts <= kMaxGuides)) {
      throw Error(
          ErrorKind::out_of_range, {},
          fmt::format("guides {:g} m apart would be {:g} between two points", spacing, parts),
          "give a greater spacing, or check its unit");
    }
    // Between two bodies, the line is free of guides.
    const auto end = static_cast<std::size_t>(i);
    const int pieces = bodies[end] == bodies[end - 1] ? whole<int>(parts, 1) : 1;
    for (int k = 1; k <= pieces; ++k) {
      all.push_back(from + static_cast<double>(k) / pieces * (to - from));
      result.bodies.push_back(bodies[end]);
      if (end < places.size()) result.places.push_back(places[end]);
    }
  }
  result.points.resize(static_cast<Eigen::Index>(all.size()), 3);
  for (std::size_t k = 0; k < all.size(); ++k) {
    result.points.row(static_cast<Eigen::Index>(k)) = all[k].transpose();
  }
  return result;
}

std::unique_ptr<constraint::Cable> attach_line(model::ModelData& data, Line line) {
  auto& [rest, places, bodies] = line.path;
  std::vector<mechanics::MaterialPoint> points;
  std::optional<Vector3> pull_point;
  for (Eigen::Index i = 0; i < rest.rows(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (i == 0 && line.from_world) {
      pull_point = Vector3(rest.row(0));
      continue;
    }
    const std::string what = fmt::format("point {} of {} '{}'", i, line.kind, line.name);
    mechanics::BodyModel& on = data.body(bodies[k]);
    try {
      points.push_back(
          {bodies[k], on.attach_ball(rest.row(i), line.guide_radius, line.outside, what)});
    } catch (const Error& error) {
      throw error.at(k < places.size() ? places[k] : line.place);
    }
    rest.row(i) = on.rest_position(points.back().number);
  }
  return std::make_unique<constraint::Cable>(line.name, std::move(points), pull_point, rest,
                                             line.friction);
}

}  // namespace sinew::builder
