// Notices about bodies whose linear elements are too stiff or too soft.
//
// A body is compared with the same mesh in quadratic elements: both are loaded at rest by
// everything that acts on the body in the scene, one cause at a time (sim/rest_fields.hpp), and the
// factor of a cause is the ratio of the mean motions of the nodes. Bodies on which nothing acts,
// and very fine ones, are judged as one beam instead (fem/bending_stiffness.hpp). Comparisons that
// take long are kept from run to run under a hash of all that they depend on
// (core/cache_folder.hpp).
#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "sinew/core/cache_folder.hpp"
#include "sinew/core/named_hash.hpp"
#include "sinew/fem/bending_stiffness.hpp"
#include "sinew/fem/fem_body_settings.hpp"
#include "sinew/fem/has_elements.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/mesh/quadratic.hpp"
#include "sinew/mesh/split_hexahedra.hpp"
#include "sinew/model/model.hpp"
#include "sinew/scene/build.hpp"
#include "sinew/scene/build_parts.hpp"
#include "sinew/sim/rest_fields.hpp"

namespace sinew::scene {

namespace {

/// Smaller factors are not mentioned.
constexpr double kMentioned = 1.1;
/// Factors above this are warned of, unless the scene asks for tet4, or for an element of a body on
/// which nothing acts.
constexpr double kWarned = 1.2;
/// Largest number of linear elements, a hexahedron counting as six, that are compared. The
/// comparison of as many takes some seconds.
constexpr std::size_t kMostElements = 40000;

/// How much too stiff a body is.
struct Excess {
  double factor = 1.0;   ///< below 1: too soft, as single mean-dilatation hexahedra in bending
  std::string cause;     ///< what acts; empty: the body counts as one beam
  double seconds = 0.0;  ///< of the comparison
  bool earlier = false;  ///< made by an earlier run

  double size() const { return std::max(factor, 1.0 / factor); }
};

/// Shorter comparisons are made again, s.
constexpr double kKept = 0.1;
/// Version of the comparison: kept results of others are not used.
constexpr const char* kKeptAs = "locking-1";

/// Under which the comparison of a body is kept.
std::string kept_name(const model::Model& model, const std::string& body) {
  ValueHash hash;
  for (const NamedHash& part : model.parts()) hash.add(part.name, part.hash);
  return fmt::format("{}/{:016x}", kKeptAs, hash.add(body).value());
}

std::optional<Excess> recalled(const std::string& name) {
  const std::optional<std::string> text = recall_result(name);
  if (!text) return std::nullopt;
  std::istringstream words(*text);
  Excess excess;
  excess.earlier = true;
  words >> excess.factor >> excess.seconds >> std::ws;
  const bool whole = words && std::getline(words, excess.cause);
  if (!whole || !(excess.factor > 0.0) || !std::isfinite(excess.factor)) return std::nullopt;
  return excess;
}

bool is_linear(const mesh::Mesh& mesh) { return mesh.quadratic.empty(); }

bool is_comparable(const mesh::Mesh& mesh) {
  return mesh.tetrahedra.size() + 6 * mesh.hexahedra.size() <= kMostElements;
}

double poisson_ratio(const MaterialDescription& material) {
  return material.is_hyperelastic() ? material.energy.poisson_ratio() : material.poisson_ratio;
}

double largest_poisson_ratio(const BodyDescription& body) {
  double largest = poisson_ratio(body.material);
  for (const PartDescription& part : body.parts) {
    largest = std::max(largest, poisson_ratio(part.material));
  }
  return largest;
}

/// Gives a linear or corotational material the hyperelastic law with the same moduli at rest, which
/// quadratic elements support.
void make_hyperelastic(MaterialDescription& material) {
  if (material.is_hyperelastic()) return;
  const material::ElasticConstants constants{material.young_modulus, material.poisson_ratio};
  material.model = MaterialModel::hyperelastic;
  material.energy = material::neo_hookean(constants.shear_modulus());
  material.energy.bulk_modulus =
      material::bulk_modulus_of(constants.shear_modulus(), material.poisson_ratio);
}

/// The bodies of a scene and what acts on them, without contacts and everything that measures.
SceneDescription only_acting(SceneDescription scene) {
  scene.contacts.clear();
  scene.controllers.clear();
  scene.effectors.clear();
  scene.estimators.clear();
  scene.probes.clear();
  scene.sensors.clear();
  return scene;
}

double mean_motion(const Points& field, Eigen::Index nodes) {
  return field.topRows(nodes).rowwise().norm().mean();
}

/// A scene as it is, and with quadratic elements.
class Comparison {
 public:
  /// Throws what build() throws. @param scene,model to be compared. @param bodies indices of those
  /// that get quadratic elements if something acts on them.
  Comparison(const SceneDescription& scene, const model::Model& model,
             const std::vector<std::size_t>& bodies) {
    SceneDescription own = only_acting(scene);
    SharedMeshes meshes;
    for (std::size_t b = 0; b < own.bodies.size(); ++b) {
      const auto* elements = mechanics::as<const fem::HasElements>(model.body(static_cast<int>(b)));
      if (elements == nullptr) continue;
      meshes[own.bodies[b].name] = {elements->settings().mesh, elements->settings().embedder};
    }
    const auto linear = build(own, meshes).model;
    for (const std::size_t b : bodies) {
      const int body = static_cast<int>(b);
      if (auto fields = sim::rest_fields(linear, body); !fields.empty()) linear_[body] = fields;
    }
    if (linear_.empty()) return;
    for (const std::size_t b : bodies) {
      if (!linear_.contains(static_cast<int>(b))) continue;
      BodyDescription& body = own.bodies[b];
      SharedMesh& mesh = meshes[body.name];
      mesh = {std::make_shared<const mesh::Mesh>(
                  mesh::with_middle_nodes(mesh::split_hexahedra(*mesh.mesh))),
              nullptr};
      body.element = Element::tet10;
      make_hyperelastic(body.material);
      for (PartDescription& part : body.parts) make_hyperelastic(part.material);
    }
    quadratic_ = build(std::move(own), meshes).model;
  }

  /// The factor of the cause for which it is farthest from 1; none if nothing acts on the body.
  std::optional<Excess> excess(int body) const {
    const auto linear = linear_.find(body);
    std::optional<Excess> worst;
    if (linear == linear_.end()) return worst;
    for (const sim::RestField& soft : sim::rest_fields(quadratic_, body)) {
      const auto stiff = std::ranges::find(linear->second, soft.cause, &sim::RestField::cause);
      if (stiff == linear->second.end()) continue;
      const Eigen::Index nodes = stiff->nodes.rows();
      const double factor = mean_motion(soft.nodes, nodes) / mean_motion(stiff->nodes, nodes);
      const Excess own{.factor = factor, .cause = soft.cause};
      if (!worst || own.size() > worst->size()) worst = own;
    }
    return worst;
  }

 private:
  std::map<int, std::vector<sim::RestField>> linear_;  // of the bodies on which something acts
  std::shared_ptr<const model::Model> quadratic_;
};

Excess as_one_beam(const BodyDescription& body, const mesh::Mesh& mesh) {
  const bool patches = body.element == Element::tet4_patch;
  return {.factor = fem::bending_stiffness_ratio(mesh, largest_poisson_ratio(body), patches)};
}

std::string element_words(const BodyDescription& body, const mesh::Mesh& mesh) {
  if (body.element == Element::tet4_patch) return "linear tetrahedra in patches (tet4-patch)";
  if (mesh.hexahedra.empty()) return "linear tetrahedra (tet4)";
  return mesh.tetrahedra.empty() ? "trilinear hexahedra (hex8)" : "linear elements (tet4, hex8)";
}

std::string stiffness_remedy(const BodyDescription& body, const mesh::Mesh& mesh) {
  const bool is_shape = !body.mesh.shape.empty();
  if (!mesh.hexahedra.empty()) {
    return is_shape ? "write element: tet10, or a smaller element_size"
                    : "refine the mesh, or give one of tetrahedra alone with element: tet10";
  }
  const auto is_hyperelastic = [](const auto& owner) { return owner.material.is_hyperelastic(); };
  if (is_hyperelastic(body) && std::ranges::all_of(body.parts, is_hyperelastic)) {
    return "write element: tet10, or leave `element` out";
  }
  const std::string other =
      "write element: tet10 and a hyperelastic law, for instance model: neo-hookean with the same "
      "moduli";
  return body.element == Element::tet4 ? other : other + "; element: tet4 keeps it as it is";
}

std::optional<Notice> notice_of(const BodyDescription& body, const mesh::Mesh& mesh,
                                const Excess& excess) {
  const double size = excess.size();
  if (!(size >= kMentioned)) return std::nullopt;
  // A body on which nothing acts may never bend.
  const bool by_choice =
      body.element == Element::tet4 || (body.element != Element::any && excess.cause.empty());
  const bool remark = by_choice || size < kWarned;
  const std::string how =
      excess.cause.empty()
          ? std::string("in bending, as one beam")
          : fmt::format(
                "under '{}' than quadratic elements of the same mesh (compared {} {:.2g} s)",
                excess.cause, excess.earlier ? "earlier, in" : "in", excess.seconds);
  return Notice{
      remark ? NoticeLevel::remark : NoticeLevel::warning, NoticeKind::locking_element,
      body.element == Element::any ? body.material.place : body.element_place,
      fmt::format("{} at Poisson's ratio {:.4g}: this mesh is {:.2g} times too {} {}",
                  element_words(body, mesh), 1e-9 * std::round(1e9 * largest_poisson_ratio(body)),
                  size, excess.factor < 1.0 ? "soft" : "stiff", how),
      stiffness_remedy(body, mesh)};
}

}  // namespace

std::vector<Notice> locking_notices(const SceneDescription& scene, const model::Model& model,
                                    const SharedMeshes& shared) {
  std::vector<std::size_t> linear, comparable;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const mechanics::BodyModel& body = model.body(static_cast<int>(b));
    const bool judged = mechanics::as<const fem::HasElements>(body) != nullptr &&
                        is_linear(body.mesh()) && !shared.contains(scene.bodies[b].name);
    if (judged) linear.push_back(b);
    if (judged && is_comparable(body.mesh())) comparable.push_back(b);
  }
  using Clock = std::chrono::steady_clock;
  const auto since = [](Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
  };
  std::map<std::size_t, Excess> known;
  for (const std::size_t b : comparable) {
    if (auto excess = recalled(kept_name(model, scene.bodies[b].name))) known[b] = *excess;
  }
  std::erase_if(comparable, [&](std::size_t b) { return known.contains(b); });
  const auto begin = Clock::now();
  std::optional<Comparison> comparison;
  try {
    if (!comparable.empty()) comparison.emplace(scene, model, comparable);
  } catch (const Error&) {
    // A region that selects nothing in the other mesh, for instance: the beam is left.
  }
  const double preparing = since(begin);
  for (const std::size_t b : comparable) {
    if (!comparison) break;
    const auto start = Clock::now();
    std::optional<Excess> excess = comparison->excess(static_cast<int>(b));
    if (!excess) continue;
    excess->seconds = preparing / static_cast<double>(comparable.size()) + since(start);
    known[b] = *excess;
    if (excess->seconds < kKept) continue;
    keep_result(kept_name(model, scene.bodies[b].name),
                fmt::format("{} {} {}\n", excess->factor, excess->seconds, excess->cause));
  }
  std::vector<Notice> notices;
  for (const std::size_t b : linear) {
    const mesh::Mesh& mesh = model.body(static_cast<int>(b)).mesh();
    const auto found = known.find(b);
    const Excess excess = found == known.end() ? as_one_beam(scene.bodies[b], mesh) : found->second;
    if (auto notice = notice_of(scene.bodies[b], mesh, excess)) {
      notices.push_back(std::move(*notice));
    }
  }
  return notices;
}

}  // namespace sinew::scene
