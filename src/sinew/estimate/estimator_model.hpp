/// @file
/// Estimators of a model: their unknowns and sensors.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/core/error.hpp"
#include "sinew/core/types.hpp"
#include "sinew/model/instrument_model.hpp"

namespace sinew::builder {
class ModelBuilder;
}

namespace sinew::model {
class Model;
}

namespace sinew::estimate {

/// A quantity that an estimator estimates.
struct Unknown {
  enum class Kind {
    force,   ///< a dead force on a point: components along x, y and z of the world
    effort,  ///< of an actuator: what is added to its commanded effort, see command_known
    /// The logarithm of a factor of all moduli of a finite-element body. The prior of the factor is
    /// lognormal with the median 1, so the factor stays positive.
    stiffness,
  };
  std::string name;
  Kind kind = Kind::force;
  int first_actuator = -1;  ///< of the estimator's robot: three forces in turn, or the actuator
  int body = -1;            ///< whose stiffness it is
  double prior = 1.0;  ///< standard deviation of each component before anything is measured, in its
                       ///< unit
  double walk = 1.0;   ///< its unit over sqrt(s), of each component's random walk
  /// Of an effort: whether the estimator knows the command. It then looks for the difference of
  /// effort and commanded effort; where it does not know, or no effort is commanded, for the whole.
  bool command_known = true;
  const char* unit = "N";

  int size() const { return kind == Kind::force ? 3 : 1; }
};

/// A sensor that an estimator uses.
struct EstimatorSensor {
  int index = 0;           ///< in sensors_of() the model with the estimator
  int effector = -1;       ///< of the estimator's robot, for a marker or orientation; else -1
  double deviation = 0.0;  ///< standard deviation of one sample, in its unit, > 0
  double delay = 0.0;      ///< s
  double period = 0.0;     ///< s between samples
  std::size_t size = 1;
};

/// The immutable part of an estimator.
struct EstimatorModel {
  std::string name;
  /// The robot as the estimator knows it: quasi-static, or with the integrator of the model with
  /// the estimator. Its sensors are those in `sensors`, in the same order; its actuators are those
  /// of that model, followed by the unknown forces.
  std::shared_ptr<const model::Model> robot;
  std::vector<EstimatorSensor> sensors;
  std::vector<Unknown> unknowns;
  std::vector<int>
      loads;     ///< (loads of `robot`,) indices in Model::loads() of the model with the estimator
  int lags = 0;  ///< number of steps of the longest delay
  int rank = 0;  ///< columns of the covariance for a robot with inertia, see MotionFilter

  Eigen::Index size() const;      ///< n: components of all unknowns
  Eigen::Index readings() const;  ///< m: numbers that all sensors say
  /// (n,) "hand.x", "hand.y", "hand.z" of a force, "leak" of an effort, "soft" of a stiffness.
  std::vector<std::string> component_names() const;
  /// (n,) the prior or walk of each component's unknown. @param number member of Unknown.
  VectorX of_components(double Unknown::*number) const;
  /// (k,) difference of two readings of a sensor; for an orientation, the rotation vector of R_to
  /// R_from^T. @param sensor index in `sensors`.
  /// @param to,from (k,) readings.
  VectorX difference(std::size_t sensor, const VectorX& to, const VectorX& from) const;
  /// (n,) for each component, the actuator of `robot` on whose effort it acts; -1 for a stiffness.
  std::vector<int> actuators() const;
  /// Whether a stiffness is among the unknowns.
  bool has_stiffness() const;
  /// Converts the components of stiffnesses from logarithms to factors, and their standard
  /// deviations to first order: std(exp(u)) = exp(u) std(u).
  /// @param mean,deviation (n,), in and out.
  void take_exponentials(VectorX& mean, VectorX& deviation) const;
};

/// The estimators of a model.
class EstimatorSet : public model::InstrumentModel {
 public:
  std::uint64_t hash() const override;
  std::unique_ptr<run::Instrument> start(const run::Run& run) const override;

  std::vector<EstimatorModel> estimators;
};

/// The estimators of a model; an empty list if it has none. @param model with them.
const std::vector<EstimatorModel>& estimators_of(const model::Model& model);
/// Index in estimators_of(). Throws Error(unknown-name) with a suggestion.
/// @param model with the estimator. @param name of the estimator.
int estimator_index(const model::Model& model, std::string_view name);

/// Settings for add_estimator(); sensors are given by name.
struct EstimatorSettings {
  std::string name;
  Location place;
  std::shared_ptr<const model::Model> robot;
  std::vector<std::string> sensors;
  std::vector<Location> sensor_places;
  std::vector<Unknown> unknowns;
  std::vector<int> loads;
  int rank = 0;  ///< see EstimatorModel
};

/// Adds an estimator, after the sensors that it uses. @return its index.
/// Throws Error: unknown-name (a sensor), out-of-range (a sensor without noise, or with a delay of
/// more than 100 steps).
/// @param builder of the model. @param settings of the estimator.
int add_estimator(builder::ModelBuilder& builder, const EstimatorSettings& settings);

}  // namespace sinew::estimate
