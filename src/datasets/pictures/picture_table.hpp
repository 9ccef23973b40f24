#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "fathom/core/csv.hpp"

namespace fathom {

/// A CsvFile with a row for each picture, in their order, that begins with its file name. Throws
/// InputError with file and line.
class PictureTable {
 public:
  PictureTable(const std::filesystem::path& csv, const std::string& columns,
               const std::vector<std::filesystem::path>& pictures, const std::string& more = "");

  std::size_t columns(std::size_t row) const { return file_.rows()[row].fields.size(); }
  /// A finite number.
  double real(std::size_t row, std::size_t column) const {
    return file_.real(file_.rows()[row], column);
  }
  [[noreturn]] void refuse(std::size_t row, const std::string& what) const {
    file_.refuse(file_.rows()[row], what);
  }

 private:
  CsvFile file_;
};

}  // namespace fathom
