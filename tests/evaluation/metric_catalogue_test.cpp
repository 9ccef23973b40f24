#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "evaluation/example_run.hpp"

namespace fathom {
namespace {

using ::testing::Contains;

TEST(MetricCatalogue, NamesAreUniqueAndEndWithTheUnit) {
  std::set<std::string> names;
  for (const Metric& metric : metric_catalogue()) {
    EXPECT_TRUE(names.insert(metric.name).second) << metric.name;
    EXPECT_FALSE(metric.label.empty()) << metric.name;
    EXPECT_FALSE(metric.description.empty()) << metric.name;
    const std::string quantity = metric.name.substr(0, metric.name.find('.'));
    const std::string ending = metric.unit.empty() ? "" : "_" + metric.unit;
    EXPECT_TRUE(quantity.ends_with(ending)) << metric.name;
    EXPECT_EQ(metric.is_cost, metric.unit == "ms" || metric.unit == "bytes") << metric.name;
  }
}

TEST(MetricCatalogue, FindsEveryMetricThatARunHas) {
  const test::ExampleRun example;
  for (const auto& [name, value] : test::values_of(example.facts())) {
    const auto metric = find_metric(name);
    ASSERT_TRUE(metric) << name;
    EXPECT_EQ(metric->name, name);
    EXPECT_EQ(metric->value(judge(example.facts())), value) << name;
  }
  EXPECT_EQ(find_metric("rpe_10_keyframes_rad")->label_with_unit(), "RPE over 10 keyframes (rad)");
  EXPECT_EQ(find_metric("rpe_1_keyframes_m")->label_with_unit(), "RPE over 1 keyframe (m)");
  EXPECT_EQ(find_metric("rpe_0.5_m_m")->label_with_unit(), "RPE over 0.5 m (m)");
  EXPECT_EQ(find_metric("relative_anees_1_keyframes")->label_with_unit(), "ANEES over 1 keyframe");
  EXPECT_EQ(find_metric("relative_anees_2.5_m")->label_with_unit(), "ANEES over 2.5 m");
  EXPECT_FALSE(find_metric("relative_anees_x_m"));
  EXPECT_FALSE(find_metric("relative_anees_0_keyframes"));
  for (const char* none : {"", "rpe_", "rpe__m_m", "rpe_x_m_m", "rpe_-1_m_m", "update_ms", "f"}) {
    EXPECT_FALSE(find_metric(none)) << none;
  }
  EXPECT_TRUE(is_cost_metric("update_ms.p95"));
  EXPECT_FALSE(is_cost_metric("updates"));
}

// The first column of the table of metrics names nothing else.
TEST(MetricCatalogue, HasWhatTheDocumentationNames) {
  std::ifstream file(std::string(FATHOM_SOURCE_DIR) + "/docs/studies.md");
  std::stringstream text;
  text << file.rdbuf();
  const std::string page = text.str();
  const std::size_t begin = page.find("| metric | meaning |");
  ASSERT_NE(begin, std::string::npos);
  std::set<std::string> names;
  for (const Metric& metric : metric_catalogue()) names.insert(metric.name);
  std::istringstream lines(page.substr(begin, page.find("\n\n", begin) - begin));
  std::size_t found = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::string column = line.substr(0, line.find('|', 1));
    const std::regex quoted("`([^`]+)`");
    for (std::sregex_iterator it(column.begin(), column.end(), quoted), end; it != end; ++it) {
      EXPECT_THAT(names, Contains((*it)[1].str()));
      ++found;
    }
  }
  EXPECT_GT(found, 20U);
}

}  // namespace
}  // namespace fathom
