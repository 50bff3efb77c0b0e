#include "sinew/core/error.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace sinew {

namespace {

// clang-format off
constexpr std::array kKindNames = {
    "file-not-found", "file-unreadable", "file-unwritable", "unknown-format", "truncated-file",
    "malformed-file", "size-limit", "bad-encoding",
    "syntax-error", "unknown-key", "missing-key", "duplicate-key", "wrong-type", "unknown-choice",
    "unknown-name", "not-in-this-version", "unsupported-version", "empty-list", "conflicting-keys",
    "wrong-dimension", "unknown-unit", "not-a-number", "not-finite", "out-of-range",
    "contradictory-limits", "wrong-length", "bad-signal", "non-monotonic-time",
    "index-out-of-range", "duplicate-node", "zero-volume", "inverted-element",
    "repeated-node-in-element", "disconnected-mesh", "no-volume-elements", "non-finite-node",
    "suspicious-unit", "point-outside-mesh", "unknown-set", "empty-region", "everything-fixed",
    "nothing-fixed", "surface-not-closed", "self-crossing", "unsupported-element",
    "invalid-material", "missing-mass", "wrong-element",
    "too-few-points", "degenerate-cable", "wrong-actuator-type", "actuator-owned", "no-actuators",
    "no-effectors", "degenerate-orientation", "infeasible-limits",
    "malformed-table", "wrong-columns",
    "diverged", "inverted-in-run", "not-converged", "singular-matrix", "recording-failed",
    "state-version", "state-mismatch", "state-corrupt",
    "unknown-option", "bad-argument", "wrong-shape", "tool-missing", "tool-failed",
    "address-in-use", "not-driving",
    "internal"};
// clang-format on
static_assert(kKindNames.size() == static_cast<std::size_t>(ErrorKind::internal) + 1);

std::string compose(ErrorKind kind, const Location& place, const std::string& message,
                    const std::string& remedy) {
  std::string text = place.text();
  if (!text.empty()) text += ": ";
  text += message;
  if (!remedy.empty()) text += "; " + remedy;
  return text + fmt::format(" [{}]", error_kind_name(kind));
}

char lower(char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); }

}  // namespace

std::string_view error_kind_name(ErrorKind kind) {
  return kKindNames.at(static_cast<std::size_t>(kind));
}

int error_kind_count() { return static_cast<int>(kKindNames.size()); }

std::string Location::text() const {
  std::string text = file;
  if (line > 0) text += fmt::format(":{}", line);
  if (line > 0 && column > 0) text += fmt::format(":{}", column);
  if (!item.empty()) text += (text.empty() ? "" : ": ") + item;
  return text;
}

Error::Error(ErrorKind kind, Location place, std::string message, std::string remedy)
    : std::runtime_error(compose(kind, place, message, remedy)),
      kind_(kind),
      place_(std::move(place)),
      message_(std::move(message)),
      remedy_(std::move(remedy)) {}

Error Error::at(const Location& outer) const {
  Location place = place_;
  if (place.file.empty()) {
    place.file = outer.file;
    place.line = outer.line;
    place.column = outer.column;
  }
  if (place.item.empty()) place.item = outer.item;
  return {kind_, place, message_, remedy_};
}

bool Error::is_run_failure() const {
  switch (kind_) {
    case ErrorKind::diverged:
    case ErrorKind::inverted_in_run:
    case ErrorKind::not_converged:
    case ErrorKind::singular_matrix:
    case ErrorKind::recording_failed:
    case ErrorKind::tool_failed:
    case ErrorKind::internal:
      return true;
    default:
      return false;
  }
}

int edit_distance(std::string_view a, std::string_view b) {
  const std::size_t columns = b.size() + 1;
  std::vector<int> before(columns), previous(columns), current(columns);
  for (std::size_t j = 0; j < columns; ++j) previous[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    current[0] = static_cast<int>(i);
    for (std::size_t j = 1; j < columns; ++j) {
      const int substitution = previous[j - 1] + (lower(a[i - 1]) != lower(b[j - 1]) ? 1 : 0);
      current[j] = std::min({previous[j] + 1, current[j - 1] + 1, substitution});
      const bool swapped = i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) &&
                           lower(a[i - 2]) == lower(b[j - 1]);
      if (swapped) current[j] = std::min(current[j], before[j - 2] + 1);
    }
    std::swap(before, previous);
    std::swap(previous, current);
  }
  return previous[columns - 1];
}

}  // namespace sinew
