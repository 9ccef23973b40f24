#include "report/csv_reader.hpp"

#include <stdexcept>

namespace fathom::test {
namespace {

std::vector<std::vector<std::string>> records_of(const std::string& text) {
  std::vector<std::vector<std::string>> records{{""}};
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    std::string& field = records.back().back();
    const char letter = text[i];
    if (quoted && letter == '"' && i + 1 < text.size() && text[i + 1] == '"') {
      field += text[++i];
    } else if (letter == '"') {
      quoted = !quoted;
    } else if (!quoted && letter == ',') {
      records.back().emplace_back();
    } else if (!quoted && letter == '\n') {
      records.push_back({""});
    } else {
      field += letter;
    }
  }
  if (records.back().size() == 1 && records.back().front().empty()) records.pop_back();
  return records;
}

}  // namespace

std::vector<std::map<std::string, std::string>> read_csv(const std::string& text) {
  const auto records = records_of(text);
  std::vector<std::map<std::string, std::string>> rows;
  for (std::size_t i = 1; i < records.size(); ++i) {
    if (records[i].size() != records.front().size()) throw std::runtime_error("uneven row");
    rows.emplace_back();
    for (std::size_t column = 0; column < records[i].size(); ++column) {
      rows.back()[records.front()[column]] = records[i][column];
    }
  }
  return rows;
}

}  // namespace fathom::test
