/// @file
/// The tangent planes that represent surfaces in the contact problem of a step.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "sinew/core/types.hpp"
#include "sinew/mechanics/rows.hpp"
#include "sinew/model/base_motion.hpp"

namespace sinew {
class ThreadPool;
}
namespace sinew::collision {
struct ShapeApproach;
}
namespace sinew::constraint {
class Contact;
class Configuration;
class ShapeContact;
}  // namespace sinew::constraint

namespace sinew::model {
struct ContactModel;
class Model;
}  // namespace sinew::model

namespace sinew::contact {

class TouchingSurfaces;

/// One tangent plane for every contact point. It is first chosen by the path that the point takes
/// at its present velocity, and may be updated to the path of a solution (constraint::Contact).
class ContactPlanes {
 public:
  /// All must outlive it. @param model with the contacts. @param configuration of its bodies.
  /// @param rows receives the contact frames. @param pool see TouchingSurfaces.
  ContactPlanes(const model::Model& model, const constraint::Configuration& configuration,
                mechanics::RowValues& rows, ThreadPool& pool);
  ~ContactPlanes();
  ContactPlanes(const ContactPlanes&) = delete;
  ContactPlanes& operator=(const ContactPlanes&) = delete;

  /// In the model's order.
  std::span<const constraint::Contact* const> contacts() const { return contacts_; }
  /// A contact with a shape; null for a contact between surfaces of bodies.
  const constraint::ShapeContact* shape(std::size_t contact) const { return shapes_[contact]; }
  /// The surfaces of a contact between bodies; null for a contact with a shape.
  TouchingSurfaces* touching(std::size_t contact) const { return touching_[contact]; }
  /// Places the planes for a step. Call before bodies follow their bases, whose motion then counts
  /// as motion along the surface.
  /// @param from,to s, start and end of the step, which fix the positions of moving surfaces.
  void place(double from, double to);
  /// Finds the points of contacts between surfaces.
  /// @param reach m: pairs that are nearer get points. @param ahead s: also pairs that may meet in
  ///   this time, see TouchingSurfaces::look_ahead().
  /// @param effort (rows,) N of the last step, in and out: points keep their forces.
  void find_points(double reach, double ahead, std::span<double> effort);
  /// Finds the points of contacts that strike. find_points() then searches these contacts with the
  /// same reach, so a part of a step has the points that were found at its start.
  /// @param reach,ahead,effort see find_points().
  void find_striking_points(double reach, double ahead, std::span<double> effort);
  /// Updates the planes to the end of a part of an event-driven step: surfaces of the world move to
  /// their positions at a time, with unchanged frames. A call with the time of place(), the middle
  /// of the part, undoes this. Call after a measurement of delta. @param time s.
  void move_on(double time);
  /// Whether any surface of the world may move in the step.
  bool moves() const { return !carried_.empty(); }
  /// Whether impacts are events: the points of striking surfaces are then searched at the start of
  /// each part of a step.
  void set_events(bool events) { events_ = events; }
  /// What normals of touching points do in the coming steps; see mechanics::RollingPoint.
  void let_normals_turn(mechanics::RollingPoint::Turning turning) { turning_ = turning; }
  mechanics::RollingPoint::Turning turning() const { return turning_; }
  /// Whether the coming steps are first halves of steps of the midpoint rule, or, after their
  /// motion was doubled, whole steps again.
  void set_halved(bool halved) { rows_.halved = halved; }
  /// Discards the points of contacts between surfaces.
  void forget_points();
  /// The surface pairs of contacts between surfaces.
  std::span<const std::unique_ptr<TouchingSurfaces>> surfaces() const { return surfaces_; }
  /// Stores delta at the start of the step. Call after a measurement of delta.
  void begin();
  /// The same for a point that is found during the step. @param row of its normal.
  void begin_point(int row) { start_.segment<3>(row) = rows_.reference.segment<3>(row); }
  /// Shifts a point's plane so that its gap is zero at the start of the step.
  /// @param row of its normal.
  void keep_gap(int row);
  /// Increases the gap of a point in the step. @param row of its normal. @param more m.
  void widen(int row, double more);
  /// Whether any surface is curved.
  bool curved() const { return curved_; }
  /// Pose of the surface that the planes of the step refer to: at the end of the step, or for a
  /// surface carried by a body, at its start. @param contact index in contacts().
  const Eigen::Isometry3d& pose(std::size_t contact) const { return poses_[contact]; }
  /// Present pose of the surface. @param contact index in contacts(). @param time s.
  Eigen::Isometry3d pose_now(std::size_t contact, double time) const;

  /// (3,) m/s: velocity of a point relative to its surface. A surface with a prescribed motion
  /// counts with its mean velocity in the step; if impacts are events, with its velocity at the
  /// start of the part, or at the time of move_on().
  /// @param contact of contacts(). @param point below its size().
  Vector3 velocity_beside(const constraint::Contact& contact, std::size_t point) const;
  /// (3,) m/s: the same for the centre of the point's body. @param contact,point as above.
  Vector3 centre_velocity_beside(const constraint::Contact& contact, std::size_t point) const;
  /// (3,) m/s: velocity of a surface of the world at a point that touches it; zero if at rest.
  /// @param contact,point as above.
  Vector3 surface_velocity(const constraint::Contact& contact, std::size_t point) const;

  /// Whether planes may still turn in this step; the number of rounds is limited.
  bool may_turn() const { return turns_left_ > 0; }
  void end_round() { --turns_left_; }
  /// Replaces a point's plane by that of the path to the point's proposed position.
  /// @return whether that path meets the surface.
  /// @param contact,point which. @param end (3,) m. @param pose of the surface.
  bool turn_to(const constraint::ShapeContact& contact, std::size_t point, const Vector3& end,
               const Eigen::Isometry3d& pose);
  /// Replaces the plane of a point with a force by that of the path that the point would take
  /// without this force, if that plane differs. @return whether it does.
  /// @param contact,point,pose as for turn_to().
  /// @param free (3,) m, the point's rows without its force.
  bool follow_way(const constraint::ShapeContact& contact, std::size_t point, const Vector3& free,
                  const Eigen::Isometry3d& pose);

  /// Replaces the planes of curved surfaces by the tangent planes nearest to the points' present
  /// positions.
  void follow_points();
  /// (rows,) 1/m: for curved surfaces, the rate at which the normal turns along tangential rows, as
  /// of the last follow_points(); zero elsewhere.
  const VectorX& curvature() const { return curvature_; }

  /// m: largest difference between the exact gap of a touching point and the gap from its plane,
  /// with surfaces at their poses at a time.
  /// @param effort (rows,) N, which defines the touching points. @param time s.
  double drift(std::span<const double> effort, double time);
  /// (rows,) m: delta of contacts when the step began.
  const VectorX& start() const { return start_; }

  /// Normal and tangents of every point in the last step, 9 numbers each; the efforts of its rows
  /// refer to them.
  std::size_t frames_size() const;
  void save_frames(std::vector<double>& frames) const;
  void load_frames(std::span<const double> frames);
  /// The points of contacts between surfaces, whose number varies.
  void save_points(std::vector<double>& points) const;
  /// Throws Error(wrong-length).
  void load_points(std::span<const double> points);

 private:
  void turn(const constraint::ShapeContact& contact, std::size_t point,
            const collision::ShapeApproach& plane);

  const model::Model& model_;
  const constraint::Configuration& configuration_;
  mechanics::RowValues& rows_;
  std::vector<const constraint::Contact*> contacts_;
  std::vector<const constraint::ShapeContact*> shapes_;
  std::vector<std::unique_ptr<TouchingSurfaces>> surfaces_;
  std::vector<TouchingSurfaces*> touching_;  // (contacts,)
  VectorX start_;
  VectorX curvature_;
  bool curved_ = false;
  std::vector<Eigen::Isometry3d> poses_;  // (contacts,)
  struct Carried {
    Eigen::Isometry3d from_end;    // from its pose at the end of the step to that at its start
    Eigen::Isometry3d placed;      // pose in the step
    model::BaseMotion::Rate rate;  // at the start of the part, or at the time of move_on()
    const constraint::ShapeContact* contact;
    const model::ContactModel* model;
  };
  std::vector<Carried> carried_;  // surfaces of the world that may move
  std::vector<char> strikes_;     // (surfaces,)
  double time_step_ = 0.0;        // s
  double placed_ = 0.0;           // s, time for which the planes were placed
  VectorX moved_on_;              // (rows,) m, added to the offsets by move_on()
  bool events_ = false;
  mechanics::RollingPoint::Turning turning_ = mechanics::RollingPoint::Turning::fixed;
  int turns_left_ = 0;
};

}  // namespace sinew::contact
