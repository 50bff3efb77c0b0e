/// @file
/// The largest stretches of a run, for notices about library laws that were not tested there.
#pragma once

#include <vector>

#include "sinew/core/notice.hpp"
#include "sinew/core/types.hpp"

namespace sinew::material {
struct NamedMaterial;
}
namespace sinew::sim {
class Simulation;
}

namespace sinew::scene {

struct Robot;

/// Follows the largest principal stretch of the elements whose material is from the library. Laws
/// that the scene scales are matched to a test of its author and not watched for softness.
class StrainWatch {
 public:
  /// @param robot whose model outlives this.
  explicit StrainWatch(const Robot& robot);
  /// Whether no element has a law to be watched.
  bool idle() const { return watched_.empty(); }
  /// Takes the present state. It costs about a tenth of a step: call it for some states of a run.
  /// @param simulation of the robot.
  void see(const sim::Simulation& simulation);
  /// Warnings (strain-range) about laws that are too soft at the strains seen, and about strains
  /// beyond those of a law's test. None for a robot that did not strain.
  std::vector<Notice> notices() const;

 private:
  struct Watched {
    const material::NamedMaterial* law;
    Location place;
    int body;
    std::vector<NodeId> elements;  ///< empty: all
    bool scaled;
    double largest = 1.0;  ///< stretch
  };
  std::vector<Watched> watched_;
};

}  // namespace sinew::scene
