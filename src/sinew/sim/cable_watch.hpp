/// @file
/// What a run shows about the cables of a scene that its author should know.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sinew/core/error.hpp"
#include "sinew/core/notice.hpp"
#include "sinew/core/types.hpp"

namespace sinew::mesh {
class Embedder;
}

namespace sinew::sim {

struct CablePath;
class Simulation;

/// A cable to be watched.
struct WatchedCable {
  int actuator = -1;          ///< index in Model::actuators()
  Location place;             ///< for messages
  bool radius_given = false;  ///< whether the scene chose the radius of its guides, even zero
};

/// Watches the cables of a run with commanded displacements, and tells of those
/// - that were slack in every step (NoticeKind::slack_cable);
/// - that run straight where the body bends (NoticeKind::bowstring): between two points of a body,
///   a straight cable is beside the material that it passed through at rest, with another lever;
/// - whose pull is used up in dents at bare points (NoticeKind::bare_points), by the length that
///   the path would have if each point were the mean of a ball as large as an element.
/// It reads only: a watched run has the same bits.
class CableWatch {
 public:
  /// @param simulation must outlive it. @param cables of its model.
  CableWatch(const Simulation& simulation, std::span<const WatchedCable> cables);
  ~CableWatch();
  CableWatch(const CableWatch&) = delete;
  CableWatch& operator=(const CableWatch&) = delete;

  /// Takes the present state. Call it after every step.
  void after_step();
  /// What was seen, in the order of the cables. Remarks are on cables that were paid out beside
  /// others of the same body that pull, as antagonists are.
  std::vector<Notice> notices() const;

 private:
  struct Watched {
    WatchedCable cable;
    std::unique_ptr<CablePath> path;
    bool commanded = true, slack = true;  // in all steps: by a displacement; without tension
    double least = 0.0, most = 0.0;       // m, commanded displacements
    double stray = 0.0;                   // m, largest distance of a span from its material
    int span = 0;                         // the point where that span begins
    double pulled = 0.0, lost = 0.0;      // m, at the largest pull, and what dents took of it
  };
  std::vector<Notice> of_slack(const Watched& one) const;
  std::vector<Notice> of_path(const Watched& one) const;
  bool has_taut_neighbour(const Watched& one) const;

  const Simulation& simulation_;
  std::vector<Watched> cables_;
  std::map<int, std::unique_ptr<mesh::Embedder>> embedders_;  // by body
  std::int64_t steps_ = 0;
};

}  // namespace sinew::sim
