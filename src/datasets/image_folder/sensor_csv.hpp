#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace fathom {

/// One row of a sensor's `data.csv`: a time stamp and its fields.
struct SensorRow {
  std::size_t line = 0;  ///< in the file, from 1
  std::int64_t time_ns = 0;
  std::vector<std::string> fields;  ///< the time stamp's is the first
};

/// A sensor's `data.csv` of the ASL layout: comma-separated, `#` opens a comment line, the first
/// column is an integer time stamp in ns that rises from row to row.
class SensorCsv {
 public:
  /// Rows must have at least as many columns as `columns` (comma-separated names) has names. Throws
  /// InputError with file and line; also on a file without rows.
  SensorCsv(std::filesystem::path path, std::string columns);

  const std::vector<SensorRow>& rows() const { return rows_; }
  const std::filesystem::path& path() const { return path_; }

  /// A field as a finite number. Throws InputError with file and line.
  double real(const SensorRow& row, std::size_t column) const;

  /// Throws InputError with the file and the row's line.
  [[noreturn]] void refuse(const SensorRow& row, const std::string& what) const;

 private:
  void add_row(std::string_view text, std::size_t line, std::size_t column_count);

  std::filesystem::path path_;
  std::string columns_;
  std::vector<SensorRow> rows_;
};

}  // namespace fathom
