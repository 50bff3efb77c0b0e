#include "scene_draft.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <stdexcept>

#include <fmt/format.h>

#include "sinew/scene/grammar.hpp"

#include "random.hpp"

namespace sinew::combine {

namespace {

[[noreturn]] void unknown(std::string_view feature, std::string_view level) {
  throw std::logic_error(fmt::format(
      "the grammar offers '{}' for {}, and the generator of scenes does not know how to write it",
      level, feature));
}

// "key: text" of a level, from a table of all levels.
std::string look_up(std::string_view feature, const std::string& level,
                    const std::map<std::string, std::string>& texts) {
  const auto found = texts.find(level);
  if (found == texts.end()) unknown(feature, level);
  return found->second;
}

std::string vector_text(const std::array<double, 3>& mm) {
  return fmt::format("{:.6g} {:.6g} {:.6g} mm", mm[0], mm[1], mm[2]);
}

// Positions on a body at rest, mm. All bodies are 60 mm long from base to tip.
struct BodyShape {
  std::string mesh;  // of finite element bodies
  std::string base, tip, side;
  int along = 0;                   // axis
  std::array<double, 3> origin{};  // of the axis, mm
  std::array<double, 3> half{};    // half size of the cross-section, mm
  double sense = 1.0;              // sign of the direction from base to tip

  // A point, (3,) mm. @param a 0 at the base, 1 at the tip. @param u,v -1 .. 1 across.
  std::array<double, 3> at(double a, double u, double v) const {
    std::array<double, 3> result = origin;
    const auto axis = static_cast<std::size_t>(along);
    result[axis] += sense * 60.0 * a;
    result[(axis + 1) % 3] += u * half[(axis + 1) % 3];
    result[(axis + 2) % 3] += v * half[(axis + 2) % 3];
    return result;
  }
  // The direction of contacts: opposite to the second axis across.
  int below() const { return (along + 2) % 3; }
};

BodyShape block_shape() {
  return {"{shape: block, length: 60 mm, width: 20 mm, height: 10 mm, element_size: 10 mm}",
          "x_min",
          "x_max",
          "z_max",
          0,
          {0.0, 10.0, 5.0},
          {30.0, 10.0, 5.0}};
}

// A spine of 6 mm along x with ribs. The gaps are where nothing is attached.
BodyShape ribbed_shape() {
  BodyShape shape = block_shape();
  shape.mesh =
      "{shape: ribbed-finger, length: 60 mm, width: 20 mm, height: 10 mm, ribs: 3, gap: 2 mm, "
      "spine: 6 mm, element_size: 10 mm}";
  return shape;
}

BodyShape round_shape(const std::string& mesh) {
  return {mesh, "bottom", "top", "side", 2, {}, {10.0, 10.0, 30.0}};
}

BodyShape fem_shape(const std::string& name) {
  if (name == "block") return block_shape();
  if (name == "ribbed-finger") return ribbed_shape();
  BodyShape shape = round_shape(look_up(
      "mesh", name,
      {{"cylinder", "{shape: cylinder, radius: 10 mm, height: 60 mm, element_size: 15 mm}"},
       {"capsule", "{shape: capsule, radius: 12 mm, length: 36 mm, element_size: 15 mm}"},
       {"cone",
        "{shape: cone, base_radius: 12 mm, tip_radius: 9 mm, height: 60 mm, element_size: 15 mm}"},
       {"hollow-cylinder",
        "{shape: hollow-cylinder, inner_radius: 5 mm, outer_radius: 11 mm, height: 60 mm, "
        "element_size: 20 mm}"},
       {"chambered-cylinder",
        "{shape: chambered-cylinder, radius: 12 mm, height: 60 mm, chamber_radius: 5 mm, "
        "chamber_offset: 4 mm, chamber_bottom: 10 mm, chamber_top: 50 mm, element_size: 30 mm}"}}));
  if (name == "hollow-cylinder") shape.side = "outer";
  if (name == "capsule") shape.origin[2] = -30.0;  // the mesh is centred at the origin
  return shape;
}

BodyShape arm_shape() { return {"", "", "", "", 2, {}, {10.0, 10.0, 30.0}, -1.0}; }

struct Body {
  std::string id;
  bool fem = true;
  BodyShape shape;
  bool rigid = false;
};

class Drafter {
 public:
  Drafter(const Selection& selection, std::uint64_t seed, bool symmetric = false)
      : selection_(selection), random_(seed), symmetric_(symmetric) {}

  SceneDraft draft() {
    write_settings();
    add_bodies();
    add_link();
    add_cables();
    add_chamber();
    add_spring();
    add_force();
    add_torque();
    add_load();
    add_mass();
    add_membrane();
    add_contact();
    add_loads_of_rigid_bodies();
    add_other_body();
    add_other_actuator();
    add_effector();
    add_probe();
    add_sensor();
    add_estimator();
    add_controller();
    SceneDraft draft{settings_, {}};
    for (const char* section :
         {"bodies", "actuators", "loads", "masses", "membranes", "effectors", "probes", "sensors",
          "estimators", "contacts", "joints", "controllers"}) {
      if (!sections_[section].empty()) draft.sections.emplace_back(section, sections_[section]);
    }
    return draft;
  }

 private:
  const std::string& of(std::string_view feature) const { return level(selection_, feature); }
  bool has(std::string_view feature) const { return of(feature) != "none"; }
  void add(const char* section, std::string id, std::string text) {
    sections_[section].push_back({std::move(id), std::move(text)});
  }
  double draw(double from, double to) { return random_.uniform(from, to); }
  // A place across a body, -1 to 1: in symmetric scenes on the plane of symmetry.
  double beside(double place) const { return symmetric_ ? 0.0 : place; }
  // A place from below to above, -1 to 1. In symmetric scenes it is inside the body: beside it, a
  // point would follow one of two elements that are equally near.
  double up(double place) const { return symmetric_ ? -0.5 : place; }
  // Components of a vector, which lies in the plane of symmetry of symmetric scenes.
  const char* within(const char* in_plane, const char* any) const {
    return symmetric_ ? in_plane : any;
  }
  bool dynamic() const { return of("integrator") != "quasi-static"; }

  // The first finite-element body or the first arm; nullptr if there is none.
  const Body* body(bool fem) const {
    const auto found = std::ranges::find_if(
        bodies_, [&](const Body& own) { return own.fem == fem && !own.rigid; });
    return found == bodies_.end() ? nullptr : &*found;
  }
  // A random body.
  const Body& some_body() {
    return bodies_[static_cast<std::size_t>(random_.below(static_cast<int>(bodies_.size())))];
  }

  void write_settings() {
    const std::string& integrator = of("integrator");
    // Newton's method for rubber with a matrix that is too stiff needs hundreds of iterations, and
    // quadratic elements (the default) need tenths of a second per iteration. Such scenes use the
    // exact tangent.
    const bool quadratic = !has("element") || of("element") == "tet10";
    const bool slow = of("method") == "newton" && hyperelastic() && (!dynamic() || quadratic);
    const std::string tangent = slow ? "exact" : of("tangent");
    std::string solver = fmt::format("method: {}, tangent: {}, factorisation: {}, ordering: {}",
                                     of("method"), tangent, of("factorisation"), of("ordering"));
    // An inexact matrix converges linearly, so that the number of iterations would affect results.
    if (of("method") == "newton" && tangent != "exact") solver += ", tolerance: 1e-11";
    if (has("equilibrium")) solver += ", equilibrium: " + of("equilibrium");
    if (has("adaptive")) solver += ", adaptive: {tolerance: 1e-3, smallest: 2.5 ms}";
    settings_ = fmt::format("sinew: 1\ntime_step: {} ms\nintegrator: {}\nsolver: {{{}}}\n",
                            dynamic() ? 5 : 10, integrator, solver);
    if (has("gravity")) settings_ += "gravity: -3 0 -5 m/s^2\n";
  }

  std::string material() {
    std::string text = look_up(
        "material", of("material"),
        {{"corotational", "model: corotational, young_modulus: 120 kPa, poisson_ratio: 0.35"},
         {"linear", "model: linear, young_modulus: 120 kPa, poisson_ratio: 0.35"},
         {"neo-hookean", "model: neo-hookean, shear_modulus: 40 kPa, poisson_ratio: 0.45"},
         {"mooney-rivlin", "model: mooney-rivlin, c10: 15 kPa, c01: 5 kPa, poisson_ratio: 0.45"},
         {"yeoh", "model: yeoh, c10: 20 kPa, c20: 1 kPa, c30: 0.1 kPa, poisson_ratio: 0.45"},
         {"ogden",
          "model: ogden, mu: 30 10 kPa, alpha: 2 4, convention: two-mu-over-alpha-squared, "
          "poisson_ratio: 0.45"},
         {"arruda-boyce",
          "model: arruda-boyce, shear_modulus: 40 kPa, locking_stretch: 3.5, poisson_ratio: 0.45"},
         {"saint-venant-kirchhoff",
          "model: saint-venant-kirchhoff, young_modulus: 120 kPa, poisson_ratio: 0.35"},
         {"ecoflex-00-30", "ecoflex-00-30"}});
    if (text == "ecoflex-00-30") return text;
    if (hyperelastic()) {
      text +=
          look_up("history", of("history"),
                  {{"none", ""},
                   {"viscosity", ", viscosity: [{relative_modulus: 0.2, relaxation_time: 20 ms}]"},
                   {"softening", ", softening: {r: 2, m: 50 Pa, beta: 0.1}"}});
    }
    return "{" + text + "}";
  }
  bool hyperelastic() const {
    return of("material") != "corotational" && of("material") != "linear";
  }

  void add_bodies() {
    const std::string& kinds = of("bodies");
    std::size_t from = 0;
    while (from < kinds.size()) {
      const std::size_t end = std::min(kinds.find(' ', from), kinds.size());
      const std::string kind = kinds.substr(from, end - from);
      from = end + 1;
      const std::string id = fmt::format("body_{}", bodies_.size());
      if (kind == "fem") {
        const bool first = body(true) == nullptr;
        const bool tube = first && has("chamber") && of("mesh") != "chambered-cylinder";
        bodies_.push_back({id, true,
                           !first ? block_shape()
                           : tube ? fem_shape("hollow-cylinder")
                                  : fem_shape(of("mesh"))});
        add_fem_body(bodies_.back());
      } else if (kind == "pcc") {
        bodies_.push_back({id, false, arm_shape()});
        add("bodies", id,
            "{type: pcc, segments: [{length: 30 mm, mass: 10 g, stiffness: 0.02 N m, damping: "
            "2e-4 N m s, bending: spatial}, {length: 30 mm, mass: 10 g, stiffness: 0.02 N m, "
            "damping: 2e-4 N m s}]}");
      } else {
        unknown("bodies", kind);
      }
    }
  }

  // The element of a body; empty: the default of its material. An estimator repeats every step, and
  // Eigen factorises slowly: both would take minutes with hundreds of quadratic nodes.
  std::string element_of() const {
    const bool patches = of("material") != "saint-venant-kirchhoff";
    const bool quadratic = hyperelastic() && (!has("element") || of("element") == "tet10");
    const bool slow = has("estimator") || of("factorisation") != "block";
    if (quadratic && slow) return "tet4";  // patches are not symmetric
    const bool fits = of("element") != "tet4-patch" || patches;
    const bool named = has("element") && fits && (hyperelastic() || of("element") == "tet4");
    return named ? of("element") : "";
  }

  // @param held how the body is held: fixed, or placed and held by a joint.
  void add_fem_body(const Body& body, std::string held = {}) {
    const bool loose = !held.empty();
    if (!loose) held = fmt::format("fixed: {{set: {}}}", body.shape.base);
    std::string text =
        fmt::format("type: fem, mesh: {}, material: {}, density: 1000 kg/m^3, mass_matrix: {}, {}",
                    body.shape.mesh, material(), of("mass_matrix"), held);
    const std::string element = element_of();
    if (!element.empty()) text += ", element: " + element;
    if (has("damping")) text += ", damping: {mass: 0.5 1/s, stiffness: 1 ms}";
    if (has("velocity") && dynamic()) {
      text += fmt::format(", velocity: {{linear: {} m/s}}", within("0.02 0 0.05", "0.02 0.05 0"));
    }
    if (has("motion") && !loose) {
      text += fmt::format(
          ", motion: {{{}: {{sine: {{amplitude: {:.3g} mm, period: 200 ms}}}}, angle: {{ramp: "
          "{{to: "
          "{:.3g} deg, duration: 100 ms}}}}, axis: 0 1 0}}",
          within("z", "y"), draw(1.0, 3.0), draw(2.0, 8.0));
    }
    add("bodies", body.id, "{" + text + "}");
  }

  // A block of 20 mm on the side of a body, near its tip, whose weight bends the body. Everything
  // that acts on any body also acts on it.
  void add_link() {
    if (!has("link")) return;
    if (of("link") != "weld") return add_rigid_link();
    const Body on = some_body();
    BodyShape shape = block_shape();
    shape.mesh = "{shape: block, length: 60 mm, width: 20 mm, height: 10 mm, element_size: 10 mm}";
    std::array<double, 3> at = on.shape.at(0.8, 0.0, 0.0);
    for (std::size_t k = 0; k < 3; ++k) shape.origin[k] += at[k];
    const std::string region = fmt::format("{{set: {}}}", shape.base);
    std::string text = look_up(
        "weld", of("weld"),
        {{"region", "region: " + region},
         {"points",
          fmt::format("points: [{}, {}, {}]", vector_text(shape.at(0.0, 0.0, 0.0)),
                      vector_text(shape.at(0.0, 0.6, 0.0)), vector_text(shape.at(0.1, 0.0, 0.6)))},
         {"touching", ""}});
    // Sections of an arm are rigid, and its mesh is only drawn.
    if (text.empty() && !on.fem) text = "region: " + region;
    if (!text.empty()) text = ", " + text + ", outside: nearest";
    add("joints", "seam",
        fmt::format("{{type: {}, bodies: [<link>, <{}>]{}}}", of("link"), on.id, text));
    bodies_.push_back({"link", true, shape});
    add_fem_body(bodies_.back(), fmt::format("pose: {{position: {}}}", vector_text(at)));
  }

  // In statics it must be held, so other joints replace hinges, and there is no motor.
  std::string link_type() const {
    const std::string& type = of("link");
    return dynamic() || type == "slider" ? type : "hinge";
  }

  // The part to which a rigid link is joined: a section of an arm, a point of finite elements if
  // possible, or else a bracket that is welded to them.
  std::string link_base(const Body& on, const std::array<double, 3>& at, const std::string& type) {
    if (!on.fem || type == "ball") return on.id;
    add("bodies", "bracket",
        fmt::format("{{type: rigid, shape: {{box: 8 8 8 mm}}, density: 1200 kg/m^3, pose: "
                    "{{position: {}}}}}",
                    vector_text(at)));
    add("joints", "bond",
        fmt::format("{{type: weld, bodies: [<{}>, <bracket>], points: [{}, {}, {}], outside: "
                    "nearest}}",
                    on.id, vector_text(on.shape.at(0.75, 0.0, 0.8)),
                    vector_text(on.shape.at(0.85, 0.3, 0.8)),
                    vector_text(on.shape.at(0.8, -0.3, 0.7))));
    return "bracket";
  }

  // A rigid body of 60 mm along x, which starts at a joint near the tip of a body.
  void add_rigid_link() {
    const Body on = some_body();
    const std::array<double, 3> at = on.shape.at(0.8, 0.0, 0.8);  // clear of bores and chambers
    const std::string type = link_type(), base = link_base(on, at, type);
    Body link{"link", false, block_shape(), true};
    link.shape.origin = at;
    std::array<double, 3> centre = at;
    centre[0] += 30.0;
    const std::string shape = look_up("link_shape", of("link_shape"),
                                      {{"box", "box: 60 20 10 mm"},
                                       {"sphere", "sphere: {radius: 12 mm}"},
                                       {"capsule", "capsule: {radius: 8 mm, length: 44 mm}"},
                                       {"cylinder", "cylinder: {radius: 8 mm, height: 60 mm}"}});
    const bool lies = of("link_shape") == "capsule" || of("link_shape") == "cylinder";
    add("bodies", "link",
        fmt::format(
            "{{type: rigid, shape: {{{}}}, density: 1000 kg/m^3, pose: {{position: {}{}}}}}", shape,
            vector_text(centre), lies ? ", rotation: {axis: y, angle: 90 deg}" : ""));
    bodies_.push_back(link);
    const bool turns = type == "hinge" || type == "cylindrical";
    const bool slides = type == "slider" || type == "cylindrical";
    std::string text =
        fmt::format("type: {}, bodies: [<{}>, <link>], point: {}", type, base, vector_text(at));
    if (turns || slides) text += slides ? ", axis: 1 0 0" : ", axis: 0 1 0";
    if (type == "universal") text += ", axes: [0 1 0, 0 0 1]";
    if (has("joint_limits") && turns) text += ", limits: {angle: {min: -5 deg, max: 4 deg}}";
    if (has("joint_limits") && !turns && slides) {
      text += ", limits: {displacement: {min: -2 mm, max: 1 mm}}";
    }
    if (has("joint_friction") && turns != slides) {
      text += turns ? ", friction: 0.1 mN m" : ", friction: 5 mN";
    }
    add("joints", "seam", "{" + text + "}");
    if (turns != slides) add_motor(turns);
  }

  void add_motor(bool turns) {
    std::string told = of("motor");
    if (!dynamic() && (told == "none" || told == "torque")) told = "angle";
    if (told == "none") return;
    const std::string command =
        look_up("motor", told,
                {{"angle", turns ? "angle: " + signal(draw(1.0, 5.0), "deg")
                                 : "displacement: " + signal(draw(0.3, 1.5), "mm")},
                 {"torque", turns ? "torque: " + signal(draw(0.1, 1.0), "mN m")
                                  : "force: " + signal(draw(0.01, 0.1), "N")},
                 {"velocity", turns ? "velocity: " + signal(draw(10.0, 60.0), "deg/s")
                                    : "velocity: " + signal(draw(2.0, 10.0), "mm/s")}});
    std::string text = fmt::format("type: {}, joint: <seam>, command: {{{}}}",
                                   turns ? "motor" : "linear-motor", command);
    if (dynamic()) {
      text += turns ? ", limits: {torque: {min: -0.1 N m, max: 0.1 N m}}"
                    : ", limits: {force: {min: -5 N, max: 5 N}}";
      steerable_.push_back({"motor", "link"});
    }
    add("actuators", "motor", "{" + text + "}");
  }

  // A signal that ends at a given value.
  std::string signal(double value, const char* unit) {
    return look_up(
        "cable_signal", of("cable_signal"),
        {{"value", fmt::format("{:.4g} {}", value, unit)},
         {"ramp", fmt::format("{{ramp: {{to: {:.4g} {}, duration: 40 ms}}}}", value, unit)},
         {"sine", fmt::format("{{sine: {{amplitude: {:.4g} {}, period: 100 ms}}}}", value, unit)},
         {"steps", fmt::format("{{steps: [[0 s, 0 {1}], [20 ms, {0:.4g} {1}]]}}", value, unit)}});
  }

  void add_cable(const std::string& id, const Body& body, double u, double v,
                 const std::string& told) {
    const auto link = std::ranges::find(bodies_, "link", &Body::id);
    const bool far = of("cable_end") == "link" && link != bodies_.end() && body.id != "link";
    const std::string end =
        far ? fmt::format("{{body: <link>, point: {}}}", vector_text(link->shape.at(0.4, u, v)))
            : vector_text(body.shape.at(0.95, 0.8 * u, v));
    std::string text = fmt::format(
        "type: cable, body: <{}>, outside: nearest, pull: {}, points: [{}, {}, {}], limits: "
        "{{tension: {{max: 5 N}}, displacement: {{min: -10 mm, max: 8 mm}}}}",
        body.id, of("cable_pull"), vector_text(body.shape.at(0.05, u, v)),
        vector_text(body.shape.at(0.5, u, 0.9 * v)), end);
    text += look_up(
        "cable", told,
        {{"displacement", ", command: {displacement: " + signal(draw(0.2, 1.5), "mm") + "}"},
         {"tension", ", command: {tension: " + signal(draw(0.1, 0.5), "N") + "}"},
         {"untold", ""}});
    if (has("cable_friction")) text += ", friction: 0.3";
    if (body.fem) {  // arm sections are rigid
      text += look_up("cable_guides", of("cable_guides"),
                      {{"none", ""},
                       {"radius", ", guide_radius: 2 mm"},
                       {"spacing", ", guide_spacing: 20 mm"}});
    }
    if (!has("cable_stiffness")) text += ", geometric_stiffness: false";
    add("actuators", id, "{" + text + "}");
    steerable_.push_back({id, body.id});
  }

  void add_cables() {
    if (!has("cable")) return;
    const Body& body = some_body();
    if (symmetric_) {
      // Both get the same command: the numbers are drawn again.
      const Random now = random_;
      add_cable("cable_0", body, 0.6, -0.2, of("cable"));
      random_ = now;
      return add_cable("cable_1", body, -0.6, -0.2, of("cable"));
    }
    add_cable("cable_0", body, 0.6, -0.2, of("cable"));
    if (of("second_cable") == "twin") add_cable("cable_1", body, 0.6, -0.2, "tension");
    if (of("second_cable") == "antagonist") add_cable("cable_1", body, -0.6, -0.2, "tension");
  }

  void add_chamber() {
    const Body* on = body(true);
    if (!has("chamber") || on == nullptr || on->id == "link") return;
    const std::string& told = of("chamber");
    std::string medium = of("medium");
    if (told == "gas" || told == "liquid") medium = told;
    const bool closed = of("mesh") == "chambered-cylinder";
    std::string text = fmt::format(
        "type: chamber, body: <{}>, surface: {}, limits: {{pressure: {{min: -10 kPa, max: 20 "
        "kPa}}}}",
        on->id, closed ? "{inside: 4 0 30 mm}" : "{set: inner}, cap: true");
    if (has("ambient") && medium != "gas") text += ", ambient_pressure: 95 kPa";
    text += look_up("medium", medium,
                    {{"none", ""},
                     {"gas", ", ambient_pressure: 95 kPa, gas: {dead_volume: 1 ml}"},
                     {"liquid", ", liquid: {bulk_modulus: 1 MPa, dead_volume: 1 ml}"}});
    text += look_up(
        "chamber", told,
        {{"pressure", ", command: {pressure: " + signal(draw(0.3, 1.5), "kPa") + "}"},
         {"volume_growth", ", command: {volume_growth: " + signal(draw(0.02, 0.1), "ml") + "}"},
         {"gas", ", command: {gas: " + signal(draw(0.02, 0.1), "ml") + "}"},
         {"liquid", ", command: {liquid: " + signal(draw(0.02, 0.1), "ml") + "}"}});
    add("actuators", "chamber", "{" + text + "}");
    steerable_.push_back({"chamber", on->id});
  }

  void add_spring() {
    if (!has("spring")) return;
    const Body& on = some_body();
    const std::string coil = "wire_diameter: 0.5 mm, mean_diameter: 4 mm, coils: 10";
    const std::string kind =
        look_up("spring", of("spring"),
                {{"stiffness", "stiffness: 30 N/m, free_length: 25 mm, damping: 0.1 N s/m"},
                 {"coil", "stiffness: {" + coil + ", shear_modulus: 5 GPa}, free_length: 28 mm"},
                 {"band", "stiffness: 30 N/m, tension_only: true, free_length: 31 mm"},
                 {"shape_memory", "shape_memory: {" + coil + "}, command: {power: 2 W}"}});
    add("actuators", "spring",
        fmt::format("{{type: spring, body: <{}>, outside: nearest, points: [{}, {}], {}}}", on.id,
                    vector_text(on.shape.at(0.3, beside(-0.5), up(0.5))),
                    vector_text(on.shape.at(0.8, beside(-0.5), up(0.5))), kind));
  }

  void add_force() {
    if (!has("force")) return;
    const Body& on = some_body();
    const std::string told =
        look_up("force", of("force"),
                {{"force", "force: " + signal(draw(0.02, 0.1), "N")},
                 {"displacement", "displacement: " + signal(draw(0.2, 1.0), "mm")}});
    add("actuators", "push",
        fmt::format("{{type: force, body: <{}>, point: {}, direction: {}, outside: nearest, "
                    "command: {{{}}}, limits: {{force: {{min: -2 N, max: 2 N}}}}}}",
                    on.id, vector_text(on.shape.at(0.9, 0.0, 0.0)), within("1 0 1", "1 1 0"),
                    told));
    steerable_.push_back({"push", on.id});
  }

  // The keys that a kind requires, with the values of their examples. @param body to which the key
  // `body` refers. @param place of the first key that is a place; receives it, if it is not empty.
  std::string example_of(const char* section, const std::string& kind, const std::string& body,
                         std::string* place) const {
    std::string text = "type: " + kind;
    for (const scene::Key& key : variant_table(section, kind).keys) {
      if (!key.required) continue;
      const scene::Form& form = key.forms.front();
      const bool is_body = form.shape == scene::Shape::reference && form.refers_to == "bodies";
      text += fmt::format(", {}: {}", key.name, is_body ? "<" + body + ">" : key.example);
      const bool is_place = form.shape == scene::Shape::quantity && form.max_count == 3;
      if (is_place && place != nullptr && place->empty()) *place = key.example;
    }
    return text;
  }

  // A body of a kind that only the registry knows, pushed and observed, half a millimetre above a
  // floor.
  void add_other_body() {
    if (!has("other_body")) return;
    std::string place;
    add("bodies", "other", "{" + example_of("bodies", of("other_body"), "", &place) + "}");
    if (place.empty()) unknown("other_body", of("other_body"));
    add("actuators", "nudge",
        fmt::format("{{type: force, body: <other>, point: {}, direction: 1 0 -2, outside: nearest, "
                    "command: {{force: {}}}, limits: {{force: {{min: -1 N, max: 1 N}}}}}}",
                    place, signal(draw(0.02, 0.1), "N")));
    steerable_.push_back({"nudge", "other"});
    add("effectors", "other_place",
        fmt::format("{{body: <other>, point: {}, outside: nearest}}", place));
    add("contacts", "other_floor",
        fmt::format("{{body: <other>, points: [{0}], surface: {{plane: {{point: {0}, normal: 0 0 "
                    "1}}}}, outside: nearest{1}}}",
                    place, has("contact_friction") ? ", friction: 0.5" : ""));
  }

  // An actuator of a kind that only the registry knows, with a command in the unit of its effort.
  void add_other_actuator() {
    if (!has("other_actuator")) return;
    const std::string id = has("other_body") ? "other" : some_body().id;
    const scene::KeyTable& keys = variant_table("actuators", of("other_actuator"));
    const scene::KeyTable& command = *form_of(keys, "command", scene::Shape::table).table;
    const scene::Key& effort = command.keys[1];  // after the motion, see drive_keys()
    add("actuators", "drive",
        fmt::format("{{{}, command: {{{}: {:.3g} {}}}}}",
                    example_of("actuators", of("other_actuator"), id, nullptr), effort.name,
                    draw(0.02, 0.1), effort.forms.front().unit));
    steerable_.push_back({"drive", id});
  }

  void add_torque() {
    const Body* on = body(false);
    if (!has("torque") || on == nullptr) return;
    const std::string told = look_up("torque", of("torque"),
                                     {{"torque", "torque: " + signal(draw(1.0, 4.0), "N mm")},
                                      {"angle", "angle: " + signal(draw(2.0, 8.0), "deg")}});
    add("actuators", "twist",
        fmt::format("{{type: torque, body: <{}>, segment: 1, command: {{{}}}, limits: {{torque: "
                    "{{min: -0.1 N m, max: 0.1 N m}}}}}}",
                    on->id, told));
    steerable_.push_back({"twist", on->id});
  }

  void add_load() {
    const Body* on = body(true);
    if (!has("load") || on == nullptr) return;
    const BodyShape& shape = on->shape;
    const std::string where = fmt::format(", surface: {{set: {}}}", shape.side);
    const std::string what = look_up(
        "load", of("load"),
        {{"force", fmt::format(", point: {}, force: 0.02 0 -0.03 N, outside: nearest, factor: "
                               "{{ramp: {{to: 1, duration: 30 ms}}}}",
                               vector_text(shape.at(0.8, 0.0, 0.0)))},
         {"line", fmt::format(", points: [{}, {}], outside: nearest, force_per_length: {} N/m",
                              vector_text(shape.at(0.2, beside(0.5), up(0.5))),
                              vector_text(shape.at(0.9, beside(0.5), up(0.5))),
                              within("0 0 0.5", "0 0.5 0"))},
         {"traction", where + ", traction: 10 0 -20 Pa"},
         {"acceleration",
          fmt::format(
              ", acceleration: {} m/s^2, factor: {{sine: {{amplitude: 1, period: 100 ms}}}}",
              within("1 0 0.5", "1 0.5 0"))},
         {"pressure", where + ", pressure: {ramp: {to: 50 Pa, duration: 30 ms}}"},
         {"water", ", density: 1000 kg/m^3, velocity: 0.1 0 0 m/s"}});
    add("loads", "load", fmt::format("{{type: {}, body: <{}>{}}}", of("load"), on->id, what));
  }

  // The same kind of load as that of the deformable body. A pressure on a part of a rigid body has
  // no equilibria, and water as dense as the body would leave it neutral.
  void add_loads_of_rigid_bodies() {
    if (symmetric_ || sections_["loads"].empty()) return;
    std::string what;
    if (of("load") == "force") {
      what = "point: 20 5 -5 mm, force: 0.01 0 -0.02 N, outside: nearest";
    } else if (of("load") == "acceleration") {
      what = "acceleration: 0.5 0 1 m/s^2, factor: {sine: {amplitude: 1, period: 80 ms}}";
    } else if (of("load") == "water") {
      what = "density: 800 kg/m^3, velocity: 0.1 0 0 m/s";
    } else {
      return;
    }
    for (const auto& [id, text] : sections_["bodies"]) {
      if (text.find("type: rigid") == std::string::npos) continue;
      if (text.find("plane:") != std::string::npos) continue;
      add("loads", "on_" + id, fmt::format("{{type: {}, body: <{}>, {}}}", of("load"), id, what));
    }
  }

  void add_mass() {
    const Body* on = body(true);
    if (!has("mass") || on == nullptr) return;
    add("masses", "hung",
        fmt::format("{{body: <{}>, point: {}, mass: 2 g, outside: nearest}}", on->id,
                    vector_text(on->shape.at(0.95, beside(0.2), up(0.2)))));
  }

  void add_membrane() {
    const Body* on = body(true);
    if (!has("membrane") || on == nullptr) return;
    add("membranes", "skin",
        fmt::format(
            "{{body: <{}>, surface: {{set: {}}}, thickness: 0.1 mm, young_modulus: 10 MPa}}",
            on->id, on->shape.side));
  }

  // A box that moves along an axis. In statics it is at rest, or has a prescribed motion.
  void add_stone(const std::array<double, 3>& centre, std::size_t along, const char* axis) {
    std::string moves = "fixed: true";
    flies_ |= dynamic();
    if (dynamic()) {
      moves = fmt::format("mass: 20 g, velocity: {{linear: {} m/s, angular: {} rad/s}}", axis,
                          within("0 1 0", "3 1 2"));
    } else if (has("motion")) {
      moves = fmt::format(
          "motion: {{{}: {{ramp: {{to: 0.4 mm, duration: 60 ms}}}}, angle: {{ramp: {{to: 2 deg, "
          "duration: 60 ms}}}}, axis: {}, centre: {}}}",
          "xyz"[along], within("0 1 0", axis), vector_text(centre));
    }
    add("bodies", "stone",
        fmt::format("{{type: rigid, shape: {{box: 30 30 30 mm}}, pose: {{position: {}}}, {}}}",
                    vector_text(centre), moves));
  }

  // A silicone box that moves likewise. In statics it is fixed at its far side.
  void add_pillow(const std::array<double, 3>& centre, std::size_t along, const char* axis) {
    const std::string moves = dynamic() ? fmt::format("velocity: {{linear: {} m/s}}", axis)
                                        : fmt::format("fixed: [{{set: {}_min}}]", "xyz"[along]);
    flies_ |= dynamic();
    std::array<double, 3> corner = centre;
    for (double& x : corner) x -= 15.0;
    add("bodies", "pillow",
        fmt::format(
            "{{type: fem, mesh: {{shape: block, length: 30 mm, width: 30 mm, height: 30 mm, "
            "element_size: 15 mm}}, pose: {{position: {}}}, density: 1000 kg/m^3, material: "
            "{{young_modulus: 100 kPa, poisson_ratio: 0.3}}, {}}}",
            vector_text(corner), moves));
  }

  // Contact of two surfaces, or of one with itself. Rigid bodies and arms touch a stone.
  std::string touching(const Body& on, std::size_t below, const std::array<double, 3>& centre) {
    const char* axes[] = {"1 0 0", "0 1 0", "0 0 1"};
    if (on.fem && of("contact") == "self") return fmt::format("between: [<{0}>, <{0}>]", on.id);
    if (on.fem && of("contact") == "soft") {
      add_pillow(centre, below, axes[below]);
      return fmt::format("between: [<{}>, <pillow>]", on.id);
    }
    add_stone(centre, below, axes[below]);
    return fmt::format("between: [<{}>, <stone>]", on.id);
  }

  static std::string tip_points(const Body& on) {
    if (on.fem) return fmt::format(", nodes: {{set: {}}}", on.shape.tip);
    return fmt::format(", points: [{}, {}]{}", vector_text(on.shape.at(1.0, 0.0, 0.0)),
                       vector_text(on.shape.at(1.0, 0.0, -1.0)),
                       on.rigid ? ", outside: nearest" : "");
  }

  // Surfaces are slightly apart from the tip.
  void add_contact() {
    if (!has("contact")) return;
    const Body& on = some_body();
    const auto below = static_cast<std::size_t>(on.shape.below());
    const double gap = draw(0.05, 1.0);
    const char* axes[] = {"1 0 0", "0 1 0", "0 0 1"};
    std::array<double, 3> at = on.shape.at(1.0, 0.0, 0.0);
    at[below] = on.shape.origin[below] - 1.3 * on.shape.half[below] - gap;
    std::array<double, 3> centre = at;
    centre[below] -= 15.0;
    std::array<double, 3> left = centre, right = centre;
    left[(below + 2) % 3] -= 40.0;
    right[(below + 2) % 3] += 40.0;
    const std::string surface = look_up(
        "contact", of("contact"),
        {{"plane", fmt::format("plane: {{point: {}, normal: {}}}", vector_text(at), axes[below])},
         {"sphere", fmt::format("sphere: {{centre: {}, radius: 15 mm}}", vector_text(centre))},
         {"capsule", fmt::format("capsule: {{ends: [{}, {}], radius: 15 mm}}", vector_text(left),
                                 vector_text(right))},
         {"body", ""},
         {"soft", ""},
         {"self", ""},
         {"ground", ""}});
    const auto motion = [&] {
      return fmt::format(", motion: {{{}: {{ramp: {{to: {:.3g} mm, duration: 60 ms}}}}}}",
                         "xyz"[below], gap + draw(0.5, 2.5));
    };
    if (of("contact") == "ground") {
      // Rotates z to x, y or z.
      const char* turns[] = {"0 90 0 deg", "-90 0 0 deg", "0 0 0 deg"};
      add("bodies", "ground",
          fmt::format(
              "{{type: rigid, shape: {{plane: {{}}}}, pose: {{position: {}, rotation: {}}}{}}}",
              vector_text(at), turns[below], has("contact_motion") ? motion() : ", fixed: true"));
    }
    std::string text = !surface.empty() ? fmt::format("body: <{}>, surface: {{{}}}", on.id, surface)
                       : of("contact") == "ground" ? fmt::format("between: [<{}>, <ground>]", on.id)
                                                   : touching(on, below, centre);
    if (!on.fem || (of("contact") != "soft" && of("contact") != "self")) text += tip_points(on);
    if (has("contact_friction")) text += ", friction: 0.5";
    if (has("contact_friction") && has("kinetic_friction")) text += ", kinetic_friction: 0.3";
    if (has("contact_zones") && on.fem) text += ", aggregate: 12 mm";
    if (has("contact_motion") && !surface.empty()) text += motion();
    add("contacts", "floor", "{" + text + "}");
  }

  void add_effector() {
    std::string kind = of("effector");
    if (kind == "none" && has("controller")) kind = "point";
    if (kind == "none") return;
    const Body* chosen = &some_body();
    // A closed loop is refused if none of its actuators moves its effector.
    if (has_loop()) chosen = &*std::ranges::find(bodies_, steerable_.front().body, &Body::id);
    const Body& on = *chosen;
    if (kind == "set" && !on.fem) kind = "point";
    const BodyShape& shape = on.shape;
    tip_ = shape.at(1.0, 0.0, 0.0);
    orientation_ = kind == "orientation";
    if (orientation_ && !on.fem) kind = "section";
    const std::string what =
        look_up("effector", kind,
                {{"point", "point: " + vector_text(tip_)},
                 {"set", "set: " + shape.tip},
                 {"section", "orientation: " + vector_text(tip_)},
                 {"orientation", fmt::format("orientation: [{}, {}, {}]", vector_text(tip_),
                                             vector_text(shape.at(1.0, 0.5, 0.0)),
                                             vector_text(shape.at(0.9, 0.0, 0.5)))}});
    add("effectors", "tip", fmt::format("{{body: <{}>, outside: nearest, {}}}", on.id, what));
    if (!has_loop()) return;
    // The sensor that measures the effector has the same position, in its own keys.
    const bool turns = kind == "orientation" || kind == "section";
    const std::string place = turns ? "at" + what.substr(what.find(':')) : what;
    add("sensors", "measured",
        fmt::format("{{type: {}, body: <{}>, outside: nearest, {}, delay: 5 ms}}",
                    turns ? "orientation" : "marker", on.id, place));
  }

  // Its response has no inertia, so a freely swinging link would move too far or without bound.
  bool has_loop() const {
    if (!has("controller") || !has("feedback") || steerable_.empty()) return false;
    return steerable_.front().body != "link" || of("link") == "weld";
  }

  void add_probe() {
    if (!has("probe")) return;
    std::string kind = of("probe");
    const bool of_nodes = kind == "set" || kind == "bend" || kind == "extent";
    const Body& any = some_body();
    const Body* on = of_nodes && !any.fem ? body(true) : &any;
    if (on == nullptr) {
      kind = "point";
      on = &any;
    }
    const BodyShape& shape = on->shape;
    const std::string middle = vector_text(shape.at(0.5, 0.2, 0.0));
    const std::string end = vector_text(shape.at(0.9, 0.2, 0.0));
    const std::string what =
        look_up("probe", kind,
                {{"point", "point: " + end},
                 {"set", "set: " + shape.tip},
                 {"line", fmt::format("line: [{}, {}]", middle, end)},
                 {"bend", fmt::format("bend: [{{set: {}}}, {{set: {}}}]", shape.base, shape.tip)},
                 {"distance", fmt::format("distance: [{}, {}]", middle, end)},
                 {"extent", "extent: {along: x}"}});
    add("probes", "gauge", fmt::format("{{body: <{}>, outside: nearest, {}}}", on->id, what));
  }

  bool stands(const char* section, std::string_view id) {
    return std::ranges::any_of(sections_[section], [&](const Item& one) { return one.id == id; });
  }

  // The quantity that a sensor of a type measures; empty if the robot does not have it.
  std::string sensed(const std::string& kind, const Body& on) {
    const BodyShape& shape = on.shape;
    const std::string middle = vector_text(shape.at(0.5, 0.2, 0.0));
    const std::string end = vector_text(shape.at(0.9, 0.2, 0.0));
    const std::string own = fmt::format("body: <{}>, outside: nearest, ", on.id);
    const std::string line = fmt::format("{}line: [{}, {}]", own, middle, end);
    const std::string frame = on.fem ? fmt::format("{}at: [{}, {}, {}]", own, end, middle,
                                                   vector_text(shape.at(0.9, 0.0, 0.5)))
                                     : own + "at: " + end;
    const char* cable = stands("actuators", "cable_0") ? "actuator: <cable_0>" : "";
    const char* air = stands("actuators", "chamber") ? "actuator: <chamber>" : "";
    const char* floor = stands("contacts", "floor") ? "contact: <floor>" : "";
    const std::string winch =
        *cable == '\0' ? "" : fmt::format("{}, torque_constant: 0.05 N m/A, radius: 8 mm", cable);
    const std::string plates =
        on.fem ? fmt::format("body: <{}>, electrodes: [{{set: {}}}, {{set: {}}}]", on.id,
                             shape.base, shape.tip)
               : "";
    return look_up("sensor", kind,
                   {{"marker", own + "point: " + end},
                    {"orientation", frame},
                    {"gyroscope", frame},
                    {"accelerometer", frame},
                    {"cable-length", cable},
                    {"cable-tension", cable},
                    {"pressure", air},
                    {"volume", air},
                    {"flow", air},
                    {"motor-current", winch},
                    {"stretch", line},
                    {"resistance", line + ", resistance: 1 kOhm, gauge_factor: 2"},
                    {"curvature", line + ", places: [12 mm]"},
                    {"attenuation", line + ", loss_per_turn: 1 dB"},
                    {"capacitance", plates},
                    {"contact-force", floor},
                    {"touch", floor}});
  }

  void add_sensor() {
    if (!has("sensor")) return;
    std::string kind = of("sensor");
    const Body& on = some_body();
    std::string what = sensed(kind, on);
    if (what.empty()) {
      kind = "marker";
      what = sensed(kind, on);
    }
    add("sensors", "sense",
        fmt::format("{{type: {}, {}, delay: 15 ms, dropout: 20 %}}", kind, what));
  }

  // An estimator of a force that may be absent, and perhaps of an effort besides the command or of
  // the stiffness of a body. For efforts the model is quasi-static, which excludes flying or
  // swinging bodies; otherwise it has inertia.
  void add_estimator() {
    if (!has("estimator")) return;
    const bool held = !flies_ && (!has("link") || of("link") == "weld");
    // It makes each step once per column, so only two integrators represent all dynamic ones.
    const bool dynamic = of("integrator") == "bdf2" || of("integrator") == "event-driven";
    const bool moves = of("estimator") != "effort" && dynamic;
    if (!moves && !held) return;
    const Body& on = bodies_.front();
    add("sensors", "seen",
        fmt::format("{{type: marker, {}, noise: 0.1 mm, delay: 5 ms}}", sensed("marker", on)));
    std::string unknown =
        fmt::format("hand: {{force: {{body: <{}>, point: {}, outside: nearest}}, prior: 0.1 N}}",
                    on.id, vector_text(on.shape.at(0.7, 0.2, 0.0)));
    if (of("estimator") == "effort" && stands("actuators", "cable_0")) {
      unknown += ", slip: {tension: {actuator: <cable_0>}, prior: 0.2 N}";
    } else if (of("estimator") == "effort" && stands("actuators", "chamber")) {
      unknown += ", leak: {pressure: {actuator: <chamber>, command: unknown}, prior: 0.5 kPa}";
    }
    if (of("estimator") == "stiffness" && on.fem) {
      unknown += fmt::format(", soft: {{stiffness: {{body: <{}>}}, prior: 20 %}}", on.id);
    }
    add("estimators", "guess",
        fmt::format("{{type: filter, sensors: [<seen>], {}, unknowns: {{{}}}}}",
                    moves ? "rank: 3" : "inertia: false", unknown));
  }

  void add_controller() {
    if (!has("controller") || steerable_.empty()) return;
    if (of("controller") != "inverse") unknown("controller", of("controller"));
    std::array<double, 3> target = tip_;
    for (double& x : target) x += draw(-1.0, 1.0);
    const std::string task =
        orientation_ ? "rotation: 0.02 0.03 0 rad" : "target: " + vector_text(target);
    std::string actuators;
    for (const Steerable& one : steerable_) {
      actuators += (actuators.empty() ? "" : ", ") + ("<" + one.id + ">");
      if (random_.below(3) == 0) break;  // the other actuators follow their commands
    }
    if (has_loop()) {
      add("controllers", "follow",
          fmt::format("{{type: closed-loop, effectors: {{<tip>: {{{}}}}}, sensors: [<measured>], "
                      "actuators: [{}], gain: 10 1/s, integral: 4 1/s^2}}",
                      task, actuators));
      return;
    }
    add("controllers", "follow",
        fmt::format("{{type: inverse, effectors: {{<tip>: {{{}}}}}, actuators: [{}], {}"
                    "regularisation: {{of: {}}}}}",
                    task, actuators, force_task(), of("regularisation")));
  }

  // The controller's task for the contact with the floor.
  std::string force_task() {
    if (!has("force_task") || !stands("contacts", "floor")) return "";
    const std::string& kind = of("force_task");
    const bool reserved = kind == "reserve" && has("contact_friction");
    return fmt::format("contacts: {{<floor>: {{{}}}}}, ",
                       kind == "force" ? "normal_force: 100 mN"
                       : reserved      ? "slip: false, reserve: 0.2"
                                       : "normal_force: {min: 50 mN, max: 1 N}");
  }

  const Selection& selection_;
  Random random_;
  std::string settings_;
  std::map<std::string, std::vector<Item>> sections_;
  std::vector<Body> bodies_;
  struct Steerable {
    std::string id, body;
  };
  std::vector<Steerable> steerable_;
  std::array<double, 3> tip_{};
  bool orientation_ = false;
  bool flies_ = false;      // whether there is a free body
  bool symmetric_ = false;  // about the plane across y through the middle of the block
};

// Other names with the opposite alphabetical order.
std::string other_name(const std::string& id) {
  return fmt::format("z{:03}_{}", 999 - static_cast<int>(id.size()) * 7 - id.back(), id);
}

std::string replace_references(std::string text, const Layout& layout) {
  for (std::size_t from = text.find('<'); from != std::string::npos; from = text.find('<', from)) {
    const std::size_t end = text.find('>', from);
    const std::string id = text.substr(from + 1, end - from - 1);
    const std::string name = layout.renamed ? other_name(id) : id;
    text.replace(from, end - from + 1, name);
    from += name.size();
  }
  return text;
}

}  // namespace

SceneDraft draft_scene(const Selection& selection, std::uint64_t seed) {
  return Drafter(selection, seed).draft();
}

SceneDraft draft_symmetric_scene(Selection selection, std::uint64_t seed) {
  set_level(selection, "bodies", "fem");
  set_level(selection, "mesh", seed % 2 == 0 ? "block" : "ribbed-finger");
  for (const char* one : {"chamber", "link", "controller", "estimator", "contact_zones",
                          "other_body", "other_actuator"}) {
    set_level(selection, one, "none");
  }
  if (level(selection, "element") == "tet4-patch") set_level(selection, "element", "tet10");
  return Drafter(selection, seed, true).draft();
}

std::string write_scene(const SceneDraft& draft, const Layout& layout) {
  std::string text = draft.settings;
  constexpr std::string_view kNewton = "solver: {method: newton", kTight = ", tolerance: 1e-11";
  const std::size_t newton = text.find(kNewton);
  if (layout.converged && newton != std::string::npos && text.find(kTight) == std::string::npos) {
    text.insert(newton + kNewton.size(), kTight);
  }
  for (const auto& [section, items] : draft.sections) {
    text += section + ":\n";
    std::vector<Item> ordered = items;
    if (layout.reversed) std::ranges::reverse(ordered);
    for (const Item& item : ordered) {
      const std::string name = layout.renamed ? other_name(item.id) : item.id;
      text += fmt::format("  {}: {}\n", name, replace_references(item.text, layout));
    }
  }
  return text;
}

}  // namespace sinew::combine
