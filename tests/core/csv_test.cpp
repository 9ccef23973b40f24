#include "fathom/core/csv.hpp"

#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/files.hpp"
#include "fathom/core/text.hpp"
#include "support/input_error.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using test::input_error_of;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;

class Csv : public testing::Test {
 protected:
  CsvFile read(const std::string& text, const std::string& more = "") const {
    write_file(folder_ / "data.csv", text);
    return CsvFile(folder_ / "data.csv", "time, altitude", more);
  }
  std::string refusal(const std::string& text, const std::string& more = "") const {
    return input_error_of([&] { read(text, more); });
  }

 private:
  test::TemporaryFolder folder_;
};

TEST_F(Csv, HasItsRowsWithTheirLines) {
  for (const std::string end : {"\n", "\r\n"}) {
    const CsvFile file =
        read("\xEF\xBB\xBF# time, altitude" + end + end + "1, 2.5 " + end + "3,-4" + end);
    ASSERT_EQ(file.rows().size(), 2u);
    EXPECT_THAT(file.rows()[0].fields, ElementsAre("1", "2.5"));
    EXPECT_EQ(file.rows()[0].line, 3u);
    EXPECT_EQ(file.real(file.rows()[1], 1), -4.0);
  }
  EXPECT_TRUE(read("").rows().empty());
  EXPECT_TRUE(read("# no rows\n").rows().empty());
}

TEST_F(Csv, MoreColumnsNeedTheirNames) {
  EXPECT_THAT(refusal("#time,altitude\n0,1.5\n1,2.5,7.25\n"),
              AllOf(HasSubstr("data.csv:3: expected 2 columns time, altitude, got 3"),
                    HasSubstr("names all columns"), EndsWith("'1,2.5,7.25'")));
  EXPECT_EQ(read("#time,altitude,range\n1,2.5,7.25\n").rows()[0].fields.size(), 3u);
  EXPECT_EQ(
      read("# made on a Monday, by hand, in haste, at sea\n#time,altitude,range\n1,2.5,7.25\n")
          .rows()
          .size(),
      1u);
  // Names after a row are none of it.
  EXPECT_THAT(refusal("1,2.5,7.25\n#time,altitude,range\n"), HasSubstr("data.csv:1"));
  EXPECT_THAT(refusal("#time,altitude,range\n1,2.5,7.25,8.5\n"), HasSubstr("got 4"));
  EXPECT_EQ(read("1,2.5,7.25\n", "range").rows()[0].fields.size(), 3u);
  EXPECT_THAT(refusal("1,2.5,7.25\n", "range, gain"), HasSubstr("altitude, or 4, got 3"));
}

TEST_F(Csv, ColumnsThatAHeaderNamesMustBeInPlace) {
  EXPECT_THAT(
      refusal("#time,quality,Altitude [m]\n1,97,2.5\n"),
      EndsWith("data.csv:1: names the columns, and altitude is column 3; expected the order "
               "time, altitude"));
  EXPECT_THAT(refusal("#altitude,time\n2.5,1\n"), HasSubstr(":1: names the columns, and time"));
  EXPECT_THAT(refusal("#time,range,gain\n1,2.5,3\n", "range"), HasSubstr("and range is column"));
  EXPECT_THAT(refusal("#time,range,altitude\n1,2.5,3\n", "range"), HasSubstr("and altitude is"));
  // EuRoC's names have frames; names may be others; prose names nothing.
  for (const std::string header : {"#time [ns], altitude_RS_R [m]", "#t,z [m]", "# 2.5,time",
                                   "# altitude by hand, time of day", "#range,time,altitude"}) {
    const bool is_right = header != "# 2.5,time";
    EXPECT_EQ(refusal(header + "\n1,2.5\n") == "(nothing thrown)", is_right) << header;
  }
}

TEST_F(Csv, NamesAreFoundHoweverTheyAreWritten) {
  for (const char* header :
       {"timestamp,p_x,p_y,step_var_x", "TIMESTAMP [ns],P_X,P_Y,STEP_VAR_X [m^2]",
        "\"timestamp\", \"p_x [m]\",'p_y' [m], step_var_x (m^2)",
        "timestamp/ns,p_x/m,p_y / m,step_var_x/m^2", "timestamp ns,p_x m,P_Y M,step_var_x m^2",
        "timestamp_ns,p_x_m,p_RS_R_y_m,step_var_x", "timestamp,P_RS_R_X,p_WORLD_y,step_var_x"}) {
    EXPECT_THAT(names_of_columns(header), ElementsAre("timestamp", "p_x", "p_y", "step_var_x"))
        << header;
  }
  EXPECT_THAT(names_of_columns("altitude by hand,time sync,x"), ElementsAre("", "", "x"));
  EXPECT_THAT(refusal("#ALTITUDE,TIME\n2.5,1\n"), HasSubstr("and time is column 2"));
  EXPECT_THAT(refusal("#\"altitude\",\"time\"\n2.5,1\n"), HasSubstr("and time is column 2"));
  EXPECT_THAT(refusal("#altitude/m,time/s\n2.5,1\n"), HasSubstr("and time is column 2"));
}

TEST_F(Csv, SaysWhatItLooksLike) {
  EXPECT_THAT(refusal("1,1,62\n"), AllOf(HasSubstr("got 3: decimal commas? expected points;"),
                                         HasSubstr("names all columns"), EndsWith(": '1,1,62'")));
  EXPECT_THAT(refusal("1;1,62\n"), HasSubstr("parted by semicolons? expected commas"));
  EXPECT_THAT(refusal("1;1.62\n"), HasSubstr("got 1: parted by semicolons?"));
  EXPECT_THAT(refusal("1;1,62\n"), Not(HasSubstr("got 2")));
  EXPECT_THAT(refusal("t,altitude\n1,2.5\n"),
              HasSubstr(":1: has no number: 't,altitude'; a line of names begins with #"));
  EXPECT_EQ(read("1;b.png,2\n").rows().size(), 1u);
  EXPECT_THAT(refusal("1\t1.62\n"), HasSubstr("parted by tabs?"));
  EXPECT_THAT(refusal("1 1.62\n"), HasSubstr("parted by blanks?"));
  EXPECT_THAT(refusal("1\n"), EndsWith("got 1: '1'"));
  EXPECT_THAT(refusal("1,2\r2,3\r"), HasSubstr("lines that end in CR alone"));
  EXPECT_THAT(refusal(std::string("\xFF\xFE") + std::string("1\0,\0002\0", 6)),
              HasSubstr("is UTF-16"));
  EXPECT_THAT(refusal(std::string("1\0,\0002\0", 6)), HasSubstr("bytes of zero"));
}

TEST_F(Csv, ShowsWhatIsNotSeenByItsCodePoint) {
  const CsvFile file = read(
      "1,\xC2\xAD"
      "2\n2,\xE2\x88\x92"
      "2\n3,2\xC2\xA0\n");
  const auto refused = [&](std::size_t row) {
    return input_error_of([&] { file.real(file.rows()[row], 1); });
  };
  EXPECT_THAT(refused(0),
              HasSubstr("data.csv:1: '<U+00AD>2' in column 2 of time, altitude is not"));
  EXPECT_THAT(refused(1), HasSubstr("data.csv:2: '<U+2212>2'"));
  EXPECT_THAT(refused(2), HasSubstr("data.csv:3: '2<U+00A0>'"));
}

}  // namespace
}  // namespace fathom
