#include "ros1_records.hpp"

#include <cstdint>
#include <cstring>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>

#include "bag.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"

namespace fathom {
namespace {

// The kinds of records that are looked into.
constexpr std::uint8_t kChunk = 5;
constexpr std::uint8_t kConnection = 7;

// The value of a field of a header, `name=` and its bytes, each field after its length; empty where
// there is none. Nothing of a header whose fields do not fill it.
std::optional<std::string_view> field(std::string_view header, std::string_view name) {
  std::string_view value;
  while (!header.empty()) {
    std::uint32_t length = 0;
    if (header.size() < sizeof length) return std::nullopt;
    std::memcpy(&length, header.data(), sizeof length);
    header.remove_prefix(sizeof length);
    if (length > header.size()) return std::nullopt;
    const std::string_view one = header.substr(0, length);
    if (one.starts_with(name)) value = one.substr(name.size());
    header.remove_prefix(length);
  }
  return value;
}

template <class Number>
Number field_number(std::string_view header, std::string_view name) {
  const std::string_view bytes = field(header, name).value_or("");
  Number value = 0;
  if (bytes.size() == sizeof value) std::memcpy(&value, bytes.data(), sizeof value);
  return value;
}

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

  /// The header of the next record, whose data is passed over; of a chunk that is not compressed
  /// its records are the next ones.
  std::string next() {
    std::string header = fields();
    const auto kind = field_number<std::uint8_t>(header, "op=");
    // A connection's data is a header, too.
    if (kind == kConnection) {
      fields();
      return header;
    }
    const std::uint32_t bytes = length();
    if (kind == kChunk && field(header, "compression=") == "none") {
      chunk_end_ = position_ + bytes;
      return header;
    }
    position_ += bytes;
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
  // Of what follows, which must be in the file, and of a record of a chunk in that.
  std::uint32_t length() {
    const std::uint64_t end = position_ < chunk_end_ ? chunk_end_ : size_;
    std::uint32_t value = 0;
    char bytes[sizeof value];
    if (end - position_ < sizeof value || !file_.read(bytes, sizeof value)) refuse_cut();
    std::memcpy(&value, bytes, sizeof value);
    position_ += sizeof value;
    if (value > end - position_) refuse_cut();
    return value;
  }

  std::string fields() {
    std::string header(length(), '\0');
    file_.read(header.data(), static_cast<std::streamsize>(header.size()));
    position_ += header.size();
    if (field(header, "op=")) return header;
    throw InputError(path_.string(), "has a record whose header is damaged, " +
                                         std::to_string(position_) + " bytes behind its beginning");
  }

  std::filesystem::path path_;
  std::ifstream file_;
  std::uint64_t size_;
  std::uint64_t position_ = 0;
  std::uint64_t chunk_end_ = 0;  ///< of the chunk that was looked into last
};

}  // namespace

void check_ros1_records(const std::filesystem::path& path) {
  Records records(path);
  if (records.is_at_end() || field_number<std::uint64_t>(records.next(), "index_pos=") == 0)
    records.refuse_cut();
  while (!records.is_at_end()) {
    const std::string header = records.next();
    if (field_number<std::uint8_t>(header, "op=") != kChunk) continue;
    // What librosbag makes room for, however few bytes it is packed in.
    const auto bytes = field_number<std::uint32_t>(header, "size=");
    if (bytes > kMostChunkBytes) records.refuse_chunk(bytes);
  }
}

}  // namespace fathom
