#include "ros1_records.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bag.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/limits.hpp"
#include "fathom/core/text.hpp"

namespace fathom {
namespace {

// The kinds of records that are looked into.
constexpr std::uint8_t kMessage = 2;
constexpr std::uint8_t kIndex = 4;
constexpr std::uint8_t kChunk = 5;
constexpr std::uint8_t kChunkInfo = 6;
constexpr std::uint8_t kConnection = 7;

/// An entry of an index: a time, and where in its chunk the message is.
constexpr std::uint32_t kEntryBytes = 12;
constexpr std::uint32_t kTimeBytes = 8;

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
  /// its records are the next ones. What an index names must be there.
  std::string next() {
    const std::uint64_t begin = position_;
    if (begin >= chunk_end_) records_.push_back(begin);
    std::string header = fields();
    const auto kind = field_number<std::uint8_t>(header, "op=");
    // A connection's data is a header, too.
    if (kind == kConnection) {
      if (begin < chunk_end_) connections_.push_back(begin - chunk_begin_);
      fields();
      return header;
    }
    if (kind == kMessage && begin < chunk_end_) add_message(begin - chunk_begin_);
    const std::uint32_t bytes = length();
    if (kind == kChunk) begin_chunk(begin, header, bytes);
    if (kind == kChunk && is_plain_) return header;
    if (kind == kIndex) return check_index(header, bytes);
    if (kind == kChunkInfo &&
        !std::ranges::binary_search(chunks_, field_number<std::uint64_t>(header, "chunk_pos="))) {
      refuse_index();
    }
    skip(bytes);
    return header;
  }

  /// Whether a record of the file begins there, one of a chunk apart, or the file ends.
  bool has_record_at(std::uint64_t position) const {
    return position == size_ || std::ranges::binary_search(records_, position);
  }

  [[noreturn]] void refuse_index() const {
    throw InputError(path_.string(),
                     "has an index that names what is not there; 'rosbag reindex' makes it anew");
  }

  [[noreturn]] void refuse_chunk(std::uint64_t bytes) const {
    throw InputError(path_.string(), "has a chunk of " + std::to_string(bytes) + " bytes; " +
                                         limit_text(Limit::chunk_bytes));
  }

  [[noreturn]] void refuse_cut() const {
    throw InputError(path_.string(),
                     "is cut short, or was not closed: it ends inside a record or has no index; "
                     "'rosbag reindex' saves what is whole");
  }

 private:
  void begin_chunk(std::uint64_t begin, const std::string& header, std::uint32_t bytes) {
    chunks_.push_back(begin);
    is_plain_ = field(header, "compression=") == "none";
    chunk_begin_ = position_;
    if (is_plain_) chunk_end_ = position_ + bytes;
    messages_.clear();
    connections_.clear();
  }

  // librosbag passes over connections that stand before the message.
  void add_message(std::uint64_t place) {
    messages_.insert(messages_.end(), connections_.begin(), connections_.end());
    messages_.push_back(place);
    connections_.clear();
  }

  // Of the chunk before it. What is compressed is not looked into.
  std::string check_index(const std::string& header, std::uint32_t bytes) {
    const std::uint64_t count = field_number<std::uint32_t>(header, "count=");
    if (count * kEntryBytes != bytes) refuse_index();
    if (!is_plain_) {
      skip(bytes);
      return header;
    }
    position_ += bytes;
    for (std::uint64_t i = 0; i < count; ++i) {
      char entry[kEntryBytes];
      if (!file_.read(entry, sizeof entry)) refuse_cut();
      std::uint32_t offset = 0;
      std::memcpy(&offset, entry + kTimeBytes, sizeof offset);
      if (!std::ranges::binary_search(messages_, offset)) refuse_index();
    }
    return header;
  }

  void skip(std::uint32_t bytes) {
    position_ += bytes;
    file_.seekg(static_cast<std::streamoff>(position_));
  }

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
  std::vector<std::uint64_t> records_;      ///< where they begin, but those of chunks
  std::vector<std::uint64_t> chunks_;       ///< of them the chunks
  bool is_plain_ = false;                   ///< whether the last chunk is not compressed
  std::uint64_t chunk_begin_ = 0;           ///< of its data
  std::uint64_t chunk_end_ = 0;             ///< of the last one that was looked into
  std::vector<std::uint64_t> messages_;     ///< of the last one, where in its data they may be read
  std::vector<std::uint64_t> connections_;  ///< after its last message
};

}  // namespace

void check_ros1_records(const std::filesystem::path& path) {
  Records records(path);
  if (records.is_at_end()) records.refuse_cut();
  // Where librosbag goes on.
  const auto index = field_number<std::uint64_t>(records.next(), "index_pos=");
  if (index == 0) records.refuse_cut();
  while (!records.is_at_end()) {
    const std::string header = records.next();
    if (field_number<std::uint8_t>(header, "op=") != kChunk) continue;
    // What librosbag makes room for, however few bytes it is packed in.
    const auto bytes = field_number<std::uint32_t>(header, "size=");
    if (bytes > value_of(Limit::chunk_bytes)) records.refuse_chunk(bytes);
  }
  if (!records.has_record_at(index)) records.refuse_index();
}

}  // namespace fathom
