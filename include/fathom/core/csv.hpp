#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace fathom {

inline constexpr std::size_t kMostCsvColumns = 1000;

struct CsvRow {
  std::size_t line = 0;  ///< in the file, from 1
  std::vector<std::string> fields;
};

/// The names in a list of columns that commas part: "p_x" of "P_x [m]" and of EuRoC's
/// "p_RS_R_x [m]"; empty for prose.
std::vector<std::string> names_of_columns(std::string_view columns);

/// A file of comma-separated values; lines that begin with # are comments. What is no such file is
/// refused with the line and what it looks like: fields parted otherwise, decimal commas, UTF-16,
/// lines that end in CR alone; so is what goes beyond the limits. A comment line before a row, of
/// as many fields, names its columns: where it has a name of the expected ones elsewhere, the file
/// is refused, too. Units and the frames of EuRoC's names (p_RS_R_x) do not count.
class CsvFile {
 public:
  /// A row has the columns named, and may have all of `more` or what a comment line before it
  /// names; names are parted by commas. Throws InputError.
  CsvFile(std::filesystem::path path, std::string columns, const std::string& more = "");

  const std::vector<CsvRow>& rows() const { return rows_; }
  const std::filesystem::path& path() const { return path_; }

  /// A field as a finite number. Throws InputError with file and line.
  double real(const CsvRow& row, std::size_t column) const;

  /// Throws InputError with file and line.
  [[noreturn]] void refuse(const CsvRow& row, const std::string& what) const;

 private:
  void take_header(std::size_t line, std::string_view text);
  void require_columns(const CsvRow& row, std::string_view text) const;

  std::filesystem::path path_;
  std::string columns_;
  std::size_t least_;
  std::size_t with_more_;
  std::vector<std::string> names_;  ///< of the columns expected, `more` included
  struct Header {
    std::size_t line = 0;
    std::string misplaced;  ///< the first name that is elsewhere; empty: none
  };
  std::map<std::size_t, Header> headers_;  ///< of the comment lines so far, by their fields
  std::vector<CsvRow> rows_;
};

}  // namespace fathom
