/// @file
/// The kinds of actuators in scenes. Each is a file, actuator_NAME.cpp, with its words, keys,
/// reader and builder, and a line in actuator_kind.cpp.
#pragma once

#include <any>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/builder/model_builder.hpp"
#include "sinew/model/actuator_kind.hpp"
#include "sinew/scene/build_parts.hpp"
#include "sinew/scene/description.hpp"
#include "sinew/scene/grammar.hpp"
#include "sinew/scene/readers.hpp"

namespace sinew::scene {

/// An actuator that is built, and what it may act on.
struct ActuatorSite {
  builder::ModelBuilder& builder;
  const SceneDescription& scene;
  const ActuatorDescription& actuator;
  const BodyOf& body_of;
  const JointOf& joint_of;

  /// Settings with what all actuators have: name, location and command.
  template <class Settings>
  Settings complete(Settings settings) const {
    settings.name = actuator.name;
    settings.place = actuator.place;
    settings.command = actuator.command;
    return settings;
  }
  /// The same with the number of the actuator's body.
  template <class Settings>
  Settings on_body(const Settings& own) const {
    Settings settings = complete(own);
    settings.body = body_of(actuator.body).number;
    return settings;
  }
};

/// Bodies on which an actuator acts besides its own.
struct FurtherBodies {
  std::vector<std::string>* names = nullptr;  ///< empty names mean its own
  Location place;                             ///< where they are written
};

/// A kind of actuator. Its functions have no state; `own` is what read() returned.
struct ActuatorKind {
  const model::ActuatorKind* words = nullptr;  ///< its word in scenes, and its quantities
  const char* description = "";                ///< in the reference: "A sliding cable."
  /// The keys of such an actuator, of which `limits` and `command` come from forms::drive_keys().
  std::shared_ptr<const KeyTable> (*table)() = nullptr;
  /// Reads its settings from fields with these keys.
  std::any (*read)(const Fields& fields, const ReadContext& context) = nullptr;
  /// Adds the actuator to the model.
  void (*add)(const ActuatorSite& site) = nullptr;
  bool on_body = true;  ///< whether it has the key `body`
  /// Called with the quantity that the scene commands, and where; may throw. Null: any is allowed.
  void (*take_command)(std::any& own, const std::string& key, const Location& place) = nullptr;
  /// The bodies on which it acts besides its own. Null: none.
  FurtherBodies (*bodies)(std::any& own) = nullptr;
  /// Removes all that limits its effort, for estimators. Null: its effort is not estimated.
  void (*free_effort)(std::any& own) = nullptr;

  const char* word() const { return words->word; }
};

/// Adds a kind from outside the library. Call it before the grammar is first used, from one thread.
/// @param kind must outlive the program. Throws Error: duplicate-key (its word is taken),
/// bad-argument (the grammar is in use).
void register_actuator_kind(const ActuatorKind& kind);
/// The kind with a word. Throws Error(internal) if there is none.
const ActuatorKind& actuator_kind(std::string_view word);
/// Names of the bodies on which an actuator acts besides its own; empty names mean its own.
std::vector<std::string> further_bodies(const ActuatorDescription& actuator);

const ActuatorKind& cable_kind();
const ActuatorKind& force_kind();
const ActuatorKind& torque_kind();
const ActuatorKind& motor_kind();
const ActuatorKind& linear_motor_kind();
const ActuatorKind& chamber_kind();
const ActuatorKind& spring_kind();

}  // namespace sinew::scene
