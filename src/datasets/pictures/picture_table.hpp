#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace fathom {

/// A CSV file with a row for each picture, in their order, that begins with its file name. Lines
/// that begin with # are comments. Throws InputError with file and line.
class PictureTable {
 public:
  PictureTable(const std::filesystem::path& csv, const std::string& columns,
               const std::vector<std::filesystem::path>& pictures);

  std::size_t columns(std::size_t row) const { return rows_[row].fields.size(); }
  /// A finite number.
  double real(std::size_t row, std::size_t column) const;
  [[noreturn]] void refuse(std::size_t row, const std::string& what) const;

 private:
  struct Row {
    std::size_t line = 0;
    std::vector<std::string> fields;
  };

  std::string file_;
  std::vector<Row> rows_;
};

}  // namespace fathom
