#include "fathom/core/csv.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/limits.hpp"
#include "fathom/core/text.hpp"

namespace fathom {
namespace {

void require_text(const std::filesystem::path& path, std::string_view content) {
  const auto refuse = [&](const std::string& what) { throw InputError(path.string(), what); };
  if (content.starts_with("\xFF\xFE") || content.starts_with("\xFE\xFF")) {
    refuse("is UTF-16; expected UTF-8");
  }
  if (content.find('\0') != std::string_view::npos) {
    refuse("has bytes of zero, as UTF-16 and binary files have; expected UTF-8");
  }
  const bool has_cr = content.find('\r') != std::string_view::npos;
  if (has_cr && content.find('\n') == std::string_view::npos &&
      trim(content).find('\r') != content.npos) {
    refuse("has lines that end in CR alone; expected LF or CR LF");
  }
}

// Before any row is held: each takes more than a hundred bytes, however short it is.
void require_rows(const std::filesystem::path& path, std::string_view content) {
  std::uint64_t left = value_of(Limit::csv_rows);
  for (const auto& [line, text] : lines_of(content)) {
    if (text.front() == '#' || left-- > 0) continue;
    throw InputError(path.string(), line, "has too many rows; " + limit_text(Limit::csv_rows));
  }
}

bool is_whole(std::string_view field) {
  if (field.starts_with('-') || field.starts_with('+')) field.remove_prefix(1);
  return !field.empty() && field.find_first_not_of("0123456789") == std::string_view::npos;
}

// Of a row with too many fields: each number split in two.
bool has_decimal_commas(const CsvRow& row) {
  return std::all_of(row.fields.begin() + 1, row.fields.end(), is_whole);
}

// Numbers parted by semicolons, whose decimal commas may give as many fields as expected.
bool has_semicolons(std::string_view text, std::size_t least) {
  const auto parts = split(text, ";");
  return parts.size() >= least && least > 1 &&
         std::all_of(parts.begin() + 1, parts.end(), [](std::string_view part) {
           return part.find_first_not_of("0123456789+-.,eE \t") == std::string_view::npos;
         });
}

// Of a row with too few: what parts its fields, if it is no comma.
std::string separator_of(std::string_view text) {
  if (text.find(';') != std::string_view::npos) return "semicolons";
  if (text.find('\t') != std::string_view::npos) return "tabs";
  if (text.find(',') == std::string_view::npos && text.find(' ') != std::string_view::npos) {
    return "blanks";
  }
  return {};
}

bool is_capital(char c) {
  return c >= 'A' && c <= 'Z';
}

std::string in_small_letters(std::string_view text) {
  std::string small(text);
  std::ranges::transform(small, small.begin(), [](char c) {
    return is_capital(c) ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return small;
}

bool is_unit(std::string_view word) {
  static constexpr std::array<std::string_view, 12> kUnits{
      "ns", "us", "ms", "s", "m", "mm", "cm", "rad", "deg", "m^2", "rad^2", "m*rad"};
  return std::ranges::find(kUnits, in_small_letters(word)) != kUnits.end();
}

// Of the parts of a name, those before the last. In a name that has no small letters they are
// short: "RS" and "R" of "P_RS_R_X", but not "VAR" of "STEP_VAR_X".
bool is_frame(std::string_view part, bool has_small) {
  return std::ranges::all_of(part, is_capital) && (has_small || part.size() <= 2);
}

std::string name_of_column(std::string_view field) {
  std::string plain(field);
  std::erase_if(plain, [](char c) { return c == '"' || c == '\''; });
  field = trim(plain);
  const auto end = std::min(field.find_first_of(" \t[(/"), field.size());
  const std::string_view unit = trim(field.substr(end));
  if (!unit.empty() && std::string_view("[(/").find(unit.front()) == std::string_view::npos &&
      !is_unit(unit)) {
    return {};
  }
  auto parts = split(field.substr(0, end), "_");
  if (parts.size() > 1 && is_unit(parts.back())) parts.pop_back();
  const bool has_small = std::ranges::any_of(parts, [](std::string_view part) {
    return std::ranges::any_of(part, [](char c) { return c >= 'a' && c <= 'z'; });
  });
  std::string name;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const bool is_between = i > 0 && i + 1 < parts.size();
    if (is_between && is_frame(parts[i], has_small)) continue;
    name += (i == 0 ? "" : "_") + std::string(parts[i]);
  }
  return in_small_letters(name);
}

}  // namespace

std::vector<std::string> names_of_columns(std::string_view columns) {
  std::vector<std::string> names;
  for (const std::string_view field : split_csv(columns)) names.push_back(name_of_column(field));
  return names;
}

CsvFile::CsvFile(std::filesystem::path path, std::string columns, const std::string& more)
    : path_(std::move(path)),
      columns_(std::move(columns)),
      least_(split_csv(columns_).size()),
      with_more_(least_ + (more.empty() ? 0 : split_csv(more).size())),
      names_(names_of_columns(more.empty() ? columns_ : columns_ + "," + more)) {
  const std::string content = read_text(path_);
  require_text(path_, content);
  require_rows(path_, content);
  for (const auto& [line, text] : lines_of(content)) {
    // Told before they are split: each field takes sixteen bytes, however short it is.
    const auto columns_here = static_cast<std::size_t>(std::ranges::count(text, ',')) + 1;
    const bool is_too_wide = columns_here > kMostCsvColumns;
    if (text.front() == '#') {
      if (!is_too_wide) take_header(line, text);
      continue;
    }
    if (is_too_wide) {
      throw InputError(path_.string(), line,
                       "has " + std::to_string(columns_here) + " columns; the limit is " +
                           std::to_string(kMostCsvColumns));
    }
    const auto fields = split_csv(text);
    rows_.push_back({line, {fields.begin(), fields.end()}});
    require_columns(rows_.back(), text);
  }
}

void CsvFile::take_header(std::size_t line, std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of('#'), text.size()));
  const std::vector<std::string> given = names_of_columns(text);
  Header& header = headers_[given.size()];
  for (std::size_t i = 0; i < names_.size() && header.misplaced.empty(); ++i) {
    const auto found = std::ranges::find(given, names_[i]);
    if (found == given.end() || (i < given.size() && given[i] == names_[i])) continue;
    header = {line, names_[i] + " is column " + std::to_string(found - given.begin() + 1)};
  }
}

void CsvFile::require_columns(const CsvRow& row, std::string_view text) const {
  const std::size_t count = row.fields.size();
  const auto header = headers_.find(count);
  const bool is_named = header != headers_.end();
  const auto is_number = [](const std::string& field) { return parse_real(field).has_value(); };
  const bool has_names = std::ranges::none_of(row.fields, is_number) && count > 1;
  if (rows_.size() == 1 && has_names && separator_of(text).empty()) {
    refuse(row, "has no number: " + in_quotes(text) + "; a line of names begins with #, expected " +
                    columns_);
  }
  const bool is_as_expected =
      count == least_ || count == with_more_ || (count > least_ && is_named);
  if (is_as_expected && !has_semicolons(text, least_)) {
    if (!is_named || header->second.misplaced.empty()) return;
    throw InputError(path_.string(), header->second.line,
                     "names the columns, and " + header->second.misplaced +
                         "; expected the order " + joined(names_, ", "));
  }
  std::string what = "expected " + counted(least_, "column") + " " + columns_;
  if (with_more_ > least_) what += ", or " + std::to_string(with_more_);
  if (!is_as_expected) what += ", got " + std::to_string(count);
  if (count < least_ || has_semicolons(text, least_)) {
    const std::string separator = separator_of(text);
    if (!separator.empty()) what += ": parted by " + separator + "? expected commas";
  } else {
    if (has_decimal_commas(row)) what += ": decimal commas? expected points";
    what += "; a first line that begins with # and names all columns says that there are more";
  }
  refuse(row, what + ": " + in_quotes(text));
}

double CsvFile::real(const CsvRow& row, std::size_t column) const {
  const auto value = parse_real(row.fields[column]);
  if (!value) {
    refuse(row, in_quotes(row.fields[column]) + " in column " + std::to_string(column + 1) +
                    " of " + columns_ + " is not a finite number");
  }
  return *value;
}

void CsvFile::refuse(const CsvRow& row, const std::string& what) const {
  throw InputError(path_.string(), row.line, what);
}

}  // namespace fathom
