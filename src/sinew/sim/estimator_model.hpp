/// @file
/// Estimators of a model: what each concludes from which sensors.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sinew/core/error.hpp"

namespace sinew::sim {

class Model;

/// A dead force of unknown size and direction on a point.
struct UnknownForce {
  std::string name;
  int first_actuator = 0;  ///< of the estimator's robot: forces along x, y and z of the world
  double prior = 1.0;      ///< N, standard deviation of each component before anything is measured
  double walk = 1.0;       ///< N/sqrt(s), of each component's random walk
};

/// A sensor that an estimator goes by.
struct EstimatorSensor {
  int index = 0;           ///< in Model::sensors() of the model that has the estimator
  int effector = -1;       ///< of the estimator's robot, of a marker or an orientation; else -1
  double deviation = 0.0;  ///< of one sample, in its unit, > 0
  double delay = 0.0;      ///< s
  double period = 0.0;     ///< s between samples
  std::size_t size = 1;
};

/// Immutable part of an estimator.
struct EstimatorModel {
  std::string name;
  /// The robot as the estimator knows it, quasi-static: its sensors are those of `sensors`, in
  /// their order, and its actuators those of the model with the estimator, then the unknown forces.
  std::shared_ptr<const Model> robot;
  std::vector<EstimatorSensor> sensors;
  std::vector<UnknownForce> unknowns;
  std::vector<int>
      loads;     ///< (loads of `robot`,) in Model::loads() of the model with the estimator
  int lags = 0;  ///< steps of the longest delay

  /// (3 unknowns,) "hand.x", "hand.y", "hand.z".
  std::vector<std::string> component_names() const;
};

/// What ModelBuilder::add_estimator() is told: sensors by name.
struct EstimatorSettings {
  std::string name;
  Location place;
  std::shared_ptr<const Model> robot;
  std::vector<std::string> sensors;
  std::vector<Location> sensor_places;
  std::vector<UnknownForce> unknowns;
  std::vector<int> loads;
};

}  // namespace sinew::sim
