/// @file
/// Makes frames of a simulation.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "sinew/fem/element_fields.hpp"
#include "sinew/sim/observables.hpp"
#include "sinew/sim/simulation.hpp"

#include "describe.hpp"
#include "frame.hpp"

namespace sinew::viewer {

/// Makes frames of one robot.
class FrameMaker {
 public:
  /// @param simulation,observables,description of one robot; must outlive this.
  FrameMaker(const sim::Simulation& simulation, sim::Observables& observables,
             const Description& description);

  /// Makes a frame of the current state. @param wishes parts of the frame besides positions.
  std::shared_ptr<Frame> make(const FrameWishes& wishes);

 private:
  void fill_signals(Frame& frame);
  void fill_body(std::size_t index, const FrameWishes& wishes, BodyFrame& frame);
  void fill_points(Frame& frame);
  void fill_contacts(Frame& frame);

  /// Indices of the observables of a contact.
  struct ContactPlaces {
    std::size_t pose, position, normal, normal_force, friction_force, state;
  };
  void find_contacts();

  const sim::Simulation& simulation_;
  sim::Observables& observables_;
  const Description& description_;
  std::vector<std::unique_ptr<fem::NodalMean>> means_;  ///< one per body; null for an arm
  std::vector<ContactPlaces> contacts_;
};

}  // namespace sinew::viewer
