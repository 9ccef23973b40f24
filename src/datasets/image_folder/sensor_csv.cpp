#include "sensor_csv.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"

namespace fathom {

SensorCsv::SensorCsv(std::filesystem::path path, std::string columns)
    : path_(std::move(path)), columns_(std::move(columns)) {
  const std::string content = read_text(path_);
  const std::size_t column_count = split_csv(columns_).size();
  std::size_t line = 0;
  for (std::size_t begin = 0; begin < content.size();) {
    const std::size_t end = std::min(content.find('\n', begin), content.size());
    const std::string_view text = trim({content.data() + begin, end - begin});
    begin = end + 1;
    ++line;
    if (!text.empty() && text.front() != '#') add_row(text, line, column_count);
  }
  if (rows_.empty()) {
    throw InputError(path_.string(), "has no data; expected rows of " + columns_);
  }
}

void SensorCsv::add_row(std::string_view text, std::size_t line, std::size_t column_count) {
  const auto fields = split_csv(text);
  SensorRow row{line, 0, {fields.begin(), fields.end()}};
  if (fields.size() < column_count) {
    refuse(row,
           fmt::format("expected {} columns {}, got {}", column_count, columns_, fields.size()));
  }
  const auto time_ns = parse_integer(fields.front());
  if (!time_ns) {
    refuse(row,
           "time stamp " + in_quotes(fields.front()) + " is not a whole number of nanoseconds");
  }
  row.time_ns = *time_ns;
  if (!rows_.empty() && row.time_ns <= rows_.back().time_ns) {
    refuse(row, "time stamp " + in_quotes(fields.front()) + " does not come after " +
                    rows_.back().fields.front() + "; rows must be sorted, without repeats");
  }
  rows_.push_back(std::move(row));
}

double SensorCsv::real(const SensorRow& row, std::size_t column) const {
  const auto value = parse_real(row.fields[column]);
  if (!value) {
    refuse(row, fmt::format("{} in column {} of {} is not a finite number",
                            in_quotes(row.fields[column]), column + 1, columns_));
  }
  return *value;
}

void SensorCsv::refuse(const SensorRow& row, const std::string& what) const {
  throw InputError(path_.string(), row.line, what);
}

}  // namespace fathom
