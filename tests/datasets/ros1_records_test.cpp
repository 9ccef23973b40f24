// The lengths of a bag of ROS 1, which librosbag takes on trust.
#include "src/datasets/import/ros1_records.hpp"

#include <cstdint>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/input_error.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using test::input_error_of;
using ::testing::HasSubstr;

std::string with_length(const std::string& bytes, std::uint32_t more = 0) {
  const auto length = static_cast<std::uint32_t>(bytes.size()) + more;
  return std::string(reinterpret_cast<const char*>(&length), sizeof length) + bytes;
}

std::string record(const std::string& header, const std::string& data) {
  return with_length(header) + with_length(data);
}

const std::string kVersion = "#ROSBAG V2.0\n";

std::string bag_header(std::uint64_t index) {
  return record(with_length("op=\x03") +
                    with_length("index_pos=" +
                                std::string(reinterpret_cast<const char*>(&index), sizeof index)),
                "");
}

const std::size_t kFirst = (kVersion + bag_header(0)).size();  ///< where the records begin

const std::string kTopic = with_length("topic=/a");
// Of a field that is said to be ten bytes longer than it is.
const std::string kTooLong = with_length("topic=/a", 10);
const std::string kConnection = with_length("op=\x07") + with_length("topic=/a");

std::string chunk(const std::string& records) {
  return record(with_length("op=\x05") + with_length("compression=none"), records);
}

class Ros1Records : public ::testing::Test {
 protected:
  std::string refusal(const std::string& records, std::uint64_t index = kFirst) const {
    const std::filesystem::path bag = folder_ / "a.bag";
    std::ofstream(bag, std::ios::binary) << kVersion << bag_header(index) << records;
    return input_error_of([&] { check_ros1_records(bag); });
  }

  test::TemporaryFolder folder_;
};

TEST_F(Ros1Records, WholeRecordsPass) {
  EXPECT_EQ(refusal(record(kConnection, kTopic) + chunk(record(kConnection, kTopic))),
            "(nothing thrown)");
}

TEST_F(Ros1Records, AFieldEndsWithinItsHeader) {
  EXPECT_THAT(refusal(record(kTooLong, "")), HasSubstr("header is damaged"));
  EXPECT_THAT(refusal(record(kConnection, kTooLong)), HasSubstr("header is damaged"));
  EXPECT_THAT(refusal(chunk(record(kTooLong, ""))), HasSubstr("header is damaged"));
  EXPECT_THAT(refusal(chunk(record(kConnection, kTooLong))), HasSubstr("header is damaged"));
}

TEST_F(Ros1Records, ARecordOfAChunkEndsWithinIt) {
  EXPECT_THAT(refusal(chunk(with_length(kConnection) + with_length("", 4)) + record(kTopic, "")),
              HasSubstr("cut short"));
}

// librosbag reads connections from there on.
TEST_F(Ros1Records, TheIndexBeginsWithARecord) {
  const std::string inner = chunk(record(kConnection, kTopic));
  const std::string records = inner + record(kConnection, kTopic);
  EXPECT_EQ(refusal(records, kFirst + inner.size()), "(nothing thrown)");
  EXPECT_EQ(refusal(records, kFirst + records.size()), "(nothing thrown)");
  EXPECT_THAT(refusal(records, 0), HasSubstr("has no index"));
  for (const std::uint64_t index : {std::uint64_t{1}, std::uint64_t{kFirst + 1},
                                    std::uint64_t{kFirst + inner.size() - 5}, UINT64_MAX}) {
    EXPECT_THAT(refusal(records, index), HasSubstr("names what is not there")) << index;
  }
}

}  // namespace
}  // namespace fathom
