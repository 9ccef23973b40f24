#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "fathom/core/csv.hpp"

namespace fathom {

/// One row of a sensor's `data.csv`: its first field is a time stamp.
struct SensorRow : CsvRow {
  std::int64_t time_ns = 0;
};

/// A sensor's `data.csv` of the ASL layout: a CsvFile whose first column is an integer time stamp
/// in ns that rises from row to row.
class SensorCsv {
 public:
  /// As CsvFile. Throws InputError with file and line; also on a file without rows.
  /// `time_offset_ns` is added to the time stamps.
  SensorCsv(std::filesystem::path path, const std::string& columns, const std::string& more = "",
            std::int64_t time_offset_ns = 0);

  const std::vector<SensorRow>& rows() const { return rows_; }
  const std::filesystem::path& path() const { return file_.path(); }

  double real(const SensorRow& row, std::size_t column) const { return file_.real(row, column); }
  [[noreturn]] void refuse(const SensorRow& row, const std::string& what) const {
    file_.refuse(row, what);
  }

 private:
  CsvFile file_;
  std::vector<SensorRow> rows_;
};

}  // namespace fathom
