// The tables of sensors, with the channel that they share.
#include "sinew/scene/grammar_forms.hpp"

namespace sinew::scene::forms {

namespace {

// Measures of a sensor's output, for the keys of its channel.
struct Said {
  Measure measure;
  const char* error;    // a likely noise
  const char* quantum;  // a likely step
  const char* range;
};

std::vector<Key> transport_keys() {
  return {{.name = "rate",
           .forms = {quantity(frequency(), positive())},
           .example = "100 Hz",
           .description = "Samples per second: a sample every k-th time step, with integer k. "
                          "Default: one sample per step."},
          {.name = "delay",
           .forms = {quantity(time(), non_negative())},
           .example = "20 ms",
           .default_text = "0 s",
           .description = "Time from taking a sample to its delivery. It arrives at the first step "
                          "after that time."},
          {.name = "dropout",
           .forms = {quantity(plain_number(), {.min = 0.0, .max = 1.0})},
           .example = "1 %",
           .default_text = "0",
           .description = "Probability that a sample is lost; the previous one then remains."},
          {.name = "timeout",
           .forms = {quantity(time(), positive())},
           .example = "100 ms",
           .description = "Age from which a sample is no longer valid. Default: no limit."},
          {.name = "seed",
           .forms = {integer(0, 2'000'000'000)},
           .example = "1",
           .default_text = "0",
           .description = "Seed of the random numbers, which also depend on the sensor's name."}};
}

std::vector<Key> file_keys(const Measure& measure) {
  std::vector<Key> keys = {
      {.name = "file",
       .forms = {file()},
       .example = "measured.csv",
       .description =
           "CSV file with samples of a real sensor, which replace the simulated ones: times in s "
           "in the first column, then values; or with headings, as in sensors.csv. `delay` is "
           "added to the times. `noise` then states the accuracy of the sensor."},
      {.name = "columns",
       .forms = {list({text()})},
       .example = "[marker_x, marker_y, marker_z]",
       .description = "Headings of the columns with the values. Default: the headings of "
                      "sensors.csv, or else all columns after the time.",
       .only_with = "file"},
      {.name = "missing",
       .forms = {choice({{"error", "Cells that are empty or nan, and gaps in time, are errors."},
                         {"lost", "They count as lost samples."}})},
       .example = "lost",
       .default_text = "error",
       .description = "Meaning of samples that are missing from the file. With `rate`, times more "
                      "than one and a half periods apart are a gap.",
       .only_with = "file"}};
  if (*measure.unit != '\0') {
    keys.push_back(
        {.name = "unit",
         .forms = {unit(measure)},
         .example = measure.unit,
         .description = "Unit of the file's values. Default: the unit in the headings, or else SI.",
         .only_with = "file"});
  }
  return keys;
}

std::vector<Key> error_keys(const Said& said) {
  const std::string zero = std::string("0 ") + said.measure.unit;
  return {
      {.name = "noise",
       .forms = {quantity(said.measure, non_negative())},
       .example = said.error,
       .default_text = zero,
       .description = "Standard deviation of the white noise on each component of each sample."},
      {.name = "bias",
       .forms = {quantity(said.measure)},
       .example = said.error,
       .default_text = zero,
       .description = "Constant error."},
      {.name = "drift",
       .forms = {quantity(said.measure, non_negative())},
       .example = said.error,
       .default_text = zero,
       .description =
           "Standard deviation of a random walk after 1 s; it grows with the square root of time."},
      {.name = "quantum",
       .forms = {quantity(said.measure, positive())},
       .example = said.quantum,
       .description = "Step to which values are rounded. Default: no rounding."},
      {.name = "range",
       .forms = {vector(said.measure, 2)},
       .example = said.range,
       .description =
           "Smallest and largest value, at which the sensor saturates. Default: no limits."}};
}

void append(std::vector<Key>& keys, std::vector<Key> more) {
  for (Key& key : more) keys.push_back(std::move(key));
}

std::vector<Key> channel_keys(const Said& said) {
  std::vector<Key> keys = error_keys(said);
  append(keys, transport_keys());
  append(keys, file_keys(said.measure));
  return keys;
}

// A table of the keys of all sensors, used only for the reference.
std::shared_ptr<const KeyTable> channel_table() {
  static const auto table = make_table(
      {.name = "keys of all sensors",
       .description = "Errors, timing and files. Errors, quantum and range have the unit of the "
                      "measured quantity; the table shows them for a length.",
       .keys = channel_keys({length(), "0.1 mm", "0.01 mm", "-0.5 0.5 m"})});
  return table;
}

std::shared_ptr<const KeyTable> sensor_table(const char* type, const char* description,
                                             std::vector<Key> own, const Said& said) {
  KeyTable sensor{.name = std::string("sensor: type ") + type,
                  .description = description,
                  .keys = std::move(own),
                  .shared = channel_table()};
  append(sensor.keys, channel_keys(said));
  return make_table(std::move(sensor));
}

Said position() { return {length(), "0.1 mm", "0.01 mm", "-0.5 0.5 m"}; }

std::shared_ptr<const KeyTable> marker_table() {
  std::vector<Key> keys = spot_keys();
  keys.insert(keys.begin(), body_key());
  keys.push_back(outside_key());
  KeyTable marker =
      *sensor_table("marker", "Position of a point, (3,) m, as a motion-capture marker.",
                    std::move(keys), position());
  marker.alternatives = {{{"point", "points", "set"}, true}};
  return make_table(std::move(marker));
}

std::vector<Key> frame_keys() {
  return {
      body_key(),
      {.name = "at",
       .forms = {list({vector(length())}, 3, 3), vector(length())},
       .example = "[0 0 190 mm, 10 0 190 mm, 0 10 190 mm]",
       .description = "Three points of a deformable body that define the orientation, or one point "
                      "of a rigid body or of an arm's section. Positions are in the mesh at rest.",
       .required = true},
      outside_key()};
}

std::vector<Key> actuator_keys(const char* example) {
  return {{.name = "actuator",
           .forms = {reference("actuators")},
           .example = example,
           .description = "The actuator that it measures.",
           .required = true}};
}

std::vector<Key> line_keys(bool sampled) {
  std::vector<Key> keys = {body_key(),
                           {.name = "line",
                            .forms = {table(point_file_table()), list({vector(length())}, 2)},
                            .example = "[0 0 0 mm, 0 0 195 mm]",
                            .description = "Corners of the sensor's line, in the mesh at rest.",
                            .required = true},
                           outside_key()};
  if (!sampled) return keys;
  keys.push_back({.name = "samples",
                  .forms = {integer(2, 10000)},
                  .example = "21",
                  .default_text = "21",
                  .description = "Number of points along the line, evenly spaced at rest; the "
                                 "corners are always included."});
  return keys;
}

Key number_key(const char* name, const Measure& measure, const char* example,
               const char* description) {
  return {.name = name,
          .forms = {quantity(measure, positive())},
          .example = example,
          .description = description,
          .required = true};
}

std::shared_ptr<const KeyTable> resistance_table() {
  std::vector<Key> keys = line_keys(true);
  keys.push_back(number_key("resistance", resistance(), "1 kOhm", "Resistance at rest R_0."));
  keys.push_back(number_key("gauge_factor", plain_number(), "2", "Gauge factor G."));
  return sensor_table("resistance",
                      "A resistive strain gauge along a line: R_0 (1 + G (L/L_0 - 1)), Ohm.",
                      std::move(keys), {resistance(), "1 Ohm", "0.1 Ohm", "0 2 kOhm"});
}

std::shared_ptr<const KeyTable> curvature_table() {
  std::vector<Key> keys = line_keys(false);
  keys.push_back(
      {.name = "places",
       .forms = {list({quantity(length(), non_negative())})},
       .example = "[50 mm, 100 mm, 150 mm]",
       .description = "Arc lengths along the line at rest where the curvature is measured.",
       .required = true});
  keys.push_back({.name = "gauge",
                  .forms = {quantity(length(), positive())},
                  .example = "20 mm",
                  .description = "Gauge length; choose it longer than an element of the mesh. "
                                 "Default: a tenth of the line."});
  keys.push_back({.name = "about",
                  .forms = axis_forms(),
                  .example = "y",
                  .description =
                      "Axis about which the curvature is taken, positive by the right-hand rule "
                      "along the line. Default: the magnitude of the curvature."});
  return sensor_table(
      "curvature",
      "Curvature at positions along a line, (places,) 1/m, as measured by gratings in an optical "
      "fibre. Each value belongs to the circle through the ends and the middle of a gauge length.",
      std::move(keys), {curvature(), "0.1 1/m", "0.01 1/m", "-100 100 1/m"});
}

std::shared_ptr<const KeyTable> attenuation_table() {
  std::vector<Key> keys = line_keys(true);
  const auto loss = [](const char* name, const Measure& measure, const char* example,
                       const char* description) {
    return Key{.name = name,
               .forms = {quantity(measure, non_negative())},
               .example = example,
               .default_text = "0",
               .description = description};
  };
  keys.push_back(
      loss("loss_per_length", curvature(), "20 dB/m", "Coefficient a, loss per length."));
  keys.push_back(loss("loss_per_turn", plain_number(), "1.5 dB",
                      "Coefficient b, loss per turning angle, dB/rad."));
  return sensor_table("attenuation",
                      "Loss of light in a waveguide along a line, dB: a L + b times the total "
                      "turning angle (the integral of the curvature's magnitude).",
                      std::move(keys), {plain_number(), "0.01 dB", "0.01 dB", "0 40 dB"});
}

std::shared_ptr<const KeyTable> electrode_table() {
  KeyTable electrode{
      .name = "electrode",
      .description = "Faces of a body's surface: exactly one of patch, box, sphere, plane and set.",
      .keys = {*surface_table()->find("patch")},
      .alternatives = {{{"patch", "box", "sphere", "plane", "set"}, true}}};
  append(electrode.keys, region_keys("Faces with all their nodes"));
  Key body = body_key();
  body.required = false;
  body.description = "The body that has the faces. Default: the sensor's body.";
  electrode.keys.push_back(std::move(body));
  return make_table(std::move(electrode));
}

std::shared_ptr<const KeyTable> capacitance_table() {
  return sensor_table(
      "capacitance",
      "Capacitance of two electrodes that follow the body, F: permittivity times area over "
      "distance, summed over faces, as for parallel plates without fringe fields.",
      {body_key(),
       {.name = "electrodes",
        .forms = {list({table(electrode_table())}, 2, 2)},
        .example = "[{set: bottom}, {set: top}]",
        .description = "The two electrodes.",
        .required = true},
       {.name = "permittivity",
        .forms = {quantity(plain_number(), {.min = 1.0})},
        .example = "2.8",
        .default_text = "1",
        .description = "Relative permittivity of the material between them."}},
      {capacitance(), "0.01 pF", "0.001 pF", "0 100 pF"});
}

std::vector<Key> contact_keys() {
  std::vector<Key> patch = region_keys("Nodes");
  Key body = body_key();
  body.required = false;
  body.description =
      "The body that has the patch. Default: the first body of the contact. Required for an entry "
      "`between: all`.";
  patch.push_back(std::move(body));
  return {
      {.name = "contact",
       .forms = {reference("contacts")},
       .example = "floor",
       .description = "The contact to measure: a contact, one pair of a `between: all` entry (such "
                      "as `all-finger-box`), or the entry itself for all its pairs.",
       .required = true},
      {.name = "patch",
       .forms = {table(make_table(
           {.name = "patch of a contact",
            .description = "Nodes of the mesh at rest: exactly one of box, sphere, plane and set. "
                           "A contact point belongs to the patch if its nearest surface node does.",
            .keys = std::move(patch),
            .alternatives = {{{"box", "sphere", "plane", "set"}, true}}}))},
       .example = "{set: pad}",
       .description = "Region that it measures. Default: the whole contact."}};
}

std::shared_ptr<const KeyTable> touch_table() {
  KeyTable touch{.name = "sensor: type touch",
                 .description = "Contact switch: 1 if something touches, otherwise 0.",
                 .keys = contact_keys(),
                 .shared = channel_table()};
  touch.keys.push_back({.name = "threshold",
                        .forms = {quantity(force(), non_negative())},
                        .example = "0.1 N",
                        .default_text = "0 N",
                        .description = "Normal force above which the sensor reads 1."});
  append(touch.keys, transport_keys());
  append(touch.keys, file_keys(plain_number()));
  return make_table(std::move(touch));
}

std::shared_ptr<const KeyTable> current_table() {
  std::vector<Key> keys = actuator_keys("drive");
  keys.push_back(
      {.name = "torque_constant",
       .forms = {quantity(torque_constant(), positive())},
       .example = "0.05 N m/A",
       .description = "Torque per current of a rotary motor, including one that winds a cable."});
  keys.push_back({.name = "force_constant",
                  .forms = {quantity(force_constant(), positive())},
                  .example = "10 N/A",
                  .description = "Force per current of a linear motor."});
  keys.push_back({.name = "radius",
                  .forms = {quantity(length(), positive())},
                  .example = "8 mm",
                  .description = "Radius of the drum that winds the cable. Only for cables."});
  KeyTable current_sensor =
      *sensor_table("motor-current",
                    "Current of a motor, A: its torque, or tension times drum radius, divided by "
                    "`torque_constant`; or its force divided by `force_constant`.",
                    std::move(keys), {current(), "10 mA", "1 mA", "-5 5 A"});
  current_sensor.alternatives = {{{"torque_constant", "force_constant"}, true}};
  return make_table(std::move(current_sensor));
}

}  // namespace

Form sensor_form() {
  const Said stress_said{stress(), "100 Pa", "10 Pa", "0 100 kPa"};
  const Said volume_said{volume(), "0.1 ml", "0.01 ml", "0 50 ml"};
  return variants(
      "type",
      {{.word = "marker", .description = "Position of a point.", .table = marker_table()},
       {.word = "orientation",
        .description = "Rotation from rest.",
        .table = sensor_table("orientation",
                              "Rotation from rest, (3,) rad: a rotation vector in world axes. "
                              "Errors are added to its components.",
                              frame_keys(), {angle(), "0.5 deg", "0.01 deg", "-180 180 deg"})},
       {.word = "gyroscope",
        .description = "Angular velocity.",
        .table = sensor_table("gyroscope",
                              "Angular velocity in the sensor's axes, (3,) rad/s, mean over a time "
                              "step. The axes are the world axes at rest and turn with the body.",
                              frame_keys(),
                              {angular_speed(), "0.01 rad/s", "1e-3 rad/s", "-35 35 rad/s"})},
       {.word = "accelerometer",
        .description = "Specific force.",
        .table = sensor_table(
            "accelerometer",
            "Acceleration less gravity in the sensor's axes, (3,) m/s^2, mean over a time step. At "
            "rest it points upwards. A quasi-static robot has no acceleration.",
            frame_keys(), {acceleration(), "0.05 m/s^2", "0.01 m/s^2", "-80 80 m/s^2"})},
       {.word = "cable-length",
        .description = "Length of cable pulled out.",
        .table = sensor_table(
            "cable-length",
            "Length of a cable or spring pulled out from rest, m, as measured by an encoder.",
            actuator_keys("long_0"), position())},
       {.word = "cable-tension",
        .description = "Tension of a cable.",
        .table = sensor_table(
            "cable-tension",
            "Tension of a cable or spring at its pull point, N, as measured by a load cell.",
            actuator_keys("long_0"), {force(), "0.05 N", "0.01 N", "0 50 N"})},
       {.word = "pressure",
        .description = "Pressure of a chamber.",
        .table = sensor_table("pressure", "Pressure of a chamber above ambient, Pa.",
                              actuator_keys("air"), stress_said)},
       {.word = "volume",
        .description = "Volume gained by a chamber.",
        .table = sensor_table("volume", "Volume gained by a chamber from rest, m^3.",
                              actuator_keys("air"), volume_said)},
       {.word = "flow",
        .description = "Flow into a chamber.",
        .table = sensor_table("flow",
                              "Flow into a chamber, m^3/s, mean over a time step: volume of its "
                              "gas at ambient pressure, or of its liquid; the rate of change of "
                              "the chamber's volume if it has neither.",
                              actuator_keys("air"),
                              {volume_rate(), "0.1 ml/s", "0.01 ml/s", "-100 100 ml/s"})},
       {.word = "motor-current", .description = "Current of a motor.", .table = current_table()},
       {.word = "stretch",
        .description = "Strain along a line.",
        .table = sensor_table("stretch", "Strain of a line: L/L_0 - 1.", line_keys(true),
                              {plain_number(), "0.001", "1e-4", "-0.5 1"})},
       {.word = "resistance",
        .description = "Resistive strain gauge along a line.",
        .table = resistance_table()},
       {.word = "curvature",
        .description = "Curvature at positions along a line.",
        .table = curvature_table()},
       {.word = "attenuation",
        .description = "Loss of light along a line.",
        .table = attenuation_table()},
       {.word = "capacitance",
        .description = "Two electrodes on a body.",
        .table = capacitance_table()},
       {.word = "contact-force",
        .description = "Normal force of a contact.",
        .table = sensor_table("contact-force", "Sum of the normal forces of a contact, N.",
                              contact_keys(), {force(), "0.05 N", "0.01 N", "0 10 N"})},
       {.word = "touch", .description = "Whether a contact is loaded.", .table = touch_table()}});
}

}  // namespace sinew::scene::forms
