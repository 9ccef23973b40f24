#pragma once

#include <concepts>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace fathom {

/// Where in an MCAP file something is wrong.
struct McapPlace {
  std::string file;
  std::uint64_t position = 0;  ///< bytes from the beginning to the record, or to its chunk

  /// Throws InputError: "FILE: has a damaged WHAT, POSITION bytes behind its beginning: WHY".
  [[noreturn]] void refuse(const std::string& what, const std::string& why = "") const;
};

/// The fields of a record, little-endian, in their order. Throws InputError, with the place, where
/// the record ends too early.
class McapFields {
 public:
  McapFields(std::string_view record, const McapPlace& place) : rest_(record), place_(place) {}

  template <std::unsigned_integral Number>
  Number number() {
    Number value = 0;
    std::memcpy(&value, bytes(sizeof value).data(), sizeof value);
    return value;
  }
  std::string_view bytes(std::uint64_t size);
  std::string text() { return std::string(bytes(number<std::uint32_t>())); }

  std::string_view rest() const { return rest_; }
  const McapPlace& place() const { return place_; }

 private:
  std::string_view rest_;
  const McapPlace& place_;
};

/// The records that say what was recorded.
enum class McapKind : std::uint8_t { schema = 3, channel = 4, message = 5 };

/// Hands over those of a file in their order, those of its chunks, unpacked, among them; each is
/// valid during the call alone. With `is_checked` the checksums of the data, of the chunks and of
/// the summary are compared where the file has them. Throws InputError naming the file where it was
/// not closed, a record ends beyond what holds it, or a chunk cannot be unpacked.
void read_mcap_records(const std::filesystem::path& path, bool is_checked,
                       const std::function<void(McapKind, McapFields)>& take);

}  // namespace fathom
