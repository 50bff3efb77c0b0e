/// @file
/// The tangent planes that surfaces count as in a step.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "sinew/core/types.hpp"
#include "sinew/mechanics/rows.hpp"
#include "sinew/sim/base_motion.hpp"

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

namespace sinew::sim {

struct ContactModel;
class Model;
class TouchingSurfaces;

/// One plane for every point that may touch. It begins as that which the way at the point's
/// velocity leads to, and may follow the way that a solution finds (constraint::Contact).
class ContactPlanes {
 public:
  /// All must outlive it. @param model whose contacts they are. @param configuration of its bodies.
  /// @param rows gets the frames of contacts. @param pool see TouchingSurfaces.
  ContactPlanes(const Model& model, const constraint::Configuration& configuration,
                mechanics::RowValues& rows, ThreadPool& pool);
  ~ContactPlanes();
  ContactPlanes(const ContactPlanes&) = delete;
  ContactPlanes& operator=(const ContactPlanes&) = delete;

  /// In the model's order.
  std::span<const constraint::Contact* const> contacts() const { return contacts_; }
  /// The same as contacts with shapes; null where surfaces touch each other.
  const constraint::ShapeContact* shape(std::size_t contact) const { return shapes_[contact]; }
  /// Before bodies follow their bases: what they are carried by counts as motion along the surface.
  /// @param from,to s, when the step begins and ends: where surfaces stand then.
  void place(double from, double to);
  /// The points of contacts between surfaces. @param reach m: nearer ones have points.
  /// @param effort (rows,) N of the last step, in and out: points take theirs along.
  void find_points(double reach, std::span<double> effort);
  /// Those of contacts that strike. find_points() finds these again, as far as here, so that a part
  /// of a step has the points that were looked at when it began. @param reach,effort see there.
  void find_striking_points(double reach, std::span<double> effort);
  /// Once more where a part of an event-driven step has been carried on to: surfaces of the world
  /// go on to where they are at a time, along the frames that the part has. Back again by its
  /// middle, for which place() was called. After a measurement of delta. @param time s.
  void move_on(double time);
  /// Whether any surface of the world may move in the step.
  bool moves() const { return !carried_.empty(); }
  /// Whether impacts are events: in their steps points of striking surfaces are looked for when a
  /// part begins.
  void set_events(bool events) { events_ = events; }
  /// Those of contacts between surfaces are forgotten.
  void forget_points();
  /// Of contacts between surfaces.
  std::span<const std::unique_ptr<TouchingSurfaces>> surfaces() const { return surfaces_; }
  /// After a measurement of delta there: where contacts begin.
  void begin();
  /// The same of a point that is found later. @param row its normal's.
  void begin_point(int row) { start_.segment<3>(row) = rows_.reference.segment<3>(row); }
  /// Moves a point's plane so that its gap is zero where the step begins. @param row its normal's.
  void keep_gap(int row);
  /// Adds to the gap of a point in the step. @param row its normal's. @param more m.
  void widen(int row, double more);
  /// Whether any surface is curved.
  bool curved() const { return curved_; }
  /// Of the surface that a step's planes touch: where it stands at the end of the step, or where
  /// its carrier was when the step began. @param contact of contacts().
  const Eigen::Isometry3d& pose(std::size_t contact) const { return poses_[contact]; }
  /// Of the surface now. @param contact of contacts(). @param time s.
  Eigen::Isometry3d pose_now(std::size_t contact, double time) const;

  /// (3,) m/s: how fast a point slides or leaves, also where the surface moves of itself. That
  /// counts with its mean velocity in the step; where impacts are events, with that which it has
  /// where the part begins, or has been carried on to.
  /// @param contact of contacts(). @param point below its size().
  Vector3 velocity_beside(const constraint::Contact& contact, std::size_t point) const;
  /// (3,) m/s: of the centre of the point's body. @param contact,point as above.
  Vector3 centre_velocity_beside(const constraint::Contact& contact, std::size_t point) const;
  /// (3,) m/s: of a surface of the world at a point that touches it; zero of one that stands still.
  /// @param contact,point as above.
  Vector3 surface_velocity(const constraint::Contact& contact, std::size_t point) const;

  /// Planes turn in a bounded number of rounds a step, after which they stay as they are.
  bool may_turn() const { return turns_left_ > 0; }
  void end_round() { --turns_left_; }
  /// Turns a point's plane to that of the way to where the point will be. Whether that way meets
  /// the surface. @param contact,point which. @param end (3,) m. @param pose of the surface.
  bool turn_to(const constraint::ShapeContact& contact, std::size_t point, const Vector3& end,
               const Eigen::Isometry3d& pose);
  /// Turns a pushed point's plane to that of the way that it would go without its own force, where
  /// that is another one. Whether it is. @param contact,point,pose as for turn_to(). @param free
  /// (3,) m, the point's rows without its force.
  bool follow_way(const constraint::ShapeContact& contact, std::size_t point, const Vector3& free,
                  const Eigen::Isometry3d& pose);

  /// Curved surfaces become their tangent planes at the points' nearest, where points are now.
  void follow_points();
  /// (rows,) 1/m: of curved surfaces at their last follow_points(), how fast their normals turn
  /// along tangential rows; zero elsewhere.
  const VectorX& curvature() const { return curvature_; }

  /// m: the farthest that any touching point's gap is from that of its plane, at the pose that
  /// surfaces have at a time. @param effort (rows,) N; who touches. @param time s.
  double drift(std::span<const double> effort, double time);
  /// (rows,) m: delta of contacts when the step began.
  const VectorX& start() const { return start_; }

  /// Normal and tangents of every point, as of the last step, 9 numbers each: what the efforts of
  /// its rows mean.
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

  const Model& model_;
  const constraint::Configuration& configuration_;
  mechanics::RowValues& rows_;
  std::vector<const constraint::Contact*> contacts_;
  std::vector<const constraint::ShapeContact*> shapes_;
  std::vector<std::unique_ptr<TouchingSurfaces>> surfaces_;
  VectorX start_;
  VectorX curvature_;
  bool curved_ = false;
  std::vector<Eigen::Isometry3d> poses_;  // (contacts,)
  struct Carried {
    const constraint::ShapeContact* contact;
    const ContactModel* model;
    Eigen::Isometry3d from_end;  // to where it was when the step began
    Eigen::Isometry3d placed;    // where it is in the step
    BaseMotion::Rate rate;       // where the part begins, or has been carried on to
  };
  std::vector<Carried> carried_;  // surfaces of the world that may move
  std::vector<char> strikes_;     // (surfaces,)
  double time_step_ = 0.0;        // s
  double placed_ = 0.0;           // s, when the planes are where they were placed
  VectorX moved_on_;              // (rows,) m, what move_on() has added to offsets
  bool events_ = false;
  int turns_left_ = 0;
};

}  // namespace sinew::sim
