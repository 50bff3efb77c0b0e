#include <array>
#include <cerrno>
#include <charconv>

#include <fmt/format.h>

#include "sinew/core/csv.hpp"
#include "sinew/core/file.hpp"

namespace sinew {

namespace {

std::string quoted(const std::string& name) {
  if (name.find_first_of(",;\"# \t\r\n") == std::string::npos) return name;
  std::string text = "\"";
  for (const char c : name) text += c == '"' || c == '\r' || c == '\n' ? '\'' : c;
  return text + '"';
}

void append_cells(std::string& text, std::span<const double> values) {
  std::array<char, 32> digits{};
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (k > 0) text += ',';
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), values[k]).ptr;
    text.append(digits.data(), end);
  }
}

void append_names(std::string& text, std::span<const std::string> names) {
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (k > 0) text += ',';
    text += quoted(names[k]);
  }
}

}  // namespace

void append_csv_header(std::string& text, std::span<const std::string> names) {
  append_names(text, names);
  text += '\n';
}

void append_csv_row(std::string& text, std::span<const double> values) {
  append_cells(text, values);
  text += '\n';
}

CsvWriter::CsvWriter(const std::filesystem::path& path, std::span<const std::string> names)
    : path_(path.string()),
      file_(std::fopen(path_.c_str(), "wb")),
      columns_(static_cast<int>(names.size())) {
  if (!file_) throw_unwritable(path, errno);
  if (names.empty()) {
    throw Error(ErrorKind::file_unwritable, {.file = path_}, "the table has no columns",
                "give it one");
  }
  append_names(line_, names);
  flush_line();
}

void CsvWriter::write_row(std::span<const double> values) { write_row(values, {}); }

void CsvWriter::write_row(std::span<const double> values, std::span<const std::string_view> words) {
  if (values.size() + words.size() != static_cast<std::size_t>(columns_)) {
    throw Error(ErrorKind::wrong_columns, {.file = path_},
                fmt::format("expected {} columns, got {}", columns_, values.size() + words.size()),
                "write as many values as the header has names");
  }
  append_cells(line_, values);
  for (const std::string_view word : words) {
    if (!line_.empty()) line_ += ',';
    line_ += word;
  }
  flush_line();
}

void CsvWriter::rename(const std::filesystem::path& path) {
  replace_file(path_, path);
  path_ = path.string();
}

void CsvWriter::flush_line() {
  line_ += '\n';
  const std::size_t written = std::fwrite(line_.data(), 1, line_.size(), file_.get());
  const bool good = written == line_.size() && std::fflush(file_.get()) == 0;
  line_.clear();
  if (good) return;
  throw Error(ErrorKind::recording_failed, {.file = path_}, "the row cannot be written",
              "check that the disk is not full; rows before it are on disk");
}

}  // namespace sinew
