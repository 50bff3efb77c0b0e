#include "sinew/identify/cylinder_fit.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>
#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/identify/refuse.hpp"
#include "sinew/identify/statistics.hpp"
#include "sinew/linalg/dense.hpp"

namespace sinew::identify {

namespace {

using Eigen::Index;
using pcc::DriveCylinder;

constexpr Index kOrder = 2;

void check(std::span<const DriveRecord> records, int least) {
  if (records.empty()) {
    refuse(ErrorKind::empty_list, "records", "there is no record", "give one or more");
  }
  for (const DriveRecord& record : records) {
    if (record.input.size() != record.output.size()) {
      refuse(ErrorKind::wrong_length, record.name,
             fmt::format("{} inputs, {} outputs", record.input.size(), record.output.size()),
             "give one of each");
    }
    if (record.input.size() < least) {
      refuse(ErrorKind::too_few_points, record.name,
             fmt::format("it has {} samples, a model of two states needs {}", record.input.size(),
                         least),
             "give a longer record");
    }
    if (!record.input.allFinite() || !record.output.allFinite()) {
      refuse(ErrorKind::not_finite, record.name, "a sample is not finite", "give numbers");
    }
    const double first = records[0].sample_time;
    if (!(record.sample_time > 0.0) || std::abs(record.sample_time - first) > 1e-6 * first) {
      refuse(ErrorKind::out_of_range, record.name,
             fmt::format("it is sampled by {:g} s, the first by {:g} s", record.sample_time, first),
             "resample the records to one step above zero");
    }
  }
}

/// Writes one record's columns of a Hankel matrix. @param from sample of the first row.
void put_hankel(const VectorX& signal, Index from, Index rows, Index columns, Index at,
                Index column, MatrixX& result) {
  for (Index j = 0; j < columns; ++j) {
    result.block(at, column + j, rows, 1) = signal.segment(from + j, rows);
  }
}

/// Throws if the inputs cannot distinguish the 2n + 1 coefficients of a model of order n.
void check_excitation(std::span<const DriveRecord> records) {
  constexpr Index kRows = 2 * kOrder + 1;
  Eigen::Matrix<double, kRows, kRows> products = Eigen::Matrix<double, kRows, kRows>::Zero();
  for (const DriveRecord& record : records) {
    for (Index j = 0; j + kRows <= record.input.size(); ++j) {
      const auto part = record.input.segment<kRows>(j);
      products.noalias() += part * part.transpose();
    }
  }
  const VectorX values = linalg::symmetric_eigenvalues(products);
  if (values[0] > 1e-13 * values[kRows - 1]) return;
  refuse(ErrorKind::out_of_range, records[0].name, "the input does not excite the cylinder",
         "give a signal of three frequencies or more, fast enough for the sample time");
}

/// A and C by the past-output MOESP, see the header.
DriveCylinder observe(std::span<const DriveRecord> records, Index rows) {
  Index columns = 0;
  for (const DriveRecord& record : records) columns += record.input.size() - 2 * rows + 1;
  MatrixX data(4 * rows, columns);
  Index column = 0;
  for (const DriveRecord& record : records) {
    const Index own = record.input.size() - 2 * rows + 1;
    put_hankel(record.input, rows, rows, own, 0, column, data);          // future inputs
    put_hankel(record.input, 0, rows, own, rows, column, data);          // past inputs
    put_hankel(record.output, 0, rows, own, 2 * rows, column, data);     // past outputs
    put_hankel(record.output, rows, rows, own, 3 * rows, column, data);  // future outputs
    column += own;
  }
  const MatrixX lower = linalg::upper_factor(data.transpose()).transpose();
  const linalg::Svd svd =
      linalg::svd(lower.block(3 * rows, rows, rows, 2 * rows), linalg::SingularVectors::thin_u);
  const MatrixX observability =
      svd.u.leftCols(kOrder) * svd.values.head(kOrder).cwiseSqrt().asDiagonal();
  DriveCylinder result;
  result.c = observability.row(0);
  result.a =
      linalg::least_squares(observability.topRows(rows - 1), observability.bottomRows(rows - 1)).x;
  // Noise may put a slow pole outside the unit circle; it is then moved as far inside.
  const double radius = result.spectral_radius();
  if (radius >= 1.0) result.a /= radius * radius * (1.0 + 1e-6);
  result.sample_time = records[0].sample_time;
  return result;
}

/// B, D and the starts of the records, in which the output is linear. @param starts (2, records).
void solve_inputs(std::span<const DriveRecord> records, bool feedthrough, DriveCylinder& cylinder,
                  MatrixX& starts) {
  const Index fixed = kOrder + (feedthrough ? 1 : 0);
  const Index unknowns = fixed + kOrder * static_cast<Index>(records.size());
  Index rows = 0;
  for (const DriveRecord& record : records) rows += record.input.size();
  MatrixX matrix = MatrixX::Zero(rows, unknowns);
  VectorX right(rows);
  Index row = 0, own = fixed;
  for (const DriveRecord& record : records) {
    Eigen::Matrix2d forced = Eigen::Matrix2d::Zero();  // state per unit of B
    Eigen::Matrix2d free = Eigen::Matrix2d::Identity();
    for (Index k = 0; k < record.input.size(); ++k, ++row) {
      matrix.block<1, 2>(row, 0) = cylinder.c * forced;
      if (feedthrough) matrix(row, kOrder) = record.input[k];
      matrix.block<1, 2>(row, own) = cylinder.c * free;
      right[row] = record.output[k];
      forced = cylinder.a * forced + record.input[k] * Eigen::Matrix2d::Identity();
      free = cylinder.a * free;
    }
    own += kOrder;
  }
  const VectorX found = linalg::least_squares(matrix, right).x;
  cylinder.b = found.head<2>();
  cylinder.d = feedthrough ? found[kOrder] : 0.0;
  starts =
      Eigen::Map<const MatrixX>(found.data() + fixed, kOrder, static_cast<Index>(records.size()));
}

DriveCylinder observer_form(const VectorX& p, double sample_time) {
  DriveCylinder result;
  result.a << -p[0], 1.0, -p[1], 0.0;
  result.b << p[2], p[3];
  result.c << 1.0, 0.0;
  result.d = p[4];
  result.sample_time = sample_time;
  return result;
}

/// The output and its derivatives with respect to a1, a2, b1, b2, d and the start.
void simulate(const DriveCylinder& cylinder, const DriveRecord& record,
              const Eigen::Vector2d& start, Index row, Index own, VectorX& prediction,
              MatrixX* jacobian) {
  Eigen::Vector2d x = start;
  Eigen::Matrix<double, 2, 7> s = Eigen::Matrix<double, 2, 7>::Zero();
  s.rightCols<2>().setIdentity();
  for (Index k = 0; k < record.input.size(); ++k, ++row) {
    const double u = record.input[k];
    prediction[row] = x[0] + cylinder.d * u;
    if (jacobian != nullptr) {
      jacobian->row(row).setZero();
      jacobian->block<1, 4>(row, 0) = s.block<1, 4>(0, 0);
      (*jacobian)(row, 4) = u;
      jacobian->block<1, 2>(row, own) = s.block<1, 2>(0, 5);
      s = cylinder.a * s;
      s(0, 0) -= x[0];
      s(1, 1) -= x[0];
      s(0, 2) += u;
      s(1, 3) += u;
    }
    x = cylinder.a * x + cylinder.b * u;
  }
}

}  // namespace

CylinderFit fit_cylinder(std::span<const DriveRecord> records,
                         const CylinderFitSettings& settings) {
  const Index rows = settings.block_rows;
  if (rows <= kOrder || rows > 200) {
    refuse(ErrorKind::out_of_range, "block_rows", fmt::format("there are {} block rows", rows),
           "give 3 to 200: more than the two states");
  }
  // The data matrix of each record needs as many columns as rows.
  check(records, static_cast<int>(6 * rows));
  check_excitation(records);
  CylinderFit result;
  result.start = observe(records, rows);
  MatrixX starts;
  solve_inputs(records, settings.feedthrough, result.start, starts);

  // Observer form, whose transfer function is d + (b1 z + b2)/(z^2 + a1 z + a2).
  const DriveCylinder& found = result.start;
  const double a1 = -found.a.trace(), a2 = found.a.determinant();
  const Eigen::Matrix2d shifted = found.a + a1 * Eigen::Matrix2d::Identity();
  const double b1 = found.c.dot(found.b), b2 = found.c.dot(shifted * found.b);
  const double size = std::max({std::abs(b1), std::abs(b2), std::abs(found.d)});
  double reach = 0.0;
  for (const DriveRecord& record : records) {
    reach = std::max(reach, record.output.cwiseAbs().maxCoeff());
  }
  const auto parameter = [](std::string name, double start, double scale, bool fixed = false) {
    return Parameter{
        .name = std::move(name), .start = start, .unit = "", .fixed = fixed, .scale = scale};
  };
  std::vector<Parameter> parameters = {parameter("a1", a1, 1.0), parameter("a2", a2, 1.0),
                                       parameter("b1", b1, size), parameter("b2", b2, size),
                                       parameter("d", found.d, size, !settings.feedthrough)};
  ForwardModel model;
  for (std::size_t k = 0; k < records.size(); ++k) {
    const Eigen::Vector2d x = starts.col(static_cast<Index>(k));
    parameters.push_back(parameter(records[k].name + ".start_0", found.c.dot(x), reach));
    parameters.push_back(parameter(records[k].name + ".start_1", found.c.dot(shifted * x), reach));
    model.observations += records[k].output.size();
  }
  VectorX measured(model.observations);
  Index row = 0;
  for (const DriveRecord& record : records) {
    measured.segment(row, record.output.size()) = record.output;
    row += record.output.size();
  }
  model.predict = [&](const VectorX& p, VectorX& prediction, MatrixX* jacobian) {
    const DriveCylinder cylinder = observer_form(p, records[0].sample_time);
    Index at = 0, own = 5;
    for (const DriveRecord& record : records) {
      simulate(cylinder, record, p.segment<2>(own), at, own, prediction, jacobian);
      at += record.output.size();
      own += 2;
    }
  };
  result.fit = fit_parameters(model, measured, parameters, settings.search);
  result.cylinder = observer_form(result.fit.values, records[0].sample_time);
  Index at = 0, own = 5;
  for (const DriveRecord& record : records) {
    CylinderTrial& trial = result.trials.emplace_back();
    trial.name = record.name;
    trial.predicted = result.fit.prediction.segment(at, record.output.size());
    trial.start = result.fit.values.segment<2>(own);
    trial.nrmse = nrmse(trial.predicted, record.output);
    at += record.output.size();
    own += 2;
  }
  return result;
}

std::vector<CylinderTrial> validate_cylinder(const pcc::DriveCylinder& cylinder,
                                             std::span<const DriveRecord> records, int block) {
  if (block < kOrder) {
    refuse(ErrorKind::out_of_range, "block", fmt::format("it is {} samples", block),
           "give two or more, from which the start follows");
  }
  check(records, block);
  std::vector<CylinderTrial> result;
  for (const DriveRecord& record : records) {
    CylinderTrial& trial = result.emplace_back();
    trial.name = record.name;
    const VectorX forced = cylinder.simulate(record.input);
    MatrixX matrix(block, kOrder);
    Eigen::Matrix2d free = Eigen::Matrix2d::Identity();
    for (Index k = 0; k < block; ++k) {
      matrix.row(k) = cylinder.c * free;
      free = cylinder.a * free;
    }
    trial.start = linalg::least_squares(matrix, (record.output - forced).head(block)).x;
    trial.predicted = cylinder.simulate(record.input, trial.start);
    trial.nrmse = nrmse(trial.predicted, record.output);
  }
  return result;
}

}  // namespace sinew::identify
