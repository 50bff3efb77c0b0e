#include "sinew/scene/urdf_bodies.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/core/rotation.hpp"
#include "sinew/mesh/topology.hpp"
#include "sinew/scene/body_kind.hpp"
#include "sinew/scene/build.hpp"
#include "sinew/scene/build_parts.hpp"
#include "sinew/scene/readers.hpp"

namespace sinew::scene {

namespace {

using Type = UrdfJoint::Type;

// The frame of a joint's child after the joint has moved.
Eigen::Isometry3d moved(const UrdfJoint& joint, double motion) {
  if (motion == 0.0) return joint.pose;
  if (joint.type == Type::prismatic) return joint.pose * Eigen::Translation3d(motion * joint.axis);
  return joint.pose * Eigen::AngleAxisd(motion, joint.axis);
}

std::optional<rigid::Shape> primitive(const UrdfGeometry& geometry) {
  if (const auto* box = std::get_if<rigid::Box>(&geometry.form)) return *box;
  if (const auto* ball = std::get_if<rigid::Sphere>(&geometry.form)) return *ball;
  if (const auto* rod = std::get_if<rigid::Cylinder>(&geometry.form)) return *rod;
  return std::nullopt;
}

// Inertia about the origin, by the parallel axis theorem.
Matrix3 inertia_at_origin(const rigid::MassProperties& own) {
  const Vector3& c = own.centre;
  return own.inertia + own.mass * (c.squaredNorm() * Matrix3::Identity() - c * c.transpose());
}

rigid::MassProperties sum(const std::vector<rigid::MassProperties>& parts) {
  rigid::MassProperties result;
  Matrix3 at_origin = Matrix3::Zero();
  for (const rigid::MassProperties& part : parts) {
    result.mass += part.mass;
    result.centre += part.mass * part.centre;
    at_origin += inertia_at_origin(part);
  }
  result.centre /= result.mass;
  const rigid::MassProperties point{result.mass, result.centre, Matrix3::Zero()};
  result.inertia = at_origin - inertia_at_origin(point);
  return result;
}

}  // namespace

UrdfBodies::UrdfBodies(const UrdfRobot& robot, const UrdfDescription& description, std::string name)
    : robot_(robot), description_(description), name_(std::move(name)) {
  read_starts();
  place_links();
  find_carriers();
}

std::string UrdfBodies::body_of(int link) const {
  const int at = carrier(link);
  if (at == kNone) return std::string(kWorldName);
  return name_ + "." + robot_.links[static_cast<std::size_t>(at)].name;
}

void UrdfBodies::read_starts() {
  starts_.assign(robot_.joints.size(), 0.0);
  for (const UrdfDescription::Start& start : description_.starts) {
    const auto joint = std::ranges::find(robot_.joints, start.joint, &UrdfJoint::name);
    const bool turns = joint != robot_.joints.end() &&
                       (joint->type == Type::revolute || joint->type == Type::continuous);
    const bool slides = joint != robot_.joints.end() && joint->type == Type::prismatic;
    if (start.turns ? !turns : !slides) {
      throw Error(
          ErrorKind::unknown_name, start.place,
          fmt::format("'{}' is not a joint that {}", start.joint, start.turns ? "turns" : "slides"),
          "name a joint of the file");
    }
    starts_[static_cast<std::size_t>(joint - robot_.joints.begin())] = start.value;
  }
  for (std::size_t k = 0; k < starts_.size(); ++k) {
    const UrdfJoint& joint = robot_.joints[k];
    if (joint.lower <= starts_[k] && starts_[k] <= joint.upper) continue;
    const bool turns = joint.type == Type::revolute;
    throw Error(
        ErrorKind::contradictory_limits, joint.place,
        fmt::format("it starts at {:g}, outside its limits {:g} and {:g}", starts_[k], joint.lower,
                    joint.upper),
        fmt::format("write {}: {{{}: {:g} {}}} under the body", turns ? "angles" : "displacements",
                    joint.name, 0.5 * (joint.lower + joint.upper), turns ? "rad" : "m"));
  }
}

void UrdfBodies::place_links() {
  Eigen::Isometry3d root = Eigen::Isometry3d::Identity();
  root.linear() = description_.rotation;
  root.translation() = description_.position;
  frames_.push_back(root);
  for (std::size_t k = 0; k < robot_.joints.size(); ++k) {
    const UrdfJoint& joint = robot_.joints[k];
    frames_.push_back(frame(joint.parent) * moved(joint, starts_[k]));
  }
}

// The carrier of the root. A free root without mass is merged into a link that is fixed to it.
int UrdfBodies::carrier_of_root() const {
  const UrdfLink& root = robot_.links.front();
  if (description_.fixed) {
    return root.visuals.empty() && root.collisions.empty() ? kNone : 0;
  }
  if (root.inertial) return 0;
  for (const UrdfJoint& joint : robot_.joints) {
    if (joint.parent == 0 && joint.type == Type::fixed &&
        robot_.links[static_cast<std::size_t>(joint.child)].inertial) {
      return joint.child;
    }
  }
  return 0;
}

void UrdfBodies::find_carriers() {
  carriers_.push_back(carrier_of_root());
  fixed_.push_back(description_.fixed ? 1 : 0);
  for (const UrdfJoint& joint : robot_.joints) {
    const UrdfLink& link = robot_.links[static_cast<std::size_t>(joint.child)];
    const bool tied = joint.type == Type::fixed, fixed = tied && is_fixed(joint.parent);
    const bool shown = !link.visuals.empty() || !link.collisions.empty();
    const int parent = carrier(joint.parent);
    int own = joint.child;
    if (tied && !link.inertial && !(fixed && parent == kNone && shown)) own = parent;
    if (fixed && link.inertial && !shown) own = parent;
    carriers_.push_back(own);
    fixed_.push_back(fixed ? 1 : 0);
  }
}

UrdfBodies::Parts UrdfBodies::parts_of(int carrier_link,
                                       std::vector<UrdfGeometry> UrdfLink::*kind) const {
  Parts parts;
  for (std::size_t k = 0; k < robot_.links.size(); ++k) {
    const int link = static_cast<int>(k);
    if (carrier(link) != carrier_link) continue;
    const Eigen::Isometry3d from = frame(carrier_link).inverse() * frame(link);
    for (const UrdfGeometry& geometry : robot_.links[k].*kind) {
      parts.push_back({&geometry, link == carrier_link ? geometry.pose : from * geometry.pose});
    }
  }
  return parts;
}

std::filesystem::path UrdfBodies::resolved(const UrdfMesh& mesh, const Location& place) const {
  constexpr std::string_view kPackage = "package://", kFile = "file://";
  const std::string_view written = mesh.file;
  std::filesystem::path path = description_.file.parent_path() / written;
  if (written.starts_with(kPackage)) {
    const std::string_view below = written.substr(kPackage.size());
    const std::size_t slash = std::min(below.find('/'), below.size());
    const auto package = description_.packages.find(std::string(below.substr(0, slash)));
    if (package == description_.packages.end()) {
      throw Error(ErrorKind::unknown_name, place,
                  fmt::format("the folder of package '{}' is not known", below.substr(0, slash)),
                  fmt::format("write packages: {{{}: FOLDER}} under body '{}'",
                              below.substr(0, slash), name_));
    }
    path = package->second / below.substr(std::min(slash + 1, below.size()));
  } else if (written.starts_with(kFile)) {
    path = written.substr(kFile.size());
  }
  std::error_code status;
  if (std::filesystem::is_regular_file(path, status)) return path;
  throw Error(ErrorKind::file_not_found, place, fmt::format("there is no file {}", written),
              fmt::format("looked for {}",
                          std::filesystem::absolute(path, status).lexically_normal().string()));
}

mesh::Surface UrdfBodies::surface_of(const UrdfGeometry& geometry) const {
  if (const auto shape = primitive(geometry)) return mesh::boundary_surface(rigid::skin(*shape));
  const auto& mesh = std::get<UrdfMesh>(geometry.form);
  MeshDescription file;
  file.place = geometry.place;
  file.file = resolved(mesh, geometry.place);
  file.unit_given = true;
  file.scale = mesh.scale;
  try {
    return make_surface(file);
  } catch (const Error& error) {
    throw Error(error.kind(), geometry.place, fmt::format("{}: {}", mesh.file, error.message()),
                error.remedy());
  }
}

mesh::Surface UrdfBodies::united(const Parts& parts) const {
  mesh::Surface result{.name = name_, .nodes = Points(0, 3), .triangles = {}};
  for (const Part& part : parts) {
    const mesh::Surface surface = surface_of(*part.geometry);
    const auto first = static_cast<NodeId>(result.nodes.rows());
    result.nodes.conservativeResize(first + surface.nodes.rows(), 3);
    result.nodes.bottomRows(surface.nodes.rows()) =
        sinew::moved(surface.nodes, part.pose.linear(), part.pose.translation());
    for (const auto& [a, b, c] : surface.triangles) {
      result.triangles.push_back({first + a, first + b, first + c});
    }
    if (parts.size() == 1) result.name = surface.name;
  }
  return result;
}

rigid::MassProperties UrdfBodies::mass_of(int link, const Parts& solids) const {
  const UrdfLink& own = robot_.links[static_cast<std::size_t>(link)];
  if (own.inertial) return *own.inertial;
  if (!description_.density || solids.empty()) {
    throw Error(ErrorKind::missing_mass, own.place, "it moves and has no mass",
                solids.empty()
                    ? "add <inertial> with <mass value=...> and <inertia ixx=... .../>"
                    : fmt::format("add <inertial>, or write density: 1000 kg/m^3 under body '{}' "
                                  "for that of its collision geometry",
                                  name_));
  }
  std::vector<rigid::MassProperties> parts;
  for (const Part& part : solids) {
    const std::optional<rigid::Shape> shape = primitive(*part.geometry);
    rigid::MassProperties mass = at_place(part.geometry->place, [&] {
      return rigid::mass_properties(shape ? *shape : make_solid(surface_of(*part.geometry), false),
                                    *description_.density);
    });
    mass.centre = part.pose * mass.centre;
    mass.inertia = part.pose.linear() * mass.inertia * part.pose.linear().transpose();
    parts.push_back(mass);
  }
  return sum(parts);
}

// A single primitive is kept, a single mesh touches with its hull, and several parts are united to
// one surface. A body without geometry gets a sphere of the same inertia.
void UrdfBodies::give_shape(const Parts& parts, rigid::RigidSettings& body) const {
  if (parts.empty()) {
    body.shape = rigid::Sphere{std::sqrt(2.5 / 3.0 * body.inertia->trace() / *body.mass)};
    body.shape_position = *body.centre_of_mass;
    return;
  }
  const std::optional<rigid::Shape> shape = primitive(*parts.front().geometry);
  if (parts.size() == 1 && shape) {
    body.shape = *shape;
    body.shape_position = parts.front().pose.translation();
    body.shape_rotation = parts.front().pose.linear();
    return;
  }
  body.shape = make_solid(united(parts), parts.size() == 1);
}

void UrdfBodies::give_look(const Parts& visuals, rigid::RigidSettings& body,
                           std::vector<Notice>& notices) const {
  try {
    body.look = std::make_shared<const mesh::Surface>(united(visuals));
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::unknown_format) throw;
    notices.push_back({NoticeLevel::warning, NoticeKind::unused_element, error.place(),
                       error.message() + ": the link's collision geometry is drawn",
                       "export the visual as STL or OBJ"});
  }
}

std::vector<BodyDescription> UrdfBodies::make(std::vector<Notice>& notices) const {
  std::vector<BodyDescription> bodies;
  for (std::size_t k = 0; k < robot_.links.size(); ++k) {
    const int link = static_cast<int>(k);
    if (carrier(link) != link) continue;
    BodyDescription& body = bodies.emplace_back();
    body.name = body_of(link);
    body.place = robot_.links[k].place;
    body.kind = &rigid_kind();
    auto& settings = body.own.emplace<rigid::RigidSettings>();
    settings.name = body.name;
    settings.position = frame(link).translation();
    settings.rotation = frame(link).linear();
    settings.fixed = is_fixed(link);
    const Parts visuals = parts_of(link, &UrdfLink::visuals);
    const Parts collisions = parts_of(link, &UrdfLink::collisions);
    const Parts& solids = collisions.empty() ? visuals : collisions;
    if (robot_.links[k].inertial || !settings.fixed) {
      const rigid::MassProperties mass = mass_of(link, solids);
      settings.mass = mass.mass;
      settings.inertia = mass.inertia;
      settings.centre_of_mass = mass.centre;
    }
    give_shape(solids, settings);
    if (!collisions.empty() && !visuals.empty()) give_look(visuals, settings, notices);
  }
  return bodies;
}

}  // namespace sinew::scene
