#include "sinew/record/run_table.hpp"

namespace sinew::record {

namespace {

// The columns of a table with numbers, or those with words, which are the last ones.
std::vector<std::size_t> columns(const sim::Observables& observables, TableKind table, bool words) {
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < observables.list().size(); ++k) {
    const run::Observable& one = observables.list()[k];
    if (is_in_table(one, table) && one.words.empty() != words) chosen.push_back(k);
  }
  return chosen;
}

std::vector<std::string> headings(const sim::Observables& observables,
                                  const std::vector<std::size_t>& numbers,
                                  const std::vector<std::size_t>& words) {
  std::vector<std::string> names;
  for (const auto* chosen : {&numbers, &words}) {
    for (const std::size_t k : *chosen) {
      for (std::string& heading : headings_of(observables.list()[k])) {
        names.push_back(std::move(heading));
      }
    }
  }
  return names;
}

}  // namespace

RunTable::RunTable(const std::filesystem::path& path, sim::Observables& observables,
                   TableKind table)
    : observables_(observables),
      numbers_(columns(observables, table, false)),
      words_(columns(observables, table, true)),
      writer_(path, headings(observables, numbers_, words_)) {}

void RunTable::write() {
  row_.clear();
  row_words_.clear();
  for (const std::size_t k : numbers_) {
    const std::span<const double> values = observables_.read(k);
    row_.insert(row_.end(), values.begin(), values.end());
  }
  for (const std::size_t k : words_) row_words_.push_back(observables_.word(k));
  writer_.write_row(row_, row_words_);
}

}  // namespace sinew::record
