#include "sinew/constraint/configuration.hpp"

#include <cstddef>
#include <utility>

#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/capabilities.hpp"

namespace sinew::constraint {

namespace {

const mechanics::Body& body_of(std::span<const std::unique_ptr<mechanics::Body>> bodies,
                               const mechanics::Site& site) {
  return *bodies[static_cast<std::size_t>(site.body)];
}

}  // namespace

Configuration::Configuration(std::span<const std::unique_ptr<mechanics::Body>> bodies)
    : bodies_(bodies) {
  for (const auto& body : bodies_) {
    oriented_.push_back(mechanics::as<const mechanics::HasOrientations>(std::as_const(*body)));
  }
}

Vector3 Configuration::position(const mechanics::MaterialPoint& point) const {
  return body_of(bodies_, point).position(point.number);
}

Matrix3 Configuration::rotation(const mechanics::Orientation& section) const {
  return oriented_[static_cast<std::size_t>(section.body)]->rotation(section.number);
}

double Configuration::coordinate(const mechanics::Coordinate& coordinate) const {
  return mechanics::as<const mechanics::HasCoordinates>(body_of(bodies_, coordinate))
      ->coordinate(coordinate.number);
}

Vector3 Configuration::velocity(const mechanics::Site& site) const {
  return body_of(bodies_, site).velocity(site.number);
}

const Points& Configuration::surface_nodes(int body) const {
  return mechanics::as<const mechanics::HasSurfaceNodes>(*bodies_[static_cast<std::size_t>(body)])
      ->surface_nodes();
}

const Points& Configuration::surface_node_velocities(int body) const {
  return mechanics::as<const mechanics::HasSurfaceNodes>(*bodies_[static_cast<std::size_t>(body)])
      ->surface_node_velocities();
}

}  // namespace sinew::constraint
