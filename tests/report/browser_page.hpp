#pragma once

#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "fathom/report/study_report.hpp"
#include "report/made_mosaic.hpp"
#include "report/study_fixture.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::test {

inline std::string output_of(const std::string& command) {
  FILE* pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) return "";
  std::string text;
  std::array<char, 65536> buffer;
  for (std::size_t got = 0; (got = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
    text.append(buffer.data(), got);
  }
  ::pclose(pipe);
  return text;
}

inline std::string browser() {
  std::string path =
      output_of("command -v chromium || command -v chromium-browser || command -v google-chrome");
  return path.substr(0, path.find('\n'));
}

inline std::string without_entities(std::string text) {
  const std::array<std::pair<std::string, std::string>, 4> entities{
      {{"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&amp;", "&"}}};
  for (const auto& [entity, letter] : entities) {
    for (std::size_t at = 0; (at = text.find(entity, at)) != std::string::npos; ++at) {
      text.replace(at, entity.size(), letter);
    }
  }
  return text;
}

/// A page of a made-up study.
struct SeenPage {
  FixtureOptions options{};
  std::vector<std::string> mosaics{};  ///< estimators that have one; every second with seams
  int width = 1400;

  bool operator==(const SeenPage&) const = default;
};

/// What report.html#selftest says of the page in a real browser; null where the page did not get
/// that far. The browser's time is virtual: a busy machine changes nothing but how long the test
/// takes, and the limit only ends a browser that hangs.
inline nlohmann::json open_page(const SeenPage& seen) {
  const TemporaryFolder folder;
  write_fixture(folder / "study", seen.options);
  for (std::size_t i = 0; i < seen.mosaics.size(); ++i) {
    write_made_mosaic(folder / "study" / seen.mosaics[i], 4.0, 2.0 - static_cast<double>(i), 0.01,
                      i % 2 == 0 ? MosaicBlend::feather : MosaicBlend::seams);
  }
  write_study_report(ResultStore::open(folder / "study"), folder / "out", folder / "study");
  const std::string page = output_of(
      "timeout 800 '" + browser() +
      "' --headless --no-sandbox --disable-gpu --disable-quic --no-first-run"
      " --disable-background-networking --disable-component-update --disable-sync"
      " --disable-dev-shm-usage --window-size=" +
      std::to_string(seen.width) + ",2000 --user-data-dir='" + (folder / "profile").string() +
      "' --virtual-time-budget=20000 --dump-dom 'file://" +
      (folder / "out" / "report.html").string() + "#selftest' 2>/dev/null");
  const std::string opening = "<pre id=\"selftest\">";
  const std::size_t begin = page.find(opening);
  if (begin == std::string::npos) return nullptr;
  const std::size_t end = page.find("</pre>", begin);
  return nlohmann::json::parse(
      without_entities(page.substr(begin + opening.size(), end - begin - opening.size())));
}

/// The same; a page that several tests look at is opened once: they are one test of CTest.
inline nlohmann::json self_test_of(const SeenPage& page) {
  static std::vector<std::pair<SeenPage, nlohmann::json>> seen;
  for (const auto& [one, result] : seen) {
    if (one == page) return result;
  }
  return seen.emplace_back(page, open_page(page)).second;
}

class Browser : public ::testing::Test {
 protected:
  void SetUp() override {
    if (browser().empty())
      GTEST_SKIP() << "no chromium here to open the page with; 'scripts/setup.sh' installs it";
  }
};

}  // namespace fathom::test
