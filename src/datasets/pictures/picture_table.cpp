#include "picture_table.hpp"

#include <algorithm>

#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"

namespace fathom {

PictureTable::PictureTable(const std::filesystem::path& csv, const std::string& columns,
                           const std::vector<std::filesystem::path>& pictures)
    : file_(csv.string()) {
  const std::size_t least = split_csv(columns).size();
  const std::string content = read_text(csv);
  std::size_t line = 0;
  for (std::size_t begin = 0; begin < content.size();) {
    const std::size_t end = std::min(content.find('\n', begin), content.size());
    const std::string_view text = trim({content.data() + begin, end - begin});
    begin = end + 1;
    ++line;
    if (text.empty() || text.front() == '#') continue;
    const auto fields = split_csv(text);
    const std::size_t row = rows_.size();
    rows_.push_back({line, {fields.begin(), fields.end()}});
    if (row >= pictures.size()) refuse(row, "there are only " + std::to_string(row) + " pictures");
    const std::string name = pictures[row].filename().string();
    if (fields.front() != name) {
      refuse(row, "is of " + in_quotes(fields.front()) + ", expected the next picture, " +
                      in_quotes(name) + ": a row for each, in their order");
    }
    if (fields.size() < least) refuse(row, "expected the columns " + columns);
  }
  if (rows_.size() < pictures.size()) {
    throw InputError(file_, "has no row for " + pictures[rows_.size()].filename().string() +
                                "; expected rows of " + columns);
  }
}

double PictureTable::real(std::size_t row, std::size_t column) const {
  const auto value = parse_real(rows_[row].fields[column]);
  if (!value) refuse(row, in_quotes(rows_[row].fields[column]) + " is not a finite number");
  return *value;
}

void PictureTable::refuse(std::size_t row, const std::string& what) const {
  throw InputError(file_, rows_[row].line, what);
}

}  // namespace fathom
