#include "src/report/chart_frame.hpp"

#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "report/placed_texts.hpp"
#include "src/report/chart_legend.hpp"
#include "src/report/scaled_unit.hpp"
#include "src/report/text_layout.hpp"

namespace fathom {
namespace {

using test::expect_tidy;
using test::texts_of;
using ::testing::ElementsAre;

constexpr PageSize kPage{252.0, 140.0};

std::vector<PlacedText> drawn(const ChartAxis& x, const ChartAxis& y) {
  return texts_of(kPage, [&](Canvas& canvas) {
    ChartFrame(x, y, {4.0, 4.0, kPage.width - 8.0, kPage.height - 8.0}).draw(canvas);
  });
}

std::vector<std::string> labels_of(const ChartAxis& axis) {
  std::vector<std::string> labels;
  for (const auto& [value, text] : axis.ticks) labels.push_back(text);
  return labels;
}

// Every kind of range, on either axis.
TEST(ChartFrame, NoLabelRunsIntoAnotherOrATitle) {
  const std::vector<std::vector<double>> ranges{
      {},         {0.00008},         {-0.00008, 0.00003}, {3e7},           {-2e9, 1e9},
      {0.0},      {5.0, 5.0},        {1e-300, 2e-300},    {1e300, -1e300}, {4e6, 4e6 + 1e-3},
      {12345.67}, {-999.9, -999.99}, {1e-9, 1e9},         {0.1, 30.0},     {1.0, 1.0 + 1e-15}};
  for (const auto& values : ranges) {
    for (const char* unit : {"m", "rad", "ms", "bytes", "px", ""}) {
      const AxisTitle title{"mean position error over all the trials of a study", unit};
      for (const ChartAxis& axis : {axis_over(title, values, true), axis_over(title, values, false),
                                    logarithmic_axis_over(title, values)}) {
        ASSERT_TRUE(std::isfinite(axis.low) && axis.low < axis.high);
        SCOPED_TRACE(axis.title + ", " + std::to_string(values.size()));
        const std::vector<PlacedText> texts = drawn(axis, axis);
        EXPECT_GE(texts.size(), 3U);  // both titles at least
        expect_tidy(texts, kPage);
      }
    }
  }
}

TEST(ChartFrame, LongLabelsAreShortenedRatherThanLeftOut) {
  const std::vector<std::string> names{std::string(300, 'a'), "b", std::string(80, 'c'), "d"};
  const ChartAxis x = labelled_axis("axis", {0.0, 1.0, 2.0, 3.0}, names, 0.2);
  const std::vector<PlacedText> texts = drawn(x, axis_over({"y", "m"}, {1.0}, true));
  expect_tidy(texts, kPage);
  std::set<char> starts;
  for (const PlacedText& text : texts) starts.insert(text.text.front());
  for (const char letter : {'a', 'b', 'c', 'd'}) EXPECT_TRUE(starts.contains(letter)) << letter;
}

// Of a sweep, and of squares of a narrow map: on end or smaller.
TEST(ChartFrame, NoLabelOfAPlaceIsLeftOut) {
  const std::vector<std::string> names{"0",     "0.002", "0.005", "0.01", "0.02",
                                       "0.05",  "0.1",   "0.15",  "0.2",  "0.25",
                                       "0.251", "0.252", "0.253", "0.254"};
  std::vector<double> values;
  std::vector<double> places;
  for (const std::string& name : names) {
    places.push_back(static_cast<double>(values.size()));
    values.push_back(std::stod(name));
  }
  for (const auto& positions : {values, places}) {
    const ChartAxis axis = labelled_axis("axis", positions, names, 0.04);
    const ChartAxis up = labelled_axis("up", places, names, 0.04);
    const std::vector<PlacedText> texts = drawn(axis, up);
    expect_tidy(texts, kPage);
    for (const std::string& name : names) {
      EXPECT_EQ(std::ranges::count(texts, name, &PlacedText::text), 2) << name;
    }
  }
}

TEST(ChartFrame, OfManyPlacesEverySecondOrThirdIsLabelled) {
  std::vector<std::string> names;
  std::vector<double> places;
  for (int i = 0; i < 90; ++i) {
    names.push_back(std::to_string(1000 + i));
    places.push_back(i);
  }
  const ChartAxis axis = labelled_axis("axis", places, names, 0.5);
  const std::vector<PlacedText> texts = drawn(axis, axis_over({"y", "m"}, {1.0}, true));
  expect_tidy(texts, kPage);
  const auto labels = std::ranges::count_if(
      texts, [](const PlacedText& one) { return one.text.size() == 4 && one.text[0] == '1'; });
  EXPECT_GE(labels, 30);
  EXPECT_LE(labels, 45);
}

TEST(ChartAxis, OfAGeometricSweepIsLogarithmic) {
  EXPECT_TRUE(are_geometric({0.1, 0.002, 0.005, 0.01, 0.02, 0.05}));
  EXPECT_TRUE(are_geometric({0.1, 1.0}));
  EXPECT_FALSE(are_geometric({5.0, 10.0, 20.0}));  // less than a decade
  EXPECT_FALSE(are_geometric({1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0}));
  EXPECT_FALSE(are_geometric({0.0, 0.1, 1.0, 10.0}));
  EXPECT_FALSE(are_geometric({1.0, 50.0, 100.0}));
  EXPECT_FALSE(are_geometric({}));
  const ChartAxis axis = labelled_axis("noise", {0.01, 0.1, 1.0}, {"a", "b", "c"}, 0.1);
  EXPECT_NEAR(axis.share(0.1), 0.5, 1e-12);
  EXPECT_NEAR(axis.share(0.01), 0.1 / 1.2, 1e-12);
}

TEST(ChartAxis, TakesAPrefixThatMakesTheTicksEasyToRead) {
  const ChartAxis small = axis_over({"error", "m"}, {0.00008}, true);
  EXPECT_EQ(small.title, "error (µm)");
  EXPECT_THAT(labels_of(small), ElementsAre("0", "20", "40", "60", "80"));
  EXPECT_NEAR(small.ticks.back().first, 0.00008, 1e-12);  // positions stay in metres
  const ChartAxis usual = axis_over({"error", "m"}, {0.8}, true);
  EXPECT_EQ(usual.title, "error (m)");
  EXPECT_THAT(labels_of(usual), ElementsAre("0.0", "0.2", "0.4", "0.6", "0.8"));
  EXPECT_EQ(axis_over({"ratio", ""}, {0.00008}, true).title, "ratio (× 10⁻⁶)");
  EXPECT_EQ(axis_over({"keyframe", ""}, {0.0, 3500.0}, false).title, "keyframe");
  EXPECT_EQ(logarithmic_axis_over({"time", "ms"}, {0.0002, 0.004}).title, "time (µs)");
  const ChartAxis wide = logarithmic_axis_over({"cost", ""}, {1e-9, 1e3});
  EXPECT_EQ(wide.title, "cost");
  EXPECT_EQ(labels_of(wide).front(), "10⁻⁹");
}

TEST(ScaledUnit, IsAUnitOfTheField) {
  const auto text = [](const char* unit, double greatest) {
    const ScaledUnit scaled = scaled_unit(unit, greatest);
    return std::to_string(std::lround(greatest * scaled.factor)) + " " + scaled.text;
  };
  EXPECT_EQ(text("m", 0.004), "4 mm");
  EXPECT_EQ(text("m", 3e-8), "30 nm");
  EXPECT_EQ(text("m", 2.0), "2 m");
  EXPECT_EQ(text("m", 9000.0), "9000 m");
  EXPECT_EQ(text("m", 25000.0), "25 km");
  EXPECT_EQ(text("m", 3e9), "3000000 km");
  EXPECT_EQ(text("rad", 0.0005), "500 µrad");
  EXPECT_EQ(text("rad", 0.003), "3 mrad");
  EXPECT_EQ(text("rad", 30000.0), "30000 rad");
  EXPECT_EQ(text("ms", 0.002), "2 µs");
  EXPECT_EQ(text("ms", 5.0), "5 ms");
  EXPECT_EQ(text("ms", 90000.0), "90 s");
  EXPECT_EQ(text("bytes", 2e6), "2 MB");
  EXPECT_EQ(text("bytes", 300.0), "300 bytes");
  EXPECT_EQ(text("px", 0.002), "2 × 10⁻³ px");
  EXPECT_EQ(text("", 4e7), "40 × 10⁶");
  EXPECT_EQ(text("m", 0.0), "0 m");
}

TEST(TextLayout, ShortensByWholeCharacters) {
  EXPECT_EQ(shortened("short", 7.5, 100.0), "short");
  const std::string cut = shortened(std::string(50, 'm') + "ééé", 7.5, 60.0);
  EXPECT_TRUE(cut.ends_with("m…")) << cut;
  EXPECT_LE(text_width(cut, 7.5), 60.0);
  EXPECT_GT(text_width(cut, 7.5), 60.0 - text_width("m", 7.5));
  std::string accents;
  for (int i = 0; i < 40; ++i) accents += "é";
  EXPECT_EQ(shortened(accents, 7.5, 60.0).size() % 2, 1U);  // whole é's and three bytes of "…"
  EXPECT_EQ(shortened("anything", 7.5, 0.0), "…");
}

TEST(TextLayout, WrapsAtBlanks) {
  const std::vector<std::string> lines =
      wrapped("one two three " + std::string(90, 'w'), 6.0, 40.0);
  ASSERT_GE(lines.size(), 3U);
  for (const std::string& line : lines) EXPECT_LE(text_width(line, 6.0), 40.0) << line;
  EXPECT_TRUE(wrapped("", 6.0, 40.0).empty());
}

TEST(ChartLegend, TakesTheRowsThatItNeeds) {
  std::vector<LegendEntry> entries;
  for (int i = 0; i < 12; ++i) {
    entries.push_back(line_entry(std::string(static_cast<std::size_t>(i * i), 'n') + "!", {}));
  }
  const ChartLegend legend(entries, 200.0);
  EXPECT_GT(legend.height(), ChartLegend({entries[0]}, 200.0).height());
  EXPECT_EQ(ChartLegend({}, 200.0).height(), 0.0);
  const PageSize page{200.0, legend.height()};
  const auto texts = texts_of(page, [&](Canvas& canvas) { legend.draw(canvas, {0.0, 0.0}); });
  EXPECT_EQ(texts.size(), 12U);
  expect_tidy(texts, page);
}

}  // namespace
}  // namespace fathom
