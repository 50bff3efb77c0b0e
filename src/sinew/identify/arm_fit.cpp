#include "sinew/identify/arm_fit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/identify/refuse.hpp"
#include "sinew/identify/statistics.hpp"

namespace sinew::identify {

namespace {

Parameter spread_about(std::string name, double value, double spread, const char* unit,
                       const char* setting) {
  if (!(spread >= 0.0 && spread < 1.0)) {
    refuse(ErrorKind::out_of_range, setting, fmt::format("it is {:g}", spread),
           "give 0 to below 1, so that the parameter stays positive");
  }
  if (!(value > 0.0)) {
    refuse(ErrorKind::out_of_range, name, fmt::format("it starts at {:g} {}", value, unit),
           "start above zero");
  }
  return {std::move(name), value, (1.0 - spread) * value, (1.0 + spread) * value, unit, false, 0.0};
}

/// Maps the parameter vector to models of the arm.
class ArmParameters {
 public:
  ArmParameters(const ArmModel& model, std::span<const MotionRecord> records,
                const ArmFitSettings& settings)
      : model_(model), settings_(settings), list_(own_list(model, settings)) {
    for (const std::string& name : settings.fixed) fix(name);
    own_ = static_cast<Eigen::Index>(list_.size());
    for (const MotionRecord& record : records) add_start(record);
  }

  const std::vector<Parameter>& list() const { return list_; }
  Eigen::Index own() const { return own_; }
  Eigen::Index count() const { return static_cast<Eigen::Index>(list_.size()); }

  ArmModel model(const VectorX& p) const {
    const pcc::Arm& arm = *model_.arm;
    pcc::ArmSettings changed = arm.settings();
    const Eigen::Index n = arm.segments();
    const double stiff = p[n] / arm.stiffness()[0], damp = p[n + 1] / arm.damping()[0];
    for (std::size_t i = 0; i < changed.segments.size(); ++i) {
      pcc::Segment& segment = changed.segments[i];
      segment.mass = p[static_cast<Eigen::Index>(i)];
      segment.stiffness *= stiff;
      segment.damping *= damp;
      segment.axial_stiffness *= stiff;
      segment.axial_damping *= damp;
    }
    ArmModel result{std::make_shared<const pcc::Arm>(std::move(changed)), model_.actuators};
    const auto inputs = static_cast<Eigen::Index>(result.actuators.size());
    for (Eigen::Index i = 0; i < inputs; ++i) {
      auto& actuator = result.actuators[static_cast<std::size_t>(i)];
      actuator.cubic = p[n + 2 + i];
      actuator.delay = p[n + 2 + inputs];
    }
    return result;
  }

  ArmStart start(const VectorX& p, std::size_t record) const {
    const Eigen::Index n = model_.arm->coordinates(), at = start_of(record);
    return {p.segment(at, n), settings_.start == RecordStart::moving ? VectorX(p.segment(at + n, n))
                                                                     : VectorX(VectorX::Zero(n))};
  }

  /// Derivatives with respect to the arm's parameters, followed by those of a record.
  ArmParameterMap map() const {
    const pcc::Arm& arm = *model_.arm;
    ArmParameterMap map(arm, own_ + each());
    const Eigen::Index n = arm.segments(), coordinates = arm.coordinates();
    map.mass.leftCols(n).setIdentity();
    map.stiffness.col(n) = arm.stiffness() / arm.stiffness()[0];
    map.damping.col(n + 1) = arm.damping() / arm.damping()[0];
    const auto inputs = static_cast<Eigen::Index>(model_.actuators.size());
    if (inputs > 0) {
      map.cubic.middleCols(n + 2, inputs).setIdentity();
      map.delay[n + 2 + inputs] = 1.0;
    }
    map.position.middleCols(own_, coordinates).setIdentity();
    if (settings_.start == RecordStart::moving) {
      map.rate.middleCols(own_ + coordinates, coordinates).setIdentity();
    }
    return map;
  }

  /// Number of parameters of a record, and the first of them.
  Eigen::Index each() const {
    return model_.arm->coordinates() * (settings_.start == RecordStart::moving ? 2 : 1);
  }
  Eigen::Index start_of(std::size_t record) const {
    return own_ + static_cast<Eigen::Index>(record) * each();
  }

 private:
  static std::vector<Parameter> own_list(const ArmModel& model, const ArmFitSettings& settings) {
    std::vector<Parameter> list;
    const pcc::Arm& arm = *model.arm;
    for (int i = 0; i < arm.segments(); ++i) {
      list.push_back(spread_about(fmt::format("mass_{}", i),
                                  arm.settings().segments[static_cast<std::size_t>(i)].mass,
                                  settings.mass_spread, "kg", "mass_spread"));
    }
    list.push_back(spread_about("stiffness", arm.stiffness()[0], settings.stiffness_spread, "N m",
                                "stiffness_spread"));
    list.push_back({"damping", arm.damping()[0], settings.damping_lower, settings.damping_upper,
                    "N m s", false, 0.0});
    if (!(arm.damping()[0] > 0.0)) {
      refuse(ErrorKind::out_of_range, "damping",
             fmt::format("it starts at {:g} N m s", arm.damping()[0]), "start above zero");
    }
    for (std::size_t i = 0; i < model.actuators.size(); ++i) {
      list.push_back(spread_about(fmt::format("coefficient_{}", i), model.actuators[i].cubic,
                                  settings.coefficient_spread, "N m/m^9", "coefficient_spread"));
    }
    if (!model.actuators.empty()) {
      list.push_back({"delay", model.actuators[0].delay, 0.0, settings.delay_upper, "s", false,
                      0.1 * settings.delay_upper});
    }
    return list;
  }

  void fix(const std::string& name) {
    const auto found = std::ranges::find(list_, name, &Parameter::name);
    if (found != list_.end()) {
      found->fixed = true;
      return;
    }
    std::vector<std::string> names;
    for (const Parameter& p : list_) names.push_back(p.name);
    const std::string near = nearest_word(name, names);
    refuse(ErrorKind::unknown_name, name, "there is no such parameter to fix",
           near.empty() ? fmt::format("the names are {}", fmt::join(names, ", "))
                        : fmt::format("did you mean '{}'?", near));
  }

  void add_start(const MotionRecord& record) {
    const ArmStart start = first_pose(*model_.arm, record);
    const Eigen::Index n = start.position.size();
    for (Eigen::Index i = 0; i < n; ++i) {
      list_.push_back({.name = fmt::format("{}.angle_{}", record.name, i),
                       .start = start.position[i],
                       .unit = "rad",
                       .scale = 0.1});
    }
    for (Eigen::Index i = 0; i < n && settings_.start == RecordStart::moving; ++i) {
      list_.push_back({.name = fmt::format("{}.rate_{}", record.name, i),
                       .start = 0.0,
                       .unit = "rad/s",
                       .scale = 1.0});
    }
  }

  const ArmModel& model_;
  const ArmFitSettings& settings_;
  std::vector<Parameter> list_;
  Eigen::Index own_ = 0;
};

void check(const ArmModel& model, std::span<const MotionRecord> records) {
  if (records.empty()) {
    refuse(ErrorKind::empty_list, "records", "there is no record", "give one or more");
  }
  for (const MotionRecord& record : records) {
    check(record);
    const int segments = model.arm->segments();
    if (record.position.cols() != 3 * segments) {
      refuse(ErrorKind::wrong_length, record.name,
             fmt::format("it has {} columns of positions, the arm {} segments",
                         record.position.cols(), segments),
             "give x, y and z of each segment's end; nan where not seen");
    }
    // A motion of n angles has a state of 2n numbers.
    const int order = 2 * model.arm->coordinates();
    if (record.samples() <= order) {
      refuse(ErrorKind::too_few_points, record.name,
             fmt::format("it has {} samples, the model is of order {}", record.samples(), order),
             "give a longer record");
    }
  }
}

RecordFit judge(const MotionRecord& record, MatrixX predicted) {
  RecordFit fit;
  fit.name = record.name;
  Eigen::Index count = 0;
  for (Eigen::Index row = 0; row < record.samples(); ++row) {
    for (Eigen::Index k = 0; k < record.position.cols(); k += 3) {
      double squared = 0.0;
      bool seen = false;
      for (Eigen::Index axis = k; axis < k + 3; ++axis) {
        if (std::isnan(record.position(row, axis))) continue;
        squared += std::pow(predicted(row, axis) - record.position(row, axis), 2);
        seen = true;
      }
      fit.summed_error += std::sqrt(squared);
      count += seen ? 1 : 0;
    }
  }
  fit.mean_error = fit.summed_error / static_cast<double>(std::max<Eigen::Index>(count, 1));
  fit.nrmse = nrmse(predicted, record.position);
  fit.predicted = std::move(predicted);
  return fit;
}

}  // namespace

int ArmFit::undetermined() const {
  return static_cast<int>(std::ranges::count_if(fit.directions, [&](const Direction& direction) {
    return direction.undetermined &&
           direction.weights.head(own).cwiseAbs().maxCoeff() > kPartOfDirection;
  }));
}

ArmFit fit_arm(const ArmModel& model, std::span<const MotionRecord> records,
               const ArmFitSettings& settings) {
  check(model, records);
  const ArmParameters parameters(model, records, settings);
  const Eigen::Index wide = 3 * model.arm->segments();
  ForwardModel predicting;
  for (const MotionRecord& record : records) {
    predicting.observations += record.samples() * wide;
  }
  const ArmParameterMap map = parameters.map();
  MatrixX derivatives;
  predicting.predict = [&](const VectorX& p, VectorX& prediction, MatrixX* jacobian) {
    const ArmModel changed = parameters.model(p);
    Eigen::Index row = 0;
    for (std::size_t k = 0; k < records.size(); ++k) {
      const bool wanted = jacobian != nullptr;
      const MatrixX ends =
          predict_motion(changed, records[k], parameters.start(p, k), settings.step,
                         wanted ? &map : nullptr, wanted ? &derivatives : nullptr);
      const Eigen::Index rows = ends.size();
      const MatrixX by_sample = ends.transpose();
      prediction.segment(row, rows) = Eigen::Map<const VectorX>(by_sample.data(), rows);
      if (wanted) {
        const Eigen::Index own = parameters.own(), each = parameters.each();
        auto block = jacobian->middleRows(row, rows);
        block.setZero();
        block.leftCols(own) = derivatives.leftCols(own);
        block.middleCols(parameters.start_of(k), each) = derivatives.rightCols(each);
      }
      row += rows;
    }
  };
  VectorX measured(predicting.observations);
  Eigen::Index row = 0;
  for (const MotionRecord& record : records) {
    const MatrixX by_sample = record.position.transpose();
    measured.segment(row, by_sample.size()) =
        Eigen::Map<const VectorX>(by_sample.data(), by_sample.size());
    row += by_sample.size();
  }
  ArmFit result;
  result.fit = fit_parameters(predicting, measured, parameters.list(), settings.search);
  result.own = parameters.own();
  result.model = parameters.model(result.fit.values);
  VectorX before(parameters.count());
  for (Eigen::Index k = 0; k < before.size(); ++k) {
    before[k] = parameters.list()[static_cast<std::size_t>(k)].start;
  }
  for (std::size_t k = 0; k < records.size(); ++k) {
    const ArmStart start = parameters.start(result.fit.values, k);
    RecordFit& fit = result.records.emplace_back(
        judge(records[k], predict_motion(result.model, records[k], start, settings.step)));
    fit.start = start;
    fit.start_summed_error =
        judge(records[k], predict_motion(parameters.model(before), records[k],
                                         parameters.start(before, k), settings.step))
            .summed_error;
  }
  return result;
}

std::vector<RecordFit> validate_arm(const ArmModel& model, std::span<const MotionRecord> records,
                                    const pcc::ArmStepSettings& step) {
  check(model, records);
  std::vector<RecordFit> result;
  for (const MotionRecord& record : records) {
    const ArmStart start = first_pose(*model.arm, record);
    RecordFit& fit = result.emplace_back(judge(record, predict_motion(model, record, start, step)));
    fit.start = start;
    fit.start_summed_error = fit.summed_error;
  }
  return result;
}

}  // namespace sinew::identify
