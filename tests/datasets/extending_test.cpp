// The data set of docs/extending.md, built from the text that stands there.

#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/datasets/data_set.hpp"
#include "support/input_error.hpp"

namespace fathom {

DataSetEntry ring_data_set();

namespace {

using test::input_error_of;
using ::testing::HasSubstr;

std::string content_of(const std::string& file) {
  std::ifstream stream(std::string(FATHOM_SOURCE_DIR) + "/" + file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

TEST(Extending, TheDocumentShowsTheDataSetThatIsBuiltHere) {
  const std::string code = content_of("tests/datasets/ring/ring_data_set.cpp");
  ASSERT_FALSE(code.empty());
  EXPECT_THAT(content_of("docs/extending.md"), HasSubstr("```cpp\n" + code + "```"));
}

TEST(Extending, TheDataSetHasItsOptionsAndOpens) {
  const DataSetEntry entry = ring_data_set();
  EXPECT_EQ(entry.options.size(), 2u);
  EXPECT_TRUE(entry.trial_options.empty());
  const auto ring = entry.open({{"poses", OptionValue::scalar("20")}}, 1);
  ASSERT_NE(ring->graph(), nullptr);
  EXPECT_EQ(ring->frames(), nullptr);
  EXPECT_EQ(ring->graph()->size(), 20u);
  EXPECT_EQ(ring->graph()->registration_count(), 1u);
  EXPECT_LT(chi2(*ring->graph(), ring->graph()->odometry()), 1e-18);
  EXPECT_THAT(input_error_of([&] {
                entry.open({{"poses", OptionValue::scalar("2")}}, 1);
              }),
              HasSubstr("poses: expected a whole number >= 3, got '2'"));
}

}  // namespace
}  // namespace fathom
