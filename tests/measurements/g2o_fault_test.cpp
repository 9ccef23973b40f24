#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/files.hpp"
#include "fathom/core/random.hpp"
#include "fathom/measurements/g2o.hpp"
#include "support/input_error.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using test::input_error_of;
using testing::HasSubstr;

struct Fault {
  std::string name;
  std::string text;
  std::string place;   ///< how the message opens
  std::string remedy;  ///< what it says
};

// Names the case where one fails.
void PrintTo(const Fault& fault, std::ostream* out) {
  *out << fault.name;
}

const std::string kGood =
    "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\nEDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n";

class G2oFault : public testing::TestWithParam<Fault> {};

TEST_P(G2oFault, IsRefusedInOneLineWithFileAndLine) {
  const Fault& fault = GetParam();
  const std::string message = input_error_of([&] { parse_g2o(fault.text, "graph.g2o"); });
  EXPECT_THAT(message, testing::StartsWith("graph.g2o:" + fault.place));
  EXPECT_THAT(message, HasSubstr(fault.remedy));
  EXPECT_EQ(message.find('\n'), std::string::npos);
  EXPECT_LT(message.size(), 300U);
}

INSTANTIATE_TEST_SUITE_P(
    Lines, G2oFault,
    testing::Values(
        Fault{"truncated_vertex", kGood + "VERTEX_SE2 2 1 0", "4: ", "(4 values), got 3"},
        Fault{"long_vertex", kGood + "VERTEX_SE2 2 1 0 0 0", "4: ", "(4 values), got 5"},
        Fault{"truncated_edge", kGood + "EDGE_SE2 0 1 1 0 0 1 0 0 1 0",
              "4: ", "(11 values), got 10"},
        Fault{"long_edge", kGood + "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1 7", "4: ", "got 12"},
        Fault{"bare_edge", kGood + "EDGE2", "4: ", "EDGE2 takes i j x y theta"},
        Fault{"three_dimensional", kGood + "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1",
              "4: ", "unknown tag 'VERTEX_SE3:QUAT'; a 2-D graph has VERTEX_SE2"},
        Fault{"lower_case", kGood + "edge_se2 0 1 1 0 0 1 0 0 1 0 1", "4: ", "'edge_se2'"},
        Fault{"long_row", kGood + "EDGE_SE2" + std::string(2 << 20, ' ') + "0 1 1 0 0 1 0 0 1 0 1",
              "4: ", "has more than a mebibyte"},
        Fault{"long_tag", kGood + std::string(100'000, 'x'), "4: ", "unknown tag 'xxxx"},
        Fault{"control_bytes", kGood + "\x1b[2J\x07", "4: ", "unknown tag '?[2J?'"},
        Fault{"nan_vertex", kGood + "VERTEX_SE2 2 nan 0 0", "4: ", "'nan' is not a finite number"},
        Fault{"nan_edge", kGood + "EDGE_SE2 0 1 1 0 NaN 1 0 0 1 0 1", "4: ", "'NaN' is not"},
        Fault{"infinite", kGood + "EDGE_SE2 0 1 inf 0 0 1 0 0 1 0 1", "4: ", "'inf' is not"},
        Fault{"too_large", kGood + "EDGE_SE2 0 1 1e999 0 0 1 0 0 1 0 1", "4: ", "'1e999' is not"},
        Fault{"nan_information", kGood + "EDGE_SE2 0 1 1 0 0 nan 0 0 1 0 1", "4: ", "'nan' is not"},
        Fault{"not_a_number", kGood + "EDGE_SE2 0 1 1,5 0 0 1 0 0 1 0 1", "4: ", "'1,5' is not"},
        Fault{"two_signs", kGood + "EDGE_SE2 0 1 +-1 0 0 1 0 0 1 0 1", "4: ", "'+-1' is not"},
        Fault{"real_id", kGood + "VERTEX_SE2 2.0 1 0 0", "4: ", "'2.0' is not an id"},
        Fault{"negative_id", kGood + "VERTEX_SE2 -2 1 0 0", "4: ", "'-2' is not an id"},
        Fault{"id_too_large", kGood + "VERTEX_SE2 9223372036854775808 1 0 0", "4: ", "not an id"},
        Fault{"zero_information", kGood + "EDGE_SE2 0 1 1 0 0 0 0 0 0 0 0",
              "4: ", "not positive definite"},
        Fault{"indefinite", kGood + "EDGE_SE2 0 1 1 0 0 1 2 0 1 0 1",
              "4: ", "not positive definite"},
        Fault{"singular", kGood + "EDGE_SE2 0 1 1 0 0 1 1 0 1 0 1", "4: ", "not positive definite"},
        Fault{"negative_information", kGood + "EDGE_SE2 0 1 1 0 0 -1 0 0 1 0 1",
              "4: ", "not positive definite"},
        Fault{"toro_order_misread", kGood + "EDGE2 0 1 1 0 0 1 0 0 1 0 1",
              "4: ", "not positive definite"},
        Fault{"to_itself", kGood + "EDGE_SE2 1 1 1 0 0 1 0 0 1 0 1", "4: ", "pose 1 to itself"},
        Fault{"twice_defined", kGood + "VERTEX_SE2 1 1 0 0", "4: ", "defined on line 2 already"},
        Fault{"fix_without_id", kGood + "FIX", "4: ", "FIX without an id"},
        Fault{"fix_of_text", kGood + "FIX zero", "4: ", "'zero' is not an id"},
        Fault{"fix_of_another", kGood + "FIX 1", "4: ", "only the lowest id (0)"},
        Fault{"fix_of_several", kGood + "FIX 0 1", "4: ", "only the lowest id (0)"},
        Fault{"undefined_vertex", kGood + "EDGE_SE2 1 2 1 0 0 1 0 0 1 0 1",
              "4: ", "refers to vertex 2, which the file does not define"}),
    [](const auto& test) { return test.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Graphs, G2oFault,
    testing::Values(
        Fault{"lonely_vertex", kGood + "VERTEX_SE2 5 1 0 0", "4: ",
              "2 components, which no edge and no prior joins (1: 2 poses, 0 to 1; 2: 1 pose, 5)"},
        Fault{"two_components", "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\nEDGE_SE2 7 8 1 0 0 1 0 0 1 0 1",
              "2: ", "(1: 2 poses, 0 to 1; 2: 2 poses, 7 to 8), with borders at 1|7"},
        Fault{"empty", "", " ", "no vertex and no edge"},
        Fault{"only_comments", "# a\n\n  # b\n", " ", "no vertex and no edge"},
        Fault{"only_fix", "FIX 0\n", " ", "no vertex and no edge"}),
    [](const auto& test) { return test.param.name; });

TEST(G2oFaultFile, WhatIsNoFile) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(input_error_of([&] { read_g2o(folder.path()); }),
              HasSubstr(folder.path().string() + ": is a folder, not a file"));
  EXPECT_THAT(input_error_of([&] { read_g2o(folder / "none.g2o"); }),
              HasSubstr("none.g2o: cannot be opened"));
  write_file(folder / "empty.g2o", "");
  EXPECT_THAT(input_error_of([&] { read_g2o(folder / "empty.g2o"); }),
              HasSubstr("empty.g2o: holds no pose graph"));
}

// Anything may come in: it is read, or refused as bad input; any other exception fails the test.
void expect_read_or_refused(const std::string& text) {
  try {
    const MeasurementLog log = parse_g2o(text, "fuzz");
    EXPECT_EQ(to_g2o(parse_g2o(to_g2o(log), "again")), to_g2o(log));
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
  }
}

TEST(G2oFuzz, RandomBytes) {
  RandomStream random(1, "fuzz");
  std::string text(1 << 20, ' ');
  for (char& byte : text) byte = static_cast<char>(random.index(256));
  EXPECT_THROW(parse_g2o(text, "fuzz"), InputError);
  for (std::size_t begin = 0; begin < text.size(); begin += 997) {
    expect_read_or_refused(text.substr(begin, 997));
  }
}

TEST(G2oFuzz, MutatedGraph) {
  const std::string good =
      kGood +
      "FIX 0\nEDGE_SE2 1 0 -1 0 0 5 1 0 5 0 9\nVERTEX_SE2 2 2 0 1\n"
      "EDGE_SE2 1 2 1 0 1 2 0 0 2 0 2\n# inliers 5\nEDGE2 0 2 2 0 1 4 0 4 4 0 0\n"
      "VERTEX_SE2 3 2 0 1\n# hole 2 3 0 0 0 1 0 0 1 0 1\nEDGE_SE2 1 3 1 0 1 2 0 0 2 0 2\n"
      "# start 0.25 0 0 0.25 0 0.5\nEDGE_PRIOR_SE2 0 0 0 0 4 0 0 4 0 2\n"
      "EDGE_PRIOR_SE2_XY 2 1 2 4 1 4\n";
  expect_read_or_refused(good);
  RandomStream random(2, "mutations");
  const std::string alphabet = "0123456789+-.eE# \n\tFIXVERTEX_SE2PORnan";
  for (int round = 0; round < 20'000; ++round) {
    std::string text = good;
    for (std::uint64_t i = 0, n = 1 + random.index(4); i < n; ++i) {
      const std::size_t at = random.index(text.size());
      switch (random.index(4)) {
        case 0:
          text[at] = alphabet[random.index(alphabet.size())];
          break;
        case 1:
          text.erase(at, 1 + random.index(6));
          break;
        case 2:
          text.insert(at, 1, alphabet[random.index(alphabet.size())]);
          break;
        default:
          text.insert(at, text.substr(random.index(text.size()), random.index(40)));
      }
      if (text.empty()) text = " ";
    }
    expect_read_or_refused(text);
  }
}

}  // namespace
}  // namespace fathom
