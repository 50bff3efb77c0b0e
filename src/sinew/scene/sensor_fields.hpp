/// @file
/// What the tables of several kinds of sensors share. Internal to this folder and to kinds of
/// sensors.
#pragma once

#include <memory>
#include <vector>

#include "sinew/scene/grammar_forms.hpp"

namespace sinew::scene::forms {

/// Measure of a sensor's output, and examples of its errors.
struct OutputWords {
  Measure measure;
  const char* error;    ///< a likely noise
  const char* quantum;  ///< a likely step
  const char* range;
};
/// The table of a sensor: its own keys, and those of its channel.
/// @param type its word. @param description of it. @param own its keys. @param output for errors.
std::shared_ptr<const KeyTable> sensor_table(const char* type, const char* description,
                                             std::vector<Key> own, const OutputWords& output);
/// The table of a sensor without errors, such as a switch.
/// @param type,description,own see above.
std::shared_ptr<const KeyTable> sensor_table(const char* type, const char* description,
                                             std::vector<Key> own);
/// Words of a position.
OutputWords position_output();
/// The key `actuator`. @param example of a name.
Key measured_actuator_key(const char* example);
/// Keys of a sensor along a line of a body.
std::vector<Key> sensed_line_keys();
/// Key `samples` of a line.
Key line_samples_key();
/// A number that is required and positive. @param name,measure,example,description of it.
Key positive_key(const char* name, const Measure& measure, const char* example,
                 const char* description);

}  // namespace sinew::scene::forms
