/// @file
/// The kinds of probes in scenes. Each is a file, probe_NAME.cpp, with its keys, reader and
/// builder, and a line in probe_kind.cpp.
#pragma once

#include <string>
#include <vector>

#include "sinew/builder/probe_settings.hpp"
#include "sinew/scene/build_parts.hpp"
#include "sinew/scene/description.hpp"
#include "sinew/scene/grammar.hpp"
#include "sinew/scene/readers.hpp"

namespace sinew::scene {

/// A probe that is built.
struct ProbeSite {
  const ProbeDescription& probe;
  const BodyOf& body_of;

  /// The number of the body of a part. @param k its index.
  int body(std::size_t k) const { return body_of(probe.parts[k].body).number; }
  /// The nodes in the region of a part, or without one all nodes of its body. @param k its index.
  std::vector<NodeId> nodes(std::size_t k) const;
};

/// A kind of probe, which a scene chooses by one of its keys. Its functions have no state.
struct ProbeKind {
  const char* word = "";  ///< "line"
  /// Its keys. Those without Key::only_with choose it.
  std::vector<Key> (*keys)() = nullptr;
  /// Reads ProbeDescription::parts and `own`. There is one part already, with place and body.
  void (*read)(const Fields& fields, const ReadContext& context, ProbeDescription& probe) = nullptr;
  /// Makes what it measures.
  builder::MakeProbe (*make)(const ProbeSite& site) = nullptr;
};

/// The kinds, in the order of the reference.
const std::vector<const ProbeKind*>& probe_kinds();
/// Adds a kind from outside the library. Call it before the grammar is first used, from one thread.
/// @param kind must outlive the program. Throws Error: duplicate-key (its word is taken),
/// bad-argument (the grammar is in use).
void register_probe_kind(const ProbeKind& kind);

namespace forms {
/// Key `body` of a part, which may be left out.
Key part_body_key();
}  // namespace forms

const ProbeKind& point_probe_kind();
const ProbeKind& line_probe_kind();
const ProbeKind& bend_probe_kind();
const ProbeKind& distance_probe_kind();
const ProbeKind& extent_probe_kind();

}  // namespace sinew::scene
