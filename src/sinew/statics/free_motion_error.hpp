/// @file
/// The error of a robot part of which moves freely.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "sinew/core/error.hpp"
#include "sinew/core/types.hpp"

namespace sinew::statics {

/// How the nodes of a body move in a motion of the robot.
struct BodyMotion {
  std::string body;
  Points positions;      ///< (n, 3), m
  Points displacements;  ///< (n, 3), relative to the largest of all bodies
};

/// Thrown if nothing resists a motion of the robot, and so no equilibrium can be found.
class FreeMotionError : public Error {
 public:
  FreeMotionError(const Error& error, std::vector<BodyMotion> motion)
      : Error(error), motion_(std::move(motion)) {}

  const std::vector<BodyMotion>& motion() const { return motion_; }

 private:
  std::vector<BodyMotion> motion_;
};

}  // namespace sinew::statics
