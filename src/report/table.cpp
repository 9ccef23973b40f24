#include "fathom/report/table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fmt/format.h>
#include <utility>

#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "fathom/core/utf8.hpp"

namespace fathom {
namespace {

bool reads_as_number(const std::string& cell) {
  static const std::array<std::string_view, 6> kWords{"", "-", "nan", "inf", "-inf", "–"};
  return parse_real(cell).has_value() ||
         std::find(kWords.begin(), kWords.end(), cell) != kWords.end();
}

struct Block {
  std::uint32_t first;
  std::uint32_t last;
};

bool is_in(std::uint32_t value, const auto& blocks) {
  return std::any_of(blocks.begin(), blocks.end(), [value](const Block& block) {
    return value >= block.first && value <= block.last;
  });
}

// The blocks of Unicode that a terminal draws without advancing, or over two cells.
constexpr std::array<Block, 5> kCombining{
    {{0x0300, 0x036F}, {0x200B, 0x200F}, {0x20D0, 0x20FF}, {0xFE00, 0xFE0F}, {0xFE20, 0xFE2F}}};
constexpr std::array<Block, 8> kWide{{{0x1100, 0x115F},
                                      {0x2E80, 0xA4CF},
                                      {0xAC00, 0xD7A3},
                                      {0xF900, 0xFAFF},
                                      {0xFE30, 0xFE6F},
                                      {0xFF00, 0xFF60},
                                      {0x1F300, 0x1FAFF},
                                      {0x20000, 0x3FFFD}}};

std::string padded(const std::string& cell, std::size_t width, bool right) {
  const std::string blanks(width - display_width(cell), ' ');
  return right ? blanks + cell : cell + blanks;
}

}  // namespace

std::size_t display_width(std::string_view text) {
  std::size_t width = 0;
  while (!text.empty()) {
    const CodePoint point = first_code_point(text);
    if (!is_in(point.value, kCombining)) width += is_in(point.value, kWide) ? 2 : 1;
    text.remove_prefix(point.bytes);
  }
  return width;
}

Table::Table(std::vector<std::string> header) : header_(std::move(header)) {}

void Table::add_row(std::vector<std::string> cells) {
  if (cells.size() != header_.size()) {
    throw InputError(
        fmt::format("a row of the table has {} cells, not {}", cells.size(), header_.size()));
  }
  rows_.push_back(std::move(cells));
}

std::string Table::text() const {
  std::vector<std::size_t> widths;
  std::vector<bool> right;
  for (std::size_t column = 0; column < header_.size(); ++column) {
    widths.push_back(display_width(header_[column]));
    right.push_back(!rows_.empty());
    for (const auto& row : rows_) {
      widths[column] = std::max(widths[column], display_width(row[column]));
      right[column] = right[column] && reads_as_number(row[column]);
    }
  }
  std::string text;
  const auto add_line = [&](const std::vector<std::string>& cells) {
    std::string line;
    for (std::size_t column = 0; column < cells.size(); ++column) {
      if (column > 0) line += "  ";
      line += padded(cells[column], widths[column], right[column]);
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
  };
  add_line(header_);
  std::vector<std::string> rules;
  rules.reserve(widths.size());
  for (const std::size_t width : widths) rules.emplace_back(width, '-');
  add_line(rules);
  for (const auto& row : rows_) add_line(row);
  return text;
}

std::string format_number(double value, int significant_digits) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "%.*e", significant_digits - 1, value);
  std::string scientific = buffer;
  // The exponent after rounding: 9.9996 with four digits is 10.00.
  const auto exponent = parse_integer(scientific.substr(scientific.find('e') + 1)).value_or(0);
  if (value != 0.0 && (exponent < -4 || exponent >= 7)) return scientific;
  const int decimals = std::max(0, significant_digits - 1 - static_cast<int>(exponent));
  std::snprintf(buffer, sizeof buffer, "%.*f", value == 0.0 ? 0 : decimals, std::abs(value));
  return (value < 0.0 ? "-" : "") + std::string(buffer);
}

std::string format_number(const std::optional<double>& value, int significant_digits) {
  return value ? format_number(*value, significant_digits) : "-";
}

}  // namespace fathom
