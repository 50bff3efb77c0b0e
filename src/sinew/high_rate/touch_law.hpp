/// @file
/// Efforts of the hands and contacts of a snapshot by their laws, and the response of the robot to
/// other efforts while they keep their states.
#pragma once

#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/high_rate/high_rate_settings.hpp"
#include "sinew/high_rate/snapshot.hpp"
#include "sinew/linalg/scratch.hpp"
#include "sinew/qp/cone_solver.hpp"
#include "sinew/qp/dense_lu.hpp"

namespace sinew::high_rate {

/// The laws of hands and contacts. With d the efforts of driven and unknown rows and r those of
/// hands and contacts (the touching rows t), motions are delta = free + W_d d + W_t r. A hand at x
/// has
///   delta = x  if its effort is within its limits,
/// and otherwise the effort of the limit. Contacts obey Signorini's and Coulomb's laws. As long as
/// every hand and contact keeps its state, r follows from linear equations S r = b - W_td d:
///   delta_n = 0 of a contact that is not open, delta_t = 0 where it sticks,
///   r_t = -mu r_n u_t/|u_t| where it slides, linearised, r = 0 where it is open,
/// so that r = r_0 + R d, and the other motions are affine in d, too. S is factorised when a state
/// changes. A solution of S that obeys all laws is accepted. If sliding points change direction,
/// some Newton steps with the same S follow. Otherwise qp::ConeSolver finds the states. A billionth
/// of the compliance is added to the diagonal of S, so that redundant contacts have a solution.
class TouchLaw {
 public:
  /// Allocates for settings.max_contacts. @param settings must outlive this object.
  explicit TouchLaw(const HighRateSettings& settings);

  /// Starts with a snapshot, with the states of its efforts. @param snapshot must outlive the calls
  /// below.
  void begin(const Snapshot& snapshot);
  /// Computes the efforts of hands and contacts for given efforts of all other rows. Allocates
  /// nothing.
  /// @param driving (driven + unknown,) N.
  /// @param hands (hands,) m, their positions; not finite: no hand, which has no effort.
  void settle(const VectorX& driving, const VectorX& hands);
  /// Updates r_0 for other positions of the hands, with the present states. @param hands as in
  /// settle().
  void move_hands(const VectorX& hands);

  int rows() const { return rows_; }  ///< number of touching rows: hands, then three per contact
  /// Efforts of the last settle(), (rows(),) N.
  Eigen::Map<const VectorX> effort() const { return {effort_.data(), rows_}; }
  /// Motions at d = 0, (driven + unknown + observed,) m, and r_0, (rows(),) N.
  const VectorX& free() const { return free_; }
  Eigen::Map<const VectorX> touch_free() const { return {touch_free_.data(), rows_}; }
  /// Derivatives of the motions with respect to d, m/N; and R, (rows(), driven + unknown).
  const MatrixX& compliance() const { return compliance_; }
  Eigen::Map<const MatrixX> touch_slope() const { return slope_.view(); }
  /// Stiffness of the hands, (hands, hands) N/m: derivatives of the efforts of held hands with
  /// respect to their positions; zero for other hands.
  const MatrixX& hand_stiffness() const { return stiffness_; }
  /// Energy that hands would get back if they withdrew, J: 1/2 r^T K^-1 r for those that touch,
  /// plus, for hands at a limit, the effort times the distance beyond it.
  double stored() const { return stored_; }
  /// Distance of the last settle() from the laws, relative to the largest effort.
  double residual() const { return residual_; }
  /// Number of calls of settle() that changed the state of a hand or contact.
  long changes() const { return changes_; }
  /// Counters since construction: Newton steps that turned friction against the motion,
  /// factorisations of S, and calls of the cone solver.
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
  // Of a sliding point: u_t/|u_t|, and the derivative of its friction with respect to u_t, N/m.
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
  int axis_of(int row) const { return (row - hands_) % 3 - 1; }  // which of its two tangents
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
  bool holds_limits_ = false;  // treats hands at their limits as held
  double stored_ = 0.0, residual_ = 0.0;
  long changes_ = 0, turns_ = 0, factorisations_ = 0, cone_solutions_ = 0;
};

}  // namespace sinew::high_rate
