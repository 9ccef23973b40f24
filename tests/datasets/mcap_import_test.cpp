// Bags of ROS 2 as MCAP: the same folder as of SQLite, and one line for each that is damaged.

#include <algorithm>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bag_fixture.hpp"
#include "fathom/core/files.hpp"

namespace fathom {
namespace {

namespace fs = std::filesystem;

using test::input_error_of;
using test::mcap_bag_writer;
using test::McapLayout;
using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;

class McapImport : public ::testing::Test {
 protected:
  void SetUp() override { FATHOM_REQUIRE_FEATURE("fastcdr"); }

  // Every file of the folder that comes of a bag, with its content; `and_report` is what was said.
  std::map<std::string, std::string> imported(const fs::path& bag, std::string* report = nullptr) {
    const fs::path out = folder_ / "out";
    fs::remove_all(out);
    const ImportReport said = import_bag(bag, {}, out);
    if (report != nullptr) {
      for (const std::string& line : said.facts) *report += line + "\n";
    }
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(out)) {
      if (entry.is_regular_file()) {
        files[fs::relative(entry.path(), out).string()] = read_file(entry.path());
      }
    }
    return files;
  }

  std::string survey_bag(const std::string& name, const McapLayout& layout) const {
    test::write_survey_bag(survey_, *mcap_bag_writer(folder_ / name, layout));
    return folder_ / name;
  }

  // Of one message of a type that nobody imports.
  std::string small_bag(const McapLayout& layout) const {
    const fs::path bag = folder_ / "small.mcap";
    mcap_bag_writer(bag, layout)->word("/chatter", {test::kBegin, test::kBegin}, "hello");
    return read_file(bag);
  }

  std::string refusal(const std::string& content) const {
    const fs::path bag = folder_ / "bad.mcap";
    std::ofstream(bag, std::ios::binary) << content;
    return input_error_of([&] { bag_topic_list(bag, {}); });
  }

  SimulatedSurvey survey_{test::small_survey(), 2};
  test::TemporaryFolder folder_;
};

TEST_F(McapImport, TheFolderIsThatOfSqlite) {
  test::write_survey_bag(survey_, *test::ros2_bag_writer(folder_ / "a.db3"));
  std::string said_of_sqlite;
  const auto expected = imported(folder_ / "a.db3", &said_of_sqlite);
  std::vector<McapLayout> layouts{
      {}, {.is_chunked = false}, {.has_sums = false, .has_summary = false}};
  if (feature("compression").is_built) {
    layouts.push_back({.compression = "lz4"});
    layouts.push_back({.compression = "zstd"});
  }
  for (std::size_t i = 0; i < layouts.size(); ++i) {
    std::string said;
    EXPECT_EQ(imported(survey_bag(std::to_string(i) + ".mcap", layouts[i]), &said), expected) << i;
    EXPECT_EQ(said, said_of_sqlite) << i;
  }
  if (feature("compression").is_built) {
    EXPECT_LT(fs::file_size(folder_ / "4.mcap"), fs::file_size(folder_ / "0.mcap"));
  }
}

TEST_F(McapImport, FolderOfTheRecorder) {
  const fs::path bag = folder_ / "bag";
  fs::create_directories(bag);
  test::write_survey_bag(survey_, *mcap_bag_writer(bag / "bag_0.mcap"));
  EXPECT_EQ(import_kind(bag), ImportKind::ros2_bag);
  const auto without = imported(bag);
  write_file(bag / "metadata.yaml",
             "rosbag2_bagfile_information: {storage_identifier: mcap, relative_file_paths: "
             "[bag_0.mcap]}\n");
  EXPECT_EQ(imported(bag), without);
}

// Half a bag would look like a whole one.
TEST_F(McapImport, EveryCutIsRefused) {
  for (const bool is_chunked : {true, false}) {
    const std::string whole = small_bag({.is_chunked = is_chunked});
    EXPECT_THAT(refusal(whole), "(nothing thrown)");
    for (std::size_t size = 8; size < whole.size(); ++size) {
      ASSERT_THAT(refusal(whole.substr(0, size)), HasSubstr("mcap recover")) << size;
    }
  }
}

TEST_F(McapImport, EveryFlippedByteIsRefused) {
  for (const bool is_chunked : {true, false}) {
    const std::string whole = small_bag({.is_chunked = is_chunked});
    for (std::size_t at = 0; at < whole.size(); ++at) {
      std::string damaged = whole;
      damaged[at] = static_cast<char>(~damaged[at]);
      const std::string why = refusal(damaged);
      ASSERT_THAT(
          why, AllOf(HasSubstr("bad.mcap"), Not(HasSubstr("nothing thrown")), Not(HasSubstr("\n"))))
          << at;
    }
  }
}

// Nor does any do harm where no checksum tells.
TEST_F(McapImport, FlippedBytesWithoutChecksumsAreReadOrRefused) {
  std::vector<std::string> compressions{""};
  if (feature("compression").is_built) compressions = {"", "lz4", "zstd"};
  for (const std::string& compression : compressions) {
    const std::string whole = small_bag({.compression = compression, .has_sums = false});
    for (std::size_t at = 0; at < whole.size(); ++at) {
      for (const char byte : {'\0', '\x7f', '\xff'}) {
        std::string damaged = whole;
        damaged[at] = byte;
        ASSERT_THAT(refusal(damaged), AnyOf(HasSubstr("bad.mcap"), HasSubstr("nothing thrown")))
            << at;
      }
    }
  }
}

TEST_F(McapImport, TheChecksumSaysWhatIsDamaged) {
  const std::string whole = small_bag({});
  std::string chunk = whole;
  ++chunk[whole.find("hello")];
  EXPECT_THAT(refusal(chunk), AllOf(HasSubstr("damaged chunk, "), HasSubstr("checksum")));
  std::string data = whole;
  ++data[whole.find("aaaa")];
  EXPECT_THAT(refusal(data), HasSubstr("the checksum of its data"));
  std::string summary = whole;
  ++summary[whole.rfind("/chatter")];
  EXPECT_THAT(refusal(summary), HasSubstr("the checksum of its summary"));
}

// A chunk that says it is larger than any is not made room for.
TEST_F(McapImport, ChunksHaveALimit) {
  std::string whole = small_bag({.has_sums = false});
  constexpr std::uint64_t kTooMuch = 128'000'001;
  // Kind, length and two times are before the size; the chunk follows the attachment.
  const std::size_t at = whole.rfind(std::string(100, 'a')) + 100 + 9 + 16;
  whole.replace(at, sizeof kTooMuch, reinterpret_cast<const char*>(&kTooMuch), sizeof kTooMuch);
  EXPECT_THAT(refusal(whole),
              AllOf(HasSubstr("chunk of 128000001 bytes"), HasSubstr("limit is 128000000")));
}

TEST_F(McapImport, CompressionThatIsNotUnpackedNamesTheConversion) {
  EXPECT_THAT(
      refusal(small_bag({.compression = "xz"})),
      AllOf(HasSubstr("compressed by 'xz', expected lz4 or zstd"), HasSubstr("ros2 bag convert")));
  if (feature("compression").is_built) return;
  EXPECT_THAT(refusal(small_bag({.compression = "zstd"})),
              AllOf(HasSubstr("liblz4-dev libzstd-dev"), HasSubstr("ros2 bag convert")));
}

}  // namespace
}  // namespace fathom
