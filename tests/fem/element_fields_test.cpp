// Element and node fields against independently computed tensors, for every kind of element and
// law.
#include "sinew/fem/element_fields.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <random>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/fem/element_states.hpp"
#include "sinew/fem/fem_body_model.hpp"
#include "sinew/fem/fem_body_settings.hpp"
#include "sinew/fem/has_material.hpp"
#include "sinew/fem/solid_elements.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/mesh/quadratic.hpp"
#include "sinew/mesh/shapes.hpp"

#include "block_mesh.hpp"

namespace sinew::fem {
namespace {

constexpr double kShear = 4e4, kBulk = 3e5;  // Pa
const double kYoung = 9.0 * kBulk * kShear / (3.0 * kBulk + kShear);
const double kPoisson = kYoung / (2.0 * kShear) - 1.0;

enum class FieldKind { linear, corotational, rubber, quadratic, hexahedra };

std::shared_ptr<const mesh::Mesh> mesh_of(FieldKind kind) {
  if (kind == FieldKind::hexahedra) {
    return std::make_shared<mesh::Mesh>(
        mesh::block({.size = {0.03, 0.02, 0.02}, .cells = {3, 2, 2}}, mesh::Cells::hexahedra));
  }
  auto tetrahedra = block_mesh(3, 2, 2, 0.01, 0.12);
  if (kind != FieldKind::quadratic) return tetrahedra;
  return std::make_shared<mesh::Mesh>(mesh::with_middle_nodes(*tetrahedra));
}

/// A body whose node positions are prescribed.
struct Shown {
  explicit Shown(FieldKind kind, std::shared_ptr<const mesh::Mesh> mesh = nullptr) {
    FemBodySettings settings;
    settings.mesh = mesh ? std::move(mesh) : mesh_of(kind);
    MaterialRegion region{.constants = {kYoung, kPoisson}, .density = 1000.0, .hyperelastic = {}};
    region.law = kind == FieldKind::linear ? material::Law::linear : material::Law::corotational;
    if (kind != FieldKind::linear && kind != FieldKind::corotational) {
      region.hyperelastic = material::neo_hookean(kShear);
      region.hyperelastic->bulk_modulus = kBulk;
    }
    settings.elements.regions = {region};
    settings.elements.fixed_nodes = {0};
    model = std::make_unique<FemBodyModel>(settings);
    model->finish(0, {}, {});
    owned = model->create(pool, false, 0);
  }
  const HasMaterial& material() { return *mechanics::as<const HasMaterial>(*owned); }
  /// Sets x = move(X) at every node.
  template <typename Move>
  void deform(Move&& move) {
    std::vector<double> state(owned->state_size());
    owned->save_state(state);
    const Points& rest = model->mesh().nodes;
    for (Eigen::Index i = 0; i < rest.rows(); ++i) {
      const Vector3 x = move(Vector3(rest.row(i).transpose()));
      for (Eigen::Index c = 0; c < 3; ++c) state[static_cast<std::size_t>(3 * i + c)] = x[c];
    }
    owned->load_state(state);
  }

  ThreadPool pool;
  std::unique_ptr<FemBodyModel> model;
  std::unique_ptr<mechanics::Body> owned;
};

Matrix3 strong_deformation() {
  Matrix3 f =
      Eigen::AngleAxis<double>(1.1, Vector3(0.3, -0.5, 0.8).normalized()).toRotationMatrix();
  Matrix3 u;
  u << 1.25, 0.12, -0.05, 0.12, 0.9, 0.07, -0.05, 0.07, 0.97;
  return f * u;
}

/// Every field at F from its definition, with Eigen's decompositions.
double expected(ElementField field, const Matrix3& f, FieldKind kind) {
  const Eigen::JacobiSVD<Matrix3> svd(f, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vector3& l = svd.singularValues();
  const Matrix3 rotation = svd.matrixU() * svd.matrixV().transpose();
  const double j = f.determinant(), lambda = kBulk - 2.0 / 3.0 * kShear;
  Matrix3 cauchy;
  double energy = 0.0;
  if (kind == FieldKind::linear) {
    const Matrix3 e = 0.5 * (f + f.transpose()) - Matrix3::Identity();
    cauchy = 2.0 * kShear * e + lambda * e.trace() * Matrix3::Identity();
    energy = 0.5 * cauchy.cwiseProduct(e).sum();
  } else if (kind == FieldKind::corotational) {
    const double growth = l.sum() - 3.0;
    const Matrix3 piola = 2.0 * kShear * (f - rotation) + lambda * growth * rotation;
    cauchy = piola * f.transpose() / j;
    energy = kShear * (f - rotation).squaredNorm() + 0.5 * lambda * growth * growth;
  } else {
    const Matrix3 b = f * f.transpose() / std::pow(j, 2.0 / 3.0);
    cauchy = kShear / j * (b - b.trace() / 3.0 * Matrix3::Identity()) +
             kBulk * (j - 1.0) * Matrix3::Identity();
    energy = 0.5 * kShear * (b.trace() - 3.0) + 0.5 * kBulk * (j - 1.0) * (j - 1.0);
  }
  const Matrix3 deviator = cauchy - cauchy.trace() / 3.0 * Matrix3::Identity();
  const Vector3 logarithms = l.array().log();
  const Matrix3 green = 0.5 * (f.transpose() * f - Matrix3::Identity());
  const auto largest = [](const Matrix3& m) {
    return Eigen::SelfAdjointEigenSolver<Matrix3>(m).eigenvalues().maxCoeff();
  };
  switch (field) {
    case ElementField::von_mises_stress:
      return std::sqrt(1.5) * deviator.norm();
    case ElementField::max_principal_stress:
      return largest(0.5 * (cauchy + cauchy.transpose()));
    case ElementField::pressure:
      return -cauchy.trace() / 3.0;
    case ElementField::max_stretch:
      return l.maxCoeff();
    case ElementField::min_stretch:
      return l.minCoeff();
    case ElementField::green_strain:
      return largest(green);
    case ElementField::log_strain:
      return logarithms.maxCoeff();
    case ElementField::equivalent_strain:
      return std::sqrt(2.0 / 3.0 * (logarithms.array() - logarithms.mean()).square().sum());
    case ElementField::volume_ratio:
      return j;
    case ElementField::energy_density:
      return energy;
  }
  return 0.0;
}

class EveryElement : public testing::TestWithParam<FieldKind> {};
INSTANTIATE_TEST_SUITE_P(Kinds, EveryElement,
                         testing::Values(FieldKind::linear, FieldKind::corotational,
                                         FieldKind::rubber, FieldKind::quadratic,
                                         FieldKind::hexahedra));

TEST_P(EveryElement, FieldsAreWhatTheirDefinitionsSay) {
  Shown shown(GetParam());
  Matrix3 f = strong_deformation();
  if (GetParam() == FieldKind::linear) f = Matrix3::Identity() + 0.02 * (f - Matrix3::Identity());
  shown.deform([&](const Vector3& x) -> Vector3 { return f * x + Vector3(0.1, -0.2, 0.3); });
  const NodalMean mean(shown.model->elements());
  for (const ElementFieldInfo& info : element_fields()) {
    const double right = expected(info.field, f, GetParam());
    ASSERT_GT(std::abs(right), 1e-4) << info.name << " would not be seen to be wrong";
    const auto elements = element_field(shown.material(), info.field);
    for (const auto& values : {elements, mean(elements)}) {
      for (const double value : values) {
        ASSERT_NEAR(value, right, 1e-8 * std::max(1.0, std::abs(right))) << info.name;
      }
    }
  }
}

TEST_P(EveryElement, AllFieldsAtOnceAreEachOfThem) {
  Shown shown(GetParam());
  shown.deform([](const Vector3& x) -> Vector3 {
    return {x.x() + 4.0 * x.x() * x.y(), x.y() - 6.0 * x.x() * x.x(), x.z() * (1.0 + 5.0 * x.y())};
  });
  const std::vector<double> all = all_element_fields(shown.material());
  const auto infos = element_fields();
  for (std::size_t k = 0; k < infos.size(); ++k) {
    const auto one = element_field(shown.material(), infos[k].field);
    ASSERT_EQ(all.size(), one.size() * infos.size());
    for (std::size_t e = 0; e < one.size(); ++e) {
      ASSERT_EQ(all[infos.size() * e + k], one[e]) << infos[k].name;
    }
  }
}

TEST_P(EveryElement, EnergyDensityAddsUpToTheEnergy) {
  Shown shown(GetParam());
  shown.deform([](const Vector3& x) -> Vector3 {
    return {x.x() + 4.0 * x.x() * x.y(), x.y() - 6.0 * x.x() * x.x(), x.z() * (1.0 + 5.0 * x.y())};
  });
  const auto density = element_field(shown.material(), ElementField::energy_density);
  const ElementStates states = element_states(shown.material());
  const double sum = std::inner_product(density.begin(), density.end(), states.volume.begin(), 0.0);
  EXPECT_NEAR(sum, shown.owned->energies().strain, 1e-10 * sum);
  EXPECT_GT(sum, 1e-6);
}

TEST_P(EveryElement, NodalMeansWeighByVolume) {
  Shown shown(GetParam());
  const mesh::Mesh& mesh = shown.model->mesh();
  const ElementList list(mesh);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  std::vector<double> values(2 * static_cast<std::size_t>(list.count()));
  for (double& value : values) value = any(random);
  const auto volume = element_states(shown.material()).volume;
  const auto means = NodalMean(shown.model->elements())(values, 2);
  for (NodeId node = 0; node < mesh.node_count(); ++node) {
    double sum = 0.0, around = 0.0;
    for (int e = 0; e < list.count(); ++e) {
      if (std::ranges::find(list.nodes(e), node) == list.nodes(e).end()) continue;
      const auto element = static_cast<std::size_t>(e);
      around += volume[element];
      sum += volume[element] * values[2 * element + 1];
    }
    ASSERT_NEAR(means[2 * static_cast<std::size_t>(node) + 1], sum / around, 1e-12);
  }
}

TEST(ElementFields, ANodeWithoutElementsHasNone) {
  auto mesh = block_mesh(1, 1, 1, 0.01);
  mesh->nodes.conservativeResize(mesh->nodes.rows() + 1, 3);
  mesh->nodes.bottomRows(1).setConstant(1.0);
  Shown shown(FieldKind::corotational, mesh);
  const auto means = NodalMean(shown.model->elements())(
      element_field(shown.material(), ElementField::volume_ratio));
  EXPECT_TRUE(std::isnan(means.back()));
  EXPECT_NEAR(means.front(), 1.0, 1e-12);
}

TEST(ElementFields, AreFoundByName) {
  for (const ElementFieldInfo& info : element_fields()) {
    EXPECT_EQ(element_field_of(info.name), info.field);
  }
  try {
    element_field_of("von_mises");
    FAIL() << "there is no such field";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::unknown_name);
    EXPECT_NE(std::string(error.what()).find("von_mises_stress"), std::string::npos);
  }
}

}  // namespace
}  // namespace sinew::fem
