#include "sinew/fem/element_fields.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/fem/element_batches.hpp"
#include "sinew/fem/element_points.hpp"
#include "sinew/fem/fem_model.hpp"
#include "sinew/fem/has_elements.hpp"
#include "sinew/fem/has_material.hpp"
#include "sinew/fem/solid_elements.hpp"
#include "sinew/material/principal.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/mesh/mesh.hpp"

namespace sinew::fem {

namespace {

using material::kLanes;
using material::Lanes;
using material::lanes;
using material::Lanes3x3;
using material::maximum;

constexpr std::array<ElementFieldInfo, 10> kFields = {{
    {ElementField::von_mises_stress, "von_mises_stress", "Von Mises stress", "Pa",
     "sqrt(3/2 d : d) of the deviator d of the Cauchy stress"},
    {ElementField::max_principal_stress, "max_principal_stress", "Largest principal stress", "Pa",
     "largest eigenvalue of the Cauchy stress; negative where all press"},
    {ElementField::pressure, "pressure", "Pressure in the material", "Pa",
     "-tr(sigma)/3 of the Cauchy stress; negative where it is pulled"},
    {ElementField::max_stretch, "max_stretch", "Largest stretch", "",
     "largest principal stretch: length by length at rest; 1 at rest"},
    {ElementField::min_stretch, "min_stretch", "Smallest stretch", "",
     "smallest principal stretch; 1 at rest"},
    {ElementField::green_strain, "green_strain", "Green strain", "",
     "largest principal value of (F^T F - I)/2"},
    {ElementField::log_strain, "log_strain", "Logarithmic strain", "",
     "largest principal value of ln U, the logarithm of the largest stretch"},
    {ElementField::equivalent_strain, "equivalent_strain", "Equivalent strain", "",
     "sqrt(2/3 d : d) of the deviator d of the logarithmic strain ln U"},
    {ElementField::volume_ratio, "volume_ratio", "Volume ratio", "",
     "J = det F: volume by volume at rest"},
    {ElementField::energy_density, "energy_density", "Energy density", "J/m^3",
     "strain energy by volume at rest"},
}};

/// |d|^2 of the deviator of a diagonal with entries a.
Lanes deviator_square(const Lanes (&a)[3]) {
  const Lanes x = a[0] - a[1], y = a[1] - a[2], z = a[2] - a[0];
  return (x * x + y * y + z * z) / 3.0;
}

Lanes von_mises(const Lanes3x3& s) {
  const Lanes diagonal[3] = {s[0][0], s[1][1], s[2][2]};
  Lanes square = deviator_square(diagonal);
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < r; ++c) {
      const Lanes shear = 0.5 * (s[r][c] + s[c][r]);
      square += 2.0 * shear * shear;
    }
  }
  return material::square_root(1.5 * square);
}

Lanes max_eigenvalue(const Lanes3x3& s) {
  Lanes c[3][3];
  for (int r = 0; r < 3; ++r) {
    for (int k = 0; k < 3; ++k) c[r][k] = 0.5 * (s[r][k] + s[k][r]);
  }
  Lanes3x3 axes;
  material::detail::diagonalise(c, axes);
  return maximum(maximum(c[0][0], c[1][1]), c[2][2]);
}

Lanes equivalent_strain(const material::Principal& at) {
  Lanes logarithms[3];
  for (int i = 0; i < 3; ++i) logarithms[i] = material::detail::logarithm(at.stretch[i]);
  return material::square_root(2.0 / 3.0 * deviator_square(logarithms));
}

// Fields at a batch of points; principal stretches are computed only once.
class PointValues {
 public:
  explicit PointValues(const PointBatch& point) : point_(point) {}
  Lanes operator()(ElementField field);

 private:
  const material::Principal& principal() {
    if (!principal_) principal_ = material::principal(point_.deformation);
    return *principal_;
  }
  Lanes largest() {
    const auto& l = principal().stretch;
    return maximum(maximum(l[0], l[1]), l[2]);
  }

  const PointBatch& point_;
  std::optional<material::Principal> principal_;
};

Lanes PointValues::operator()(ElementField field) {
  const auto& s = point_.cauchy;
  switch (field) {
    case ElementField::von_mises_stress:
      return von_mises(s);
    case ElementField::max_principal_stress:
      return max_eigenvalue(s);
    case ElementField::pressure:
      return -(s[0][0] + s[1][1] + s[2][2]) / 3.0;
    case ElementField::max_stretch:
      return largest();
    case ElementField::min_stretch: {
      const auto& l = principal().stretch;
      return -maximum(maximum(-l[0], -l[1]), -l[2]);
    }
    case ElementField::green_strain: {
      const Lanes l = largest();
      return 0.5 * (l * l - 1.0);
    }
    case ElementField::log_strain:
      return material::detail::logarithm(largest());
    case ElementField::equivalent_strain:
      return equivalent_strain(principal());
    case ElementField::volume_ratio:
      return material::determinant(point_.deformation, material::cofactor(point_.deformation));
    case ElementField::energy_density:
      return point_.energy;
  }
  return lanes(0.0);
}

// Means of fields over the points of every element, one row per element.
std::vector<double> means(const HasMaterial& body, std::span<const ElementField> fields) {
  const auto count =
      static_cast<std::size_t>(ElementList(body.material().elements().mesh()).count());
  const std::size_t width = fields.size();
  std::vector<double> sum(count * width, 0.0), volume(count, 0.0);
  visit_points(body, [&](const PointBatch& point) {
    PointValues value_of(point);
    for (std::size_t k = 0; k < width; ++k) {
      const Lanes value = value_of(fields[k]);
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        if (point.element[lane] < 0) continue;
        const auto e = static_cast<std::size_t>(point.element[lane]);
        sum[width * e + k] += point.weight[lane] * value[lane];
        if (k == 0) volume[e] += point.weight[lane];
      }
    }
  });
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] /= volume[i / width];
  return sum;
}

// Means of all fields over the points of some elements, and the volumes of these elements.
template <typename IsMeant>
ElementValues mean_over(const HasMaterial& body, const IsMeant& is_meant) {
  ElementValues result{.fields = std::vector<double>(kFields.size(), 0.0)};
  visit_points(body, [&](const PointBatch& point) {
    Lanes weight = lanes(0.0);
    double share = 0.0;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      if (point.element[lane] < 0 || !is_meant(point, lane)) continue;
      weight[lane] = point.weight[lane];
      share += weight[lane];
    }
    if (share == 0.0) return;
    result.volume += share;
    PointValues value_of(point);
    for (std::size_t f = 0; f < kFields.size(); ++f) {
      const Lanes value = value_of(kFields[f].field);
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        if (weight[lane] > 0.0) result.fields[f] += weight[lane] * value[lane];
      }
    }
  });
  for (double& sum : result.fields) sum /= result.volume;
  return result;
}

}  // namespace

std::span<const ElementFieldInfo> element_fields() { return kFields; }

ElementField element_field_of(std::string_view name) {
  std::vector<std::string> names;
  for (const ElementFieldInfo& info : kFields) {
    if (name == info.name) return info.field;
    names.emplace_back(info.name);
  }
  const std::string near = nearest_word(name, names);
  throw Error(ErrorKind::unknown_name, {.item = "field"},
              fmt::format("elements have no field '{}'", name),
              near.empty() ? fmt::format("use one of {}", fmt::join(names, ", "))
                           : fmt::format("did you mean '{}'?", near));
}

std::vector<double> element_field(const HasMaterial& body, ElementField field) {
  return means(body, {&field, 1});
}

std::vector<double> all_element_fields(const HasMaterial& body) {
  std::array<ElementField, kFields.size()> all{};
  std::ranges::transform(kFields, all.begin(), &ElementFieldInfo::field);
  return means(body, all);
}

std::vector<double> node_fields(const HasMaterial& body, NodeId node) {
  return mean_over(body,
                   [node](const PointBatch& point, std::size_t lane) {
                     for (std::size_t a = 0; a < point.nodes; ++a) {
                       if (point.node[a * kLanes + lane] == node) return true;
                     }
                     return false;
                   })
      .fields;
}

ElementValues element_values(const HasMaterial& body, int element) {
  return mean_over(body, [element](const PointBatch& point, std::size_t lane) {
    return point.element[lane] == element;
  });
}

NodalMean::NodalMean(const FemModel& elements)
    : elements_(elements), around_(static_cast<std::size_t>(elements.mesh().nodes.rows()), 0.0) {
  const ElementList list(elements.mesh());
  volume_.assign(static_cast<std::size_t>(list.count()), 0.0);
  const ElementBatches& tetrahedra = elements.elements();
  for (std::size_t slot = 0; slot < tetrahedra.tetrahedron.size(); ++slot) {
    if (tetrahedra.tetrahedron[slot] < 0) continue;
    volume_[static_cast<std::size_t>(tetrahedra.tetrahedron[slot])] =
        tetrahedra.constants[slot / kLanes].volume.value[slot % kLanes];
  }
  for (const SolidGroup& group : elements.solids()) {
    for (std::size_t slot = 0; slot < group.element.size(); ++slot) {
      if (group.element[slot] < 0) continue;
      for (int q = 0; q < group.points; ++q) {
        volume_[static_cast<std::size_t>(group.element[slot])] += group.weight(slot, q);
      }
    }
  }
  for (int e = 0; e < list.count(); ++e) {
    for (const NodeId node : list.nodes(e)) {
      around_[static_cast<std::size_t>(node)] += volume_[static_cast<std::size_t>(e)];
    }
  }
}

std::unique_ptr<NodalMean> nodal_mean(const mechanics::BodyModel& model) {
  const auto* fem = mechanics::as<const HasElements>(model);
  return fem == nullptr ? nullptr : std::make_unique<NodalMean>(fem->elements());
}

std::vector<double> NodalMean::operator()(std::span<const double> values, std::size_t width) const {
  const ElementList list(elements_.mesh());
  std::vector<double> means(width * around_.size(), 0.0);
  for (int e = 0; e < list.count(); ++e) {
    const auto element = static_cast<std::size_t>(e);
    for (const NodeId node : list.nodes(e)) {
      for (std::size_t k = 0; k < width; ++k) {
        means[width * static_cast<std::size_t>(node) + k] +=
            volume_[element] * values[width * element + k];
      }
    }
  }
  for (std::size_t node = 0; node < around_.size(); ++node) {
    for (double& mean : std::span(means).subspan(width * node, width)) {
      mean = around_[node] > 0.0 ? mean / around_[node] : std::numeric_limits<double>::quiet_NaN();
    }
  }
  return means;
}

std::vector<double> displacement_field(const mechanics::Body& body) {
  const VectorX sizes = (body.positions() - body.model().mesh().nodes).rowwise().norm();
  return {sizes.data(), sizes.data() + sizes.size()};
}

std::vector<double> row_force_field(const HasMaterial& body, std::span<const double> effort) {
  Points forces = Points::Zero(body.positions().rows(), 3);
  body.add_row_forces(effort, forces);
  const VectorX sizes = forces.rowwise().norm();
  return {sizes.data(), sizes.data() + sizes.size()};
}

}  // namespace sinew::fem
