/// @file
/// Hands and contacts of a snapshot: their efforts by their laws, and how a robot answers to other
/// efforts while they keep their states.
#pragma once

#include <vector>

#include "sinew/control/high_rate_settings.hpp"
#include "sinew/control/snapshot.hpp"
#include "sinew/core/types.hpp"
#include "sinew/linalg/scratch.hpp"
#include "sinew/qp/cone_solver.hpp"
#include "sinew/qp/dense_lu.hpp"

namespace sinew::control {

/// With d the efforts of driven and unknown rows and r those of hands and contacts (the touching
/// rows t), motions are delta = free + W_d d + W_t r. A hand at x has
///   delta = x  where its effort is within its limits,
/// and otherwise its effort at the limit; contacts obey Signorini's and Coulomb's laws. As long as
/// every hand and contact keeps its state, r follows from linear equations S r = b - W_td d:
///   delta_n = 0 of a contact that is not open, delta_t = 0 where it sticks,
///   r_t = -mu r_n u_t/|u_t| where it slides, linearised, r = 0 where it is open,
/// so that r = r_0 + R d, and the other motions are affine in d as well. S is factorised when a
/// state changes. Solutions of S that obey all laws are taken as they are; where points slide in
/// directions that turn, after some steps of Newton's method with the S that there is; and
/// qp::ConeSolver finds the states otherwise. Where contacts repeat each other S gets a billionth
/// of its diagonal.
class TouchLaw {
 public:
  /// Allocates for settings.max_contacts. @param settings outlive it.
  explicit TouchLaw(const HighRateSettings& settings);

  /// States as its efforts have them. @param snapshot outlives the calls below.
  void begin(const Snapshot& snapshot);
  /// Efforts of hands and contacts at these of all others. Allocates nothing.
  /// @param driving (driven + unknown,) N. @param hands (hands,) m, where they are; not finite: a
  /// hand that is not there has no effort.
  void settle(const VectorX& driving, const VectorX& hands);
  /// r_0 at other places of the hands, states as they are. @param hands as in settle().
  void move_hands(const VectorX& hands);

  int rows() const { return rows_; }  ///< touching rows: hands, then three of each contact
  /// (rows(),) N, of the last settle().
  Eigen::Map<const VectorX> effort() const { return {effort_.data(), rows_}; }
  /// (driven + unknown + observed,) m: motions at d = 0, and (rows(),) N: r_0.
  const VectorX& free() const { return free_; }
  Eigen::Map<const VectorX> touch_free() const { return {touch_free_.data(), rows_}; }
  /// How these follow from d, m/N; and R, (rows(), driven + unknown).
  const MatrixX& compliance() const { return compliance_; }
  Eigen::Map<const MatrixX> touch_slope() const { return slope_.view(); }
  /// (hands, hands) N/m: how efforts of held hands follow from where they are; zero of others.
  const MatrixX& hand_stiffness() const { return stiffness_; }
  /// J: what hands would get back if they withdrew: 1/2 r^T K^-1 r of those that touch, and of
  /// those at a limit the effort times the way that they are beyond it, too.
  double stored() const { return stored_; }
  /// How far the last settle() is from the laws, relative to the largest effort.
  double residual() const { return residual_; }
  /// How many calls of settle() changed the state of a hand or a contact.
  long changes() const { return changes_; }
  /// Since construction: steps in which friction was turned against the motion; how often S was
  /// factorised, and how often the cone solver was asked.
  long turns() const { return turns_; }
  long factorisations() const { return factorisations_; }
  long cone_solutions() const { return cone_solutions_; }

 private:
  enum class Touch : char { apart, held, at_min, at_max, open, stick, slip };

  const MatrixX& w() const { return snapshot_->compliance; }
  double friction(int contact) const {
    return snapshot_->friction[static_cast<std::size_t>(contact)];
  }
  int contact_row(int contact) const { return hands_ + 3 * contact; }
  Touch& state(int block) { return states_[static_cast<std::size_t>(block)]; }
  Touch state(int block) const { return states_[static_cast<std::size_t>(block)]; }
  // Of a sliding point: u_t/|u_t|, and how its friction turns with its motion, N/m.
  struct Slip {
    Eigen::Vector2d along = Eigen::Vector2d::Zero();
    Eigen::Matrix2d turning = Eigen::Matrix2d::Zero();
  };
  bool rubs(int contact) const {
    return state(hands_ + contact) == Touch::slip && friction(contact) > 0.0;
  }
  const Slip& slip_of(int row) const {
    return slips_[static_cast<std::size_t>((row - hands_) / 3)];
  }
  int axis_of(int row) const { return (row - hands_) % 3 - 1; }          // of its two tangents
  int tangent_of(int row) const { return first_ + row - axis_of(row); }  // the first of them
  const HandRow& hand(int h) const { return settings_.hands[static_cast<std::size_t>(h)]; }
  bool holds_motion(int row) const;
  bool is_at_limit(int hand) const {
    return state(hand) == Touch::at_min || state(hand) == Touch::at_max;
  }
  bool turns_friction(int row) const;
  double given_effort(int row) const;
  void form();
  void factorise();
  void form_row(int row, Eigen::Map<MatrixX>& system) const;
  void form_slope();
  void form_stiffness(MatrixX& stiffness);
  void measure(const VectorX& driving);
  bool let_go(const VectorX& hands);
  void follow_slip(const VectorX& driving);
  void turn(const VectorX& driving);
  void shift(const VectorX& driving);
  bool has_turned();
  double distance() const;
  double hand_distance(int h) const;
  double contact_distance(int contact) const;
  void ask_cone_solver();
  void read_states();
  void read_contact(int contact);
  void read_slip(int contact, const Eigen::Vector2d& along);
  void note_stored();

  const HighRateSettings& settings_;
  const Snapshot* snapshot_ = nullptr;
  int hands_, driving_, first_;  // number of hands; of driven and unknown rows; first touching row
  int rows_ = 0;
  std::vector<Touch> states_, states_before_;  // (hands + contacts,)
  std::vector<Slip> slips_;                    // (contacts,)
  VectorX places_;                             // (hands,) m
  VectorX effort_, touch_free_, offset_;       // (rows,) r, r_0, motions without r
  VectorX motion_;                             // (rows,) m, with r
  VectorX change_;                             // (rows,) N
  VectorX free_;
  MatrixX compliance_, stiffness_, touched_stiffness_, hand_work_;
  VectorX hand_force_;
  linalg::ScratchMatrix slope_, columns_;
  qp::DenseLu factor_;
  qp::ConeSolver cone_solver_;
  std::vector<qp::BoxBlock> boxes_;
  std::vector<qp::ConeBlock> cones_;
  bool holds_limits_ = false;  // as if hands at their limits were held
  double stored_ = 0.0, residual_ = 0.0;
  long changes_ = 0, turns_ = 0, factorisations_ = 0, cone_solutions_ = 0;
};

}  // namespace sinew::control
