#include "ros1_records.hpp"

#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>

#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"

namespace fathom {
namespace {

constexpr std::uint64_t kMostChunkBytes = 1'000'000'000;

class Records {
 public:
  explicit Records(const std::filesystem::path& path)
      : path_(path), file_(path, std::ios::binary), size_(std::filesystem::file_size(path)) {
    std::string version;
    std::getline(file_, version);
    if (version != "#ROSBAG V2.0") {
      throw InputError(path_.string(), "is a bag of version " + in_quotes(version) +
                                           "; expected #ROSBAG V2.0 ('rosbag fix' converts it)");
    }
    position_ = version.size() + 1;
  }

  bool is_at_end() const { return position_ == size_; }

  /// The header of the next record, whose data is passed over.
  std::string next() {
    std::string header(length(), '\0');
    file_.read(header.data(), static_cast<std::streamsize>(header.size()));
    position_ += header.size();
    position_ += length();
    file_.seekg(static_cast<std::streamoff>(position_));
    return header;
  }

  [[noreturn]] void refuse_chunk(std::uint64_t bytes) const {
    throw InputError(path_.string(), "has a chunk of " + std::to_string(bytes) +
                                         " bytes; the limit is " + std::to_string(kMostChunkBytes));
  }

  [[noreturn]] void refuse_cut() const {
    throw InputError(path_.string(),
                     "is cut short, or was not closed: it ends inside a record or has no index; "
                     "'rosbag reindex' saves what is whole");
  }

 private:
  // Of what follows, which must be in the file.
  std::uint32_t length() {
    std::uint32_t value = 0;
    char bytes[sizeof value];
    if (size_ - position_ < sizeof value || !file_.read(bytes, sizeof value)) refuse_cut();
    std::memcpy(&value, bytes, sizeof value);
    position_ += sizeof value;
    if (value > size_ - position_) refuse_cut();
    return value;
  }

  std::filesystem::path path_;
  std::ifstream file_;
  std::uint64_t size_;
  std::uint64_t position_ = 0;
};

// Of a field `name=` and its bytes, in a header of fields each after its length.
template <class Number>
Number field(std::string_view header, std::string_view name) {
  const std::size_t at = header.find(name);
  Number value = 0;
  if (at == std::string_view::npos || header.size() - at - name.size() < sizeof value) return 0;
  std::memcpy(&value, header.data() + at + name.size(), sizeof value);
  return value;
}

}  // namespace

void check_ros1_records(const std::filesystem::path& path) {
  Records records(path);
  if (records.is_at_end() || field<std::uint64_t>(records.next(), "index_pos=") == 0)
    records.refuse_cut();
  while (!records.is_at_end()) {
    const std::string header = records.next();
    constexpr std::uint8_t kChunk = 5;
    if (field<std::uint8_t>(header, "op=") != kChunk) continue;
    // What librosbag makes room for, however few bytes it is packed in.
    const auto bytes = field<std::uint32_t>(header, "size=");
    if (bytes > kMostChunkBytes) records.refuse_chunk(bytes);
  }
}

}  // namespace fathom
