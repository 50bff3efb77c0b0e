/// @file
/// The kinds of loads in scenes. Each is a file, load_NAME.cpp, with its words, keys, reader and
/// builder, and a line in load_kind.cpp.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "sinew/builder/load_settings.hpp"
#include "sinew/scene/description.hpp"
#include "sinew/scene/grammar.hpp"
#include "sinew/scene/readers.hpp"

namespace sinew::scene {

/// A load that is built.
struct LoadSite {
  const LoadDescription& load;
  const mechanics::BearsLoads*
      bears;  ///< its body; null: it bears no loads, which is refused later

  /// The faces of a surface. @param surface of the body.
  std::vector<mesh::Face> faces(const SurfaceDescription& surface) const;
};

/// A kind of load. Its functions have no state.
struct LoadKind {
  const char* word = "";                                 ///< in scenes
  const char* description = "";                          ///< in the reference: "Over faces."
  std::shared_ptr<const KeyTable> (*table)() = nullptr;  ///< its keys, see forms::load_table()
  /// Reads the settings of a load, LoadDescription::own. Its body, `outside` and signal are read
  /// besides.
  void (*read)(const Fields& fields, const ReadContext& context, LoadDescription& load) = nullptr;
  /// Makes the load.
  builder::MakeLoad (*make)(const LoadSite& site) = nullptr;
  const char* quantity = "factor";  ///< what its value is called: "force"
  const char* signal = "factor";    ///< the key of its signal: a factor of its value, or its value
  const char* signal_unit = "";     ///< SI unit of its signal
  /// Its value at a factor of 1, with which Python sets loads whose `quantity` is a vector. Null:
  /// it is no vector.
  const Vector3& (*vector)(const LoadDescription& load) = nullptr;
  /// The pressure on faces if it is a fluid around the body, see water_head(). Null: it is none.
  double (*head)(const LoadSite& site, const std::vector<mesh::Face>& faces) = nullptr;

  bool signal_is_value() const { return std::string_view(signal) != "factor"; }
};

/// Adds a kind from outside the library. Call it before the grammar is first used, from one thread.
/// @param kind must outlive the program. Throws Error: duplicate-key (its word is taken),
/// bad-argument (the grammar is in use).
void register_load_kind(const LoadKind& kind);
/// The kind with a word. Throws Error(internal) if there is none.
const LoadKind& load_kind(std::string_view word);

const LoadKind& force_load_kind();
const LoadKind& line_load_kind();
const LoadKind& traction_kind();
const LoadKind& acceleration_kind();
const LoadKind& pressure_load_kind();
const LoadKind& water_kind();

}  // namespace sinew::scene
