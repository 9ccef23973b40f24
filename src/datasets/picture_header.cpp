#include "picture_header.hpp"

#include <algorithm>
#include <array>
#include <boost/crc.hpp>
#include <cstddef>
#include <cstdlib>

#include "fathom/core/text.hpp"

namespace fathom {
namespace {

using namespace std::string_view_literals;

constexpr auto kPngStart = "\x89PNG\r\n\x1A\n"sv;

// A number of `count` bytes; nothing where the file ends before.
std::optional<std::uint64_t> unsigned_at(std::string_view bytes, std::uint64_t at,
                                         std::size_t count, bool is_big_endian) {
  if (at > bytes.size() || bytes.size() - at < count) return std::nullopt;
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto byte = static_cast<unsigned char>(bytes[at + (is_big_endian ? i : count - 1 - i)]);
    value = (value << 8U) | byte;
  }
  return value;
}

std::optional<HeaderSize> both(std::optional<std::uint64_t> width,
                               std::optional<std::uint64_t> height) {
  if (!width || !height) return std::nullopt;
  return HeaderSize{*width, *height};
}

// The first start of a frame: markers C0 to CF but for those of tables and of arithmetic coding.
std::optional<HeaderSize> size_of_jpeg(std::string_view bytes) {
  for (std::size_t at = 2; at + 4 <= bytes.size();) {
    const auto marker = static_cast<unsigned char>(bytes[at + 1]);
    if (bytes[at] != '\xFF') return std::nullopt;
    if (marker == 0xFF) {
      ++at;  // fill
      continue;
    }
    const bool is_frame =
        marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
    if (is_frame) {
      return both(unsigned_at(bytes, at + 7, 2, true), unsigned_at(bytes, at + 5, 2, true));
    }
    const bool has_length = marker != 0x01 && (marker < 0xD0 || marker > 0xD8);
    at += 2 + (has_length ? unsigned_at(bytes, at + 2, 2, true).value_or(0) : 0);
  }
  return std::nullopt;
}

std::optional<HeaderSize> size_of_bmp(std::string_view bytes) {
  constexpr std::uint64_t kOs2Header = 12;
  const auto header = unsigned_at(bytes, 14, 4, false);
  if (header == kOs2Header) {
    return both(unsigned_at(bytes, 18, 2, false), unsigned_at(bytes, 20, 2, false));
  }
  const auto height = unsigned_at(bytes, 22, 4, false);
  if (!height) return std::nullopt;
  // Negative where rows go from the top down.
  const auto rows = static_cast<std::int64_t>(static_cast<std::int32_t>(*height));
  return both(unsigned_at(bytes, 18, 4, false), static_cast<std::uint64_t>(std::abs(rows)));
}

std::optional<HeaderSize> size_of_tiff(std::string_view bytes) {
  const bool is_big_endian = bytes.starts_with("MM"sv);
  const auto directory = unsigned_at(bytes, 4, 4, is_big_endian);
  if (!directory) return std::nullopt;
  const auto entries = unsigned_at(bytes, *directory, 2, is_big_endian).value_or(0);
  std::optional<std::uint64_t> width;
  std::optional<std::uint64_t> height;
  for (std::uint64_t i = 0; i < entries; ++i) {
    const std::uint64_t entry = *directory + 2 + 12 * i;
    constexpr std::uint64_t kShort = 3;
    constexpr std::uint64_t kWidth = 256;
    constexpr std::uint64_t kHeight = 257;
    const auto tag = unsigned_at(bytes, entry, 2, is_big_endian);
    if (tag != kWidth && tag != kHeight) continue;
    const bool is_short = unsigned_at(bytes, entry + 2, 2, is_big_endian) == kShort;
    (tag == kWidth ? width : height) =
        unsigned_at(bytes, entry + 8, is_short ? 2 : 4, is_big_endian);
  }
  return both(width, height);
}

// "P5 640 480 255", with comments and any blanks in between.
std::optional<HeaderSize> size_of_netpbm(std::string_view bytes) {
  std::array<std::uint64_t, 2> sides{};
  std::size_t at = 2;
  for (std::uint64_t& side : sides) {
    while (at < bytes.size() && (bytes[at] == '#' || " \t\r\n"sv.find(bytes[at]) != bytes.npos)) {
      at = bytes[at] == '#' ? std::min(bytes.find('\n', at), bytes.size()) : at + 1;
    }
    const std::size_t end = std::min(bytes.find_first_not_of("0123456789", at), bytes.size());
    const auto number = parse_integer(bytes.substr(at, end - at));
    if (!number) return std::nullopt;
    side = static_cast<std::uint64_t>(*number);
    at = end;
  }
  return HeaderSize{sides[0], sides[1]};
}

// CRC-32 of ISO 3309.
std::uint32_t checksum(std::string_view bytes) {
  boost::crc_32_type sum;
  sum.process_bytes(bytes.data(), bytes.size());
  return sum.checksum();
}

// Whether libpng decodes what an IHDR asks for; it prints why not.
bool is_possible_png(std::string_view header) {
  constexpr std::uint64_t kLongestSide = 1'000'000;  // libpng's own limit
  constexpr std::size_t kBytes = 13;
  if (header.size() != kBytes) return false;
  const auto is_side = [&](std::size_t at) {
    const std::uint64_t side = unsigned_at(header, at, 4, true).value_or(0);
    return side > 0 && side <= kLongestSide;
  };
  // By colour type: the bits that a sample may have.
  constexpr std::array<std::string_view, 7> kDepths{
      "\1\2\4\10\20"sv, ""sv, "\10\20"sv, "\1\2\4\10"sv, "\10\20"sv, ""sv, "\10\20"sv};
  const auto type = static_cast<unsigned char>(header[9]);
  const bool has_depth = type < kDepths.size() && kDepths.at(type).find(header[8]) != header.npos;
  // Compression, filter and interlace.
  return is_side(0) && is_side(4) && has_depth && header[10] == 0 && header[11] == 0 &&
         (header[12] == 0 || header[12] == 1);
}

}  // namespace

std::optional<HeaderSize> size_in_header(std::string_view bytes) {
  if (bytes.starts_with(kPngStart)) {
    return both(unsigned_at(bytes, 16, 4, true), unsigned_at(bytes, 20, 4, true));
  }
  if (bytes.starts_with("\xFF\xD8"sv)) return size_of_jpeg(bytes);
  if (bytes.starts_with("BM"sv)) return size_of_bmp(bytes);
  if (bytes.starts_with("II*\0"sv) || bytes.starts_with("MM\0*"sv)) return size_of_tiff(bytes);
  const bool is_netpbm = bytes.size() > 2 && bytes[0] == 'P' && bytes[1] >= '1' && bytes[1] <= '6';
  return is_netpbm ? size_of_netpbm(bytes) : std::nullopt;
}

std::optional<std::string> sound_png(std::string_view bytes) {
  constexpr std::size_t kAround = 12;  // a length, a name and a checksum
  std::string sound(kPngStart);
  for (std::size_t at = kPngStart.size(); bytes.size() >= at && bytes.size() - at >= kAround;) {
    const std::uint64_t length = unsigned_at(bytes, at, 4, true).value_or(0);
    if (length > bytes.size() - at - kAround) return std::nullopt;
    const std::string_view name = bytes.substr(at + 4, 4);
    const bool is_intact =
        unsigned_at(bytes, at + 8 + length, 4, true) == checksum(bytes.substr(at + 4, 4 + length));
    const bool is_needed = name[0] >= 'A' && name[0] <= 'Z';
    if (!is_intact && is_needed) return std::nullopt;
    const bool is_first = at == kPngStart.size();
    if (is_first != (name == "IHDR"sv)) return std::nullopt;
    if (is_first && !is_possible_png(bytes.substr(at + 8, length))) return std::nullopt;
    if (is_intact) sound += bytes.substr(at, kAround + length);
    if (name == "IEND"sv) return sound;
    at += kAround + length;
  }
  return std::nullopt;
}

}  // namespace fathom
