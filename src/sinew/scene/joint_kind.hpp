/// @file
/// The kinds of joints in scenes. Each is a file, joint_NAME.cpp, with its words, keys, reader and
/// builder, and a line in joint_kind.cpp. What a joint holds is constraint::JointType.
#pragma once

#include <memory>
#include <string_view>

#include "sinew/scene/build_parts.hpp"
#include "sinew/scene/description.hpp"
#include "sinew/scene/grammar.hpp"
#include "sinew/scene/readers.hpp"

namespace sinew::scene {

/// A joint that is built.
struct JointSite {
  builder::ModelBuilder& builder;
  const JointDescription& joint;
  const BodyOf& body_of;
};

/// A kind of joint. Its functions have no state.
struct JointKind {
  const char* word = "";         ///< in scenes
  const char* description = "";  ///< in the reference: "Turns about an axis."
  std::shared_ptr<const KeyTable> (*table)() = nullptr;  ///< its keys, with forms::bodies_key()
  /// Reads the settings of a joint, JointDescription::own. Its bodies are read besides.
  void (*read)(const Fields& fields, const ReadContext& context, JointDescription& joint) = nullptr;
  /// Adds the joint to the model, and returns its number.
  int (*add)(const JointSite& site) = nullptr;
  /// Whether its rows come after those of contacts, see build(). No motor drives such a joint.
  bool is_bond = false;
};

/// Adds a kind from outside the library. Call it before the grammar is first used, from one thread.
/// @param kind must outlive the program. Throws Error: duplicate-key (its word is taken),
/// bad-argument (the grammar is in use).
void register_joint_kind(const JointKind& kind);
/// The kind with a word. Throws Error(internal) if there is none.
const JointKind& joint_kind(std::string_view word);

const JointKind& weld_kind();
const JointKind& ball_kind();
const JointKind& hinge_kind();
const JointKind& slider_kind();
const JointKind& cylindrical_kind();
const JointKind& universal_kind();

}  // namespace sinew::scene
