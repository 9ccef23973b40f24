#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "fathom/core/files.hpp"
#include "fathom/report/study_report.hpp"
#include "report/study_fixture.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::test {

/// The report.html of a store.
inline std::string page_of(const ResultStore& store) {
  const TemporaryFolder folder;
  write_study_report(store, folder / "out");
  return read_file(folder / "out" / "report.html");
}

/// The JSON text that stands in the page under this id.
inline std::string element_of(const std::string& page, const std::string& id) {
  const std::string opening = "<script type=\"application/json\" id=\"" + id + "\">";
  const std::size_t begin = page.find(opening) + opening.size();
  return page.substr(begin, page.find("</script>", begin) - begin);
}

/// What the page draws.
inline nlohmann::json data_of_page(const std::string& page) {
  return nlohmann::json::parse(element_of(page, "data"));
}

/// What the page of a made-up study draws.
inline nlohmann::json data_of(const FixtureOptions& options) {
  const TemporaryFolder folder;
  write_fixture(folder.path(), options);
  return data_of_page(page_of(ResultStore::open(folder.path())));
}

}  // namespace fathom::test
