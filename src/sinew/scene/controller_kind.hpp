/// @file
/// The kinds of controllers in scenes. Each is a file, controller_NAME.cpp, with its words, keys,
/// reader and builder, and a line in controller_kind.cpp.
#pragma once

#include <any>
#include <memory>
#include <string_view>

#include "sinew/control/target_controller.hpp"
#include "sinew/scene/description.hpp"
#include "sinew/scene/grammar.hpp"
#include "sinew/scene/readers.hpp"

namespace sinew::scene {

/// A controller that is read: its tasks and actuators have been.
struct ControllerEntry {
  const Fields& fields;
  const ReadContext& context;
  const SceneDescription& scene;  ///< all parts but controllers
  const ControllerDescription& controller;
};

/// A controller that is built.
struct ControllerSite {
  const ControllerDescription& controller;
  const model::Model& model;
  control::TargetSettings targets;  ///< its tasks and actuators, by number
};

/// A kind of controller. Its functions have no state; `own` is what read() returned.
struct ControllerKind {
  const char* word = "";         ///< in scenes
  const char* description = "";  ///< in the reference
  /// The keys of such a controller, of which `effectors` comes from forms::tasks_key() and
  /// `actuators` from forms::driven_key().
  std::shared_ptr<const KeyTable> (*table)() = nullptr;
  /// Reads and checks its settings.
  std::any (*read)(const ControllerEntry& entry) = nullptr;
  /// The settings of the controller, see control::settings_for().
  control::ControllerSettings (*build)(const ControllerSite& site) = nullptr;
};

/// Adds a kind from outside the library. Call it before the grammar is first used, from one thread.
/// @param kind must outlive the program. Throws Error: duplicate-key (its word is taken),
/// bad-argument (the grammar is in use).
void register_controller_kind(const ControllerKind& kind);
/// The kind with a word. Throws Error(internal) if there is none.
const ControllerKind& controller_kind(std::string_view word);

const ControllerKind& inverse_kind();
const ControllerKind& closed_loop_kind();

}  // namespace sinew::scene
