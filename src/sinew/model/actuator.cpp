#include "sinew/model/actuator.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/model/fluid_drive.hpp"
#include "sinew/model/spring_drive.hpp"

namespace sinew::model {

namespace {

constexpr QuantityName kTension{"tension", "N"}, kDisplacement{"displacement", "m"};

// Indexed by ActuatorType.
constexpr std::array<ActuatorWords, kActuatorTypes> kWords = {{
    {"cable", kTension, kDisplacement},
    {"force", {"force", "N"}, kDisplacement},
    {"chamber",
     {"pressure", "Pa"},
     {"volume_growth", "m^3"},
     {GasDrive::kInput, LiquidDrive::kInput}},
    {"spring", kTension, kDisplacement, {SmaDrive::kPower, SmaDrive::kPhase}},
    {"torque", {"torque", "N m"}, {"angle", "rad"}},
    {"motor", {"torque", "N m"}, {"angle", "rad"}, {{{"velocity", "rad/s"}}}},
    {"linear-motor", {"force", "N"}, kDisplacement, {{{"velocity", "m/s"}}}},
}};

std::vector<std::string_view> every_quantity() {
  std::vector<std::string_view> names;
  const auto add = [&](const QuantityName& quantity) {
    const std::string_view name = quantity.name;
    if (!name.empty() && std::ranges::find(names, name) == names.end()) names.push_back(name);
  };
  for (const ActuatorWords& words : kWords) {
    add(words.motion);
    add(words.effort);
    for (const QuantityName& input : words.inputs) add(input);
  }
  return names;
}

}  // namespace

const ActuatorWords& actuator_words(ActuatorType type) {
  return kWords[static_cast<std::size_t>(type)];
}

std::optional<ActuatorType> actuator_type(std::string_view word) {
  const auto found = std::ranges::find(kWords, word, &ActuatorWords::type);
  if (found == kWords.end()) return std::nullopt;
  return static_cast<ActuatorType>(found - kWords.begin());
}

const std::vector<std::string_view>& command_quantities() {
  static const std::vector<std::string_view> names = every_quantity();
  return names;
}

bool ActuatorModel::holds_motion(CommandKind kind) const {
  if (kind == CommandKind::input) return joint >= 0;
  return kind == CommandKind::motion && (drive == nullptr || !drive->acts_on(kind));
}

QuantityName ActuatorModel::input_name() const {
  if (drive != nullptr) return drive->input();
  return joint >= 0 ? words().inputs[0] : QuantityName{};
}

QuantityName ActuatorModel::quantity(CommandKind kind) const {
  if (kind == CommandKind::effort) return words().effort;
  if (kind == CommandKind::motion) return words().motion;
  const QuantityName input = input_name();
  return *input.name == '\0' ? words().motion : input;
}

Limits ActuatorModel::effort_limits(CommandKind kind) const {
  Limits limits = effort;
  if (kind == CommandKind::motion && vacuum && limits.min == *vacuum) {
    limits.min = -std::numeric_limits<double>::infinity();
  }
  return limits;
}

void ActuatorModel::check_command(const Command& told) const {
  if (!vacuum || told.kind != CommandKind::effort) return;
  const double lowest = told.signal.lowest();
  if (lowest >= *vacuum) return;
  throw Error(
      ErrorKind::out_of_range, {.item = fmt::format("actuator '{}'", name)},
      fmt::format("a pressure of {:.6g} kPa is below vacuum: the ambient pressure is {:.6g} "
                  "kPa",
                  1e-3 * lowest, -1e-3 * *vacuum),
      fmt::format("give {:.6g} kPa or more, or the chamber's `ambient_pressure`", 1e-3 * *vacuum));
}

std::optional<CommandKind> ActuatorModel::kind_of(std::string_view quantity) const {
  if (controllable() && quantity == words().effort.name) return CommandKind::effort;
  if (controllable() && quantity == words().motion.name) return CommandKind::motion;
  const bool known = !quantity.empty() && quantity == input_name().name;
  return known ? std::optional(CommandKind::input) : std::nullopt;
}

}  // namespace sinew::model
