#include "sinew/record/run_layout.hpp"

#include <fmt/format.h>

namespace sinew::record {

std::string dataset_of(const sim::Observable& observable) {
  const auto in = [&](const char* folder) {
    return fmt::format("/{}/{}/{}", folder, observable.owner, observable.quantity);
  };
  switch (observable.kind) {
    case sim::ObservableKind::time:
      return "/time";
    case sim::ObservableKind::body:
      return fmt::format("/{}/{}", observable.quantity, observable.owner);
    case sim::ObservableKind::actuator:
      return in("actuators");
    case sim::ObservableKind::effector:
      return in("effectors");
    case sim::ObservableKind::probe:
      return in("probes");
    case sim::ObservableKind::sensor:
      return in("sensors");
    case sim::ObservableKind::contact_point:
      return in("contacts");
    case sim::ObservableKind::contact:
      return in("contact_resultants");
    case sim::ObservableKind::joint:
      return in("joints");
    case sim::ObservableKind::estimator:
      return in("estimators");
    case sim::ObservableKind::controller:
      if (!observable.owner.empty()) return in("controller");
      break;
    case sim::ObservableKind::energy:
    case sim::ObservableKind::ledger:
      return "/energy/" + observable.name;
    case sim::ObservableKind::report:
    case sim::ObservableKind::status:
      break;
    case sim::ObservableKind::timing:
      return {};
  }
  return "/report/" + observable.name;
}

bool is_state(const sim::Observable& observable) {
  return observable.kind == sim::ObservableKind::body ||
         observable.kind == sim::ObservableKind::contact_point;
}

bool is_in_table(const sim::Observable& observable, TableKind table) {
  if (observable.kind == sim::ObservableKind::time) return true;
  if (is_state(observable) || observable.kind == sim::ObservableKind::timing) return false;
  if (observable.kind == sim::ObservableKind::probe) return table == TableKind::probes;
  if (observable.kind == sim::ObservableKind::sensor) return table == TableKind::sensors;
  return table == TableKind::run;
}

std::vector<std::string> headings_of(const sim::Observable& observable) {
  std::vector<std::string> headings;
  for (const std::string& name : observable.components) {
    headings.push_back(observable.unit.empty() ? name
                                               : fmt::format("{} [{}]", name, observable.unit));
  }
  return headings;
}

std::string meaning_of(const sim::Observable& observable) {
  std::string meaning;
  for (const sim::StatusWord& one : observable.words) {
    meaning += fmt::format("{}{} {}", meaning.empty() ? "" : ", ", one.code, one.word);
  }
  return meaning;
}

}  // namespace sinew::record
