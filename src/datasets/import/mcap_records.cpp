// The container by its specification: https://mcap.dev/spec

#include "mcap_records.hpp"

#include <algorithm>
#include <bit>
#include <boost/crc.hpp>
#include <fstream>

#include "bag.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/limits.hpp"
#include "mcap_chunk.hpp"
#include "ros2_file.hpp"

namespace fathom {
namespace {

static_assert(std::endian::native == std::endian::little, "records of MCAP are little-endian");

using namespace std::string_view_literals;
constexpr std::string_view kMcapMagic = "\x89MCAP0\r\n"sv;

// The other kinds of records that are looked into.
constexpr std::uint8_t kMcapHeader = 1;
constexpr std::uint8_t kMcapFooter = 2;
constexpr std::uint8_t kMcapChunk = 6;
constexpr std::uint8_t kMcapDataEnd = 15;

constexpr std::uint64_t kBeginBytes = 1 + sizeof(std::uint64_t);  // of a record: kind and length
constexpr std::uint64_t kDataEndBytes = kBeginBytes + 4;
constexpr std::uint64_t kFooterBytes = kBeginBytes + 20;

bool is_handed_over(std::uint8_t kind) {
  return kind >= static_cast<std::uint8_t>(McapKind::schema) &&
         kind <= static_cast<std::uint8_t>(McapKind::message);
}

class McapReader {
 public:
  using Take = std::function<void(McapKind, McapFields)>;

  McapReader(const std::filesystem::path& path, bool is_checked, const Take& take)
      : place_{path.string()},
        file_(path, std::ios::binary),
        size_(std::filesystem::file_size(path)),
        is_checked_(is_checked),
        take_(take) {}

  void read() {
    read_end();
    is_summed_ = is_checked_ && data_sum_ != 0;
    seek(0);
    if (next(kMcapMagic.size()) != kMcapMagic) refuse_cut();
    place_.position = position_;
    if (position_ == data_end_ || read_record() != kMcapHeader) place_.refuse("header");
    while (position_ < data_end_) {
      place_.position = position_;
      read_record();
    }
    require_sum(data_sum_, "data");
  }

 private:
  // Footer and end of the data are where they are counted from the end of the file.
  void read_end() {
    const std::uint64_t least =
        kMcapMagic.size() + kDataEndBytes + kFooterBytes + kMcapMagic.size();
    if (size_ < least) refuse_cut();
    const std::uint64_t footer_at = size_ - kMcapMagic.size() - kFooterBytes;
    seek(footer_at);
    const std::string end(next(kFooterBytes + kMcapMagic.size()));
    McapFields footer(end, place_);
    const auto kind = footer.number<std::uint8_t>();
    const auto length = footer.number<std::uint64_t>();
    const auto summary_at = footer.number<std::uint64_t>();
    footer.number<std::uint64_t>();  // of an index of the summary
    const auto summary_sum = footer.number<std::uint32_t>();
    if (kind != kMcapFooter || length + kBeginBytes != kFooterBytes ||
        footer.rest() != kMcapMagic) {
      refuse_cut();
    }
    const std::uint64_t begin = summary_at == 0 ? footer_at : summary_at;
    if (begin < kMcapMagic.size() + kDataEndBytes || begin > footer_at) refuse_cut();
    is_summed_ = is_checked_ && summary_sum != 0;
    if (is_summed_) {
      seek(begin);
      pass_over(footer_at + kFooterBytes - sizeof summary_sum - begin);
      require_sum(summary_sum, "summary");
    }
    data_end_ = begin - kDataEndBytes;
    read_data_end();
  }

  void read_data_end() {
    seek(data_end_);
    place_.position = data_end_;
    McapFields end(next(kDataEndBytes), place_);
    const auto kind = end.number<std::uint8_t>();
    const auto length = end.number<std::uint64_t>();
    if (kind != kMcapDataEnd || length + kBeginBytes != kDataEndBytes) place_.refuse("end of data");
    data_sum_ = end.number<std::uint32_t>();
  }

  // The next record of the data; its kind.
  std::uint8_t read_record() {
    if (data_end_ - position_ < kBeginBytes) place_.refuse("record");
    McapFields begin(next(kBeginBytes), place_);
    const auto kind = begin.number<std::uint8_t>();
    const auto length = begin.number<std::uint64_t>();
    if (length > data_end_ - position_) place_.refuse("record");
    if (kind != kMcapChunk && !is_handed_over(kind)) {
      pass_over(length);
      return kind;
    }
    require_size("record", length);
    const McapFields record(next(length), place_);
    if (kind == kMcapChunk) {
      read_chunk(record);
    } else {
      take_(static_cast<McapKind>(kind), record);
    }
    return kind;
  }

  void read_chunk(McapFields chunk) {
    chunk.bytes(2 * sizeof(std::uint64_t));  // times
    const auto size = chunk.number<std::uint64_t>();
    const auto sum = chunk.number<std::uint32_t>();
    const std::string compression = chunk.text();
    const auto packed_size = chunk.number<std::uint64_t>();
    const std::string_view packed = chunk.bytes(packed_size);
    require_size("chunk", size);
    const auto records = unpacked_chunk(place_.file, compression, packed, size, room_);
    if (!records) place_.refuse("chunk");
    if (is_checked_ && sum != 0) {
      boost::crc_32_type records_sum;
      records_sum.process_bytes(records->data(), records->size());
      if (records_sum.checksum() != sum) place_.refuse("chunk", "its checksum does not agree");
    }
    McapFields rest(*records, place_);
    while (!rest.rest().empty()) {
      const auto kind = rest.number<std::uint8_t>();
      const auto length = rest.number<std::uint64_t>();
      const std::string_view record = rest.bytes(length);
      if (is_handed_over(kind)) take_(static_cast<McapKind>(kind), McapFields(record, place_));
    }
  }

  void seek(std::uint64_t position) {
    position_ = position;
    file_.seekg(static_cast<std::streamoff>(position));
    sum_.reset();
  }

  // The next bytes, valid until more are read.
  std::string_view next(std::uint64_t bytes) {
    buffer_.resize(bytes);
    if (!file_.read(buffer_.data(), static_cast<std::streamsize>(bytes))) refuse_cut();
    position_ += bytes;
    if (is_summed_) sum_.process_bytes(buffer_.data(), buffer_.size());
    return buffer_;
  }

  void pass_over(std::uint64_t bytes) {
    constexpr std::uint64_t kBlock = 65536;
    if (!is_summed_) return seek(position_ + bytes);
    for (std::uint64_t left = bytes; left > 0; left -= std::min(left, kBlock)) {
      next(std::min(left, kBlock));
    }
  }

  // Of all that was read since the last seek.
  void require_sum(std::uint32_t wanted, const char* what) const {
    if (!is_summed_ || sum_.checksum() == wanted) return;
    throw InputError(place_.file,
                     std::string("is damaged: the checksum of its ") + what + " does not agree");
  }

  void require_size(const char* what, std::uint64_t bytes) const {
    if (bytes <= value_of(Limit::chunk_bytes)) return;
    throw InputError(place_.file, std::string("has a ") + what + " of " + std::to_string(bytes) +
                                      " bytes; " + limit_text(Limit::chunk_bytes));
  }

  [[noreturn]] void refuse_cut() const {
    throw InputError(place_.file,
                     "is cut short, or was not closed: its end is no end of an MCAP file; "
                     "'mcap recover' saves what is whole");
  }

  McapPlace place_;
  std::ifstream file_;
  std::uint64_t size_;
  bool is_checked_;
  bool is_summed_ = false;  ///< what is read now
  const Take& take_;
  std::uint64_t position_ = 0;
  std::uint64_t data_end_ = 0;
  std::uint32_t data_sum_ = 0;
  boost::crc_32_type sum_;
  std::string buffer_;  ///< of the record
  std::string room_;    ///< of the chunk, unpacked
};

}  // namespace

void McapPlace::refuse(const std::string& what, const std::string& why) const {
  throw InputError(file, "has a damaged " + what + ", " + std::to_string(position) +
                             " bytes behind its beginning" + (why.empty() ? "" : ": " + why));
}

std::string_view McapFields::bytes(std::uint64_t size) {
  if (size > rest_.size()) place_.refuse("record");
  const std::string_view taken = rest_.substr(0, size);
  rest_.remove_prefix(size);
  return taken;
}

bool is_mcap(const std::filesystem::path& path) {
  std::string begin(kMcapMagic.size(), '\0');
  std::ifstream(path, std::ios::binary)
      .read(begin.data(), static_cast<std::streamsize>(begin.size()));
  return begin == kMcapMagic;
}

void read_mcap_records(const std::filesystem::path& path, bool is_checked,
                       const std::function<void(McapKind, McapFields)>& take) {
  McapReader(path, is_checked, take).read();
}

}  // namespace fathom
