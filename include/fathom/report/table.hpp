#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fathom {

/// A plain table for a terminal: a header, a rule and rows, columns two blanks apart. A column
/// whose every cell is a number, a dash or empty is set to the right, header and all; others to the
/// left. Units stand in the header: "update median (ms)".
class Table {
 public:
  explicit Table(std::vector<std::string> header);

  /// Throws InputError unless there is one cell per column.
  void add_row(std::vector<std::string> cells);

  /// Lines that end in '\n', without blanks at their ends.
  std::string text() const;

 private:
  std::vector<std::string> header_;
  std::vector<std::vector<std::string>> rows_;
};

/// How many terminal cells a UTF-8 text takes: 0 for combining marks, 2 for East Asian wide
/// characters and emoji, 1 for others; a byte that is not UTF-8 takes 1.
std::size_t display_width(std::string_view text);

/// A number with so many significant digits, trailing zeros kept: 0.08100, 12.35, 12346. Whole
/// digits are never rounded away up to 1e7; beyond, and below 1e-4, it has an exponent: 5.827e+07.
/// NaN and infinity are "nan", "inf" and "-inf".
std::string format_number(double value, int significant_digits);

/// As above, or "-" where there is none.
std::string format_number(const std::optional<double>& value, int significant_digits);

}  // namespace fathom
