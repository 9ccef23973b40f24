// MCAP as its specification has it (https://mcap.dev/spec), with what a reader may meet: a header,
// metadata and an attachment that nobody asks for, chunks with an index behind each, and a summary.

#include <boost/crc.hpp>
#include <cstring>
#include <fstream>
#include <map>

#include "support/bags/ros2_sink.hpp"

#ifdef FATHOM_COMPRESSION
#include <lz4frame.h>
#include <zstd.h>
#endif

namespace fathom::test {
namespace {

const std::string kMagic("\x89MCAP0\r\n", 8);

class Fields {
 public:
  template <class Number>
  Fields& number(Number value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    return *this;
  }
  Fields& text(const std::string& value) {
    return number(static_cast<std::uint32_t>(value.size())).raw(value);
  }
  Fields& raw(const std::string& value) {
    bytes_ += value;
    return *this;
  }
  const std::string& bytes() const { return bytes_; }
  std::string record(std::uint8_t kind) const {
    Fields all;
    return all.number(kind).number(std::uint64_t{bytes_.size()}).raw(bytes_).bytes();
  }

 private:
  std::string bytes_;
};

std::uint32_t sum_of(const std::string& bytes) {
  boost::crc_32_type sum;
  sum.process_bytes(bytes.data(), bytes.size());
  return sum.checksum();
}

std::string packed(const std::string& bytes, const std::string& compression) {
  std::string room;
#ifdef FATHOM_COMPRESSION
  if (compression == "lz4") {
    room.resize(LZ4F_compressFrameBound(bytes.size(), nullptr));
    room.resize(LZ4F_compressFrame(room.data(), room.size(), bytes.data(), bytes.size(), nullptr));
    return room;
  }
  if (compression == "zstd") {
    room.resize(ZSTD_compressBound(bytes.size()));
    room.resize(ZSTD_compress(room.data(), room.size(), bytes.data(), bytes.size(), 1));
    return room;
  }
#endif
  return compression.empty() ? bytes : room;
}

class McapSink : public Ros2Sink {
 public:
  McapSink(std::filesystem::path path, McapLayout layout)
      : path_(std::move(path)), layout_(std::move(layout)) {
    data_ = kMagic + Fields().text("ros2").text("the test's own").record(1);
    data_ += Fields().text("rosbag2").text("").record(12);
    data_ += Fields().raw(std::string(100, 'a')).record(9);
  }

  ~McapSink() override {
    end_chunk();
    data_ += Fields().number(layout_.has_sums ? sum_of(data_) : 0U).record(15);
    const std::uint64_t summary_at = data_.size();
    std::string summary = channels_;
    summary += Fields().number(std::uint64_t{messages_}).raw(std::string(38, '\0')).record(11);
    if (!layout_.has_summary) summary.clear();
    const std::string footer =
        Fields().number(layout_.has_summary ? summary_at : 0).number(std::uint64_t{0}).bytes();
    // The sum ends before itself.
    summary += Fields().raw(footer).raw(std::string(4, '\0')).record(2);
    summary.resize(summary.size() - 4);
    summary += Fields().number(layout_.has_sums ? sum_of(summary) : 0U).bytes();
    std::ofstream(path_, std::ios::binary) << data_ << summary << kMagic;
  }

  void write(const std::string& topic, const std::string& type, std::int64_t record_ns,
             const std::vector<std::uint8_t>& cdr) override {
    const auto id = static_cast<std::uint16_t>(ids_.size() + 1);
    const auto [entry, is_new] = ids_.emplace(topic, id);
    if (is_new) {
      const std::string schema =
          Fields().number(id).text(type).text("ros2msg").text("uint8 unread").record(3);
      const std::string channel =
          Fields().number(id).number(id).text(topic).text("cdr").text("").record(4);
      chunk_ += schema + channel;
      channels_ += schema + channel;
    }
    Fields message;
    message.number(entry->second).number(std::uint32_t{0}).number(record_ns).number(record_ns);
    message.raw({reinterpret_cast<const char*>(cdr.data()), cdr.size()});
    chunk_ += message.record(5);
    ++messages_;
    if (messages_ % layout_.messages_in_chunk == 0) end_chunk();
  }

 private:
  void end_chunk() {
    if (layout_.is_chunked && !chunk_.empty()) {
      const std::string records = packed(chunk_, layout_.compression);
      Fields chunk;
      chunk.number(std::uint64_t{0}).number(std::uint64_t{0}).number(std::uint64_t{chunk_.size()});
      chunk.number(layout_.has_sums ? sum_of(chunk_) : 0U).text(layout_.compression);
      data_ += chunk.number(std::uint64_t{records.size()}).raw(records).record(6);
      data_ += Fields().number(std::uint16_t{1}).number(std::uint32_t{0}).record(7);
    } else {
      data_ += chunk_;
    }
    chunk_.clear();
  }

  std::filesystem::path path_;
  McapLayout layout_;
  std::string data_;
  std::string chunk_;
  std::string channels_;
  std::size_t messages_ = 0;
  std::map<std::string, std::uint16_t> ids_;
};

}  // namespace

std::unique_ptr<Ros2Sink> mcap_sink(const std::filesystem::path& path, const McapLayout& layout) {
  return std::make_unique<McapSink>(path, layout);
}

}  // namespace fathom::test
