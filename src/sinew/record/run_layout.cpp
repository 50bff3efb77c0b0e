#include "sinew/record/run_layout.hpp"

#include <fmt/format.h>

namespace sinew::record {

std::string dataset_of(const run::Observable& observable) {
  const auto in = [&](const char* folder) {
    return fmt::format("/{}/{}/{}", folder, observable.owner, observable.quantity);
  };
  switch (observable.kind) {
    case run::ObservableKind::time:
      return "/time";
    case run::ObservableKind::body:
      return fmt::format("/{}/{}", observable.quantity, observable.owner);
    case run::ObservableKind::actuator:
      return in("actuators");
    case run::ObservableKind::effector:
      return in("effectors");
    case run::ObservableKind::probe:
      return in("probes");
    case run::ObservableKind::sensor:
      return in("sensors");
    case run::ObservableKind::contact_point:
      return in("contacts");
    case run::ObservableKind::contact:
      return in("contact_resultants");
    case run::ObservableKind::joint:
      return in("joints");
    case run::ObservableKind::estimator:
      return in("estimators");
    case run::ObservableKind::controller:
      if (!observable.owner.empty()) return in("controller");
      break;
    case run::ObservableKind::energy:
    case run::ObservableKind::ledger:
      return "/energy/" + observable.name;
    case run::ObservableKind::report:
    case run::ObservableKind::status:
      break;
    case run::ObservableKind::timing:
      return {};
  }
  return "/report/" + observable.name;
}

bool is_state(const run::Observable& observable) {
  return observable.kind == run::ObservableKind::body ||
         observable.kind == run::ObservableKind::contact_point;
}

bool is_in_table(const run::Observable& observable, TableKind table) {
  if (observable.kind == run::ObservableKind::time) return true;
  if (is_state(observable) || observable.kind == run::ObservableKind::timing) return false;
  if (observable.kind == run::ObservableKind::probe) return table == TableKind::probes;
  if (observable.kind == run::ObservableKind::sensor) return table == TableKind::sensors;
  return table == TableKind::run;
}

std::vector<std::string> headings_of(const run::Observable& observable) {
  std::vector<std::string> headings;
  for (const std::string& name : observable.components) {
    headings.push_back(observable.unit.empty() ? name
                                               : fmt::format("{} [{}]", name, observable.unit));
  }
  return headings;
}

std::string meaning_of(const run::Observable& observable) {
  std::string meaning;
  for (const run::StatusWord& one : observable.words) {
    meaning += fmt::format("{}{} {}", meaning.empty() ? "" : ", ", one.code, one.word);
  }
  return meaning;
}

}  // namespace sinew::record
