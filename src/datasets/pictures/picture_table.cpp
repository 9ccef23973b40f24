#include "picture_table.hpp"

#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"

namespace fathom {

PictureTable::PictureTable(const std::filesystem::path& csv, const std::string& columns,
                           const std::vector<std::filesystem::path>& pictures,
                           const std::string& more)
    : file_(csv, columns, more) {
  const auto& rows = file_.rows();
  for (std::size_t row = 0; row < rows.size(); ++row) {
    if (row >= pictures.size()) refuse(row, "there are only " + std::to_string(row) + " pictures");
    const std::string name = pictures[row].filename().string();
    if (rows[row].fields.front() != name) {
      refuse(row, "is of " + in_quotes(rows[row].fields.front()) + ", expected the next picture, " +
                      in_quotes(name) + ": a row for each, in their order");
    }
  }
  if (rows.size() < pictures.size()) {
    throw InputError(csv.string(), "has no row for " + pictures[rows.size()].filename().string() +
                                       "; expected rows of " + columns);
  }
}

}  // namespace fathom
