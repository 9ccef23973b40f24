#include "exif.hpp"

#ifdef FATHOM_EXIF
#include <chrono>
#include <cstdio>
#include <libexif/exif-data.h>
#include <memory>
#endif

namespace fathom {

#ifdef FATHOM_EXIF
namespace {

struct Unref {
  void operator()(ExifData* data) const { exif_data_unref(data); }
};
using Data = std::unique_ptr<ExifData, Unref>;

ExifEntry* entry_of(const Data& data, ExifTag tag) {
  return exif_content_get_entry(data->ifd[EXIF_IFD_EXIF], tag);
}

std::string_view text_of(const ExifEntry* entry) {
  if (entry == nullptr || entry->format != EXIF_FORMAT_ASCII || entry->data == nullptr) return {};
  const std::string_view bytes(reinterpret_cast<const char*>(entry->data), entry->size);
  return bytes.substr(0, bytes.find('\0'));
}

// "2024:05:17 10:31:02", and the digits after its decimal point.
std::optional<std::int64_t> time_of(std::string_view time, std::string_view fraction) {
  int year = 0;
  int month = 0;
  int day = 0;
  int hour = 0;
  int minute = 0;
  int second = 0;
  const std::string text(time);
  if (std::sscanf(text.c_str(), "%4d:%2d:%2d %2d:%2d:%2d", &year, &month, &day, &hour, &minute,
                  &second) != 6) {
    return std::nullopt;
  }
  const std::chrono::year_month_day date{std::chrono::year(year),
                                         std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  if (!date.ok()) return std::nullopt;
  constexpr std::int64_t kSecond = 1'000'000'000;
  const std::int64_t days = std::chrono::sys_days(date).time_since_epoch().count();
  std::int64_t time_ns = (((days * 24 + hour) * 60 + minute) * 60 + second) * kSecond;
  std::int64_t place = kSecond / 10;
  for (const char digit : fraction) {
    if (digit < '0' || digit > '9') break;
    time_ns += (digit - '0') * place;
    place /= 10;
  }
  return time_ns;
}

}  // namespace

Exif read_exif(const std::filesystem::path& picture) {
  const Data data(exif_data_new_from_file(picture.c_str()));
  if (!data) return {};
  Exif exif;
  exif.time_ns = time_of(text_of(entry_of(data, EXIF_TAG_DATE_TIME_ORIGINAL)),
                         text_of(entry_of(data, EXIF_TAG_SUB_SEC_TIME_ORIGINAL)));
  const ExifEntry* focal = entry_of(data, EXIF_TAG_FOCAL_LENGTH_IN_35MM_FILM);
  if (focal != nullptr && focal->format == EXIF_FORMAT_SHORT && focal->components == 1) {
    const int length_mm = exif_get_short(focal->data, exif_data_get_byte_order(data.get()));
    if (length_mm > 0) exif.focal_35mm_mm = length_mm;
  }
  return exif;
}
#else
Exif read_exif(const std::filesystem::path& /*picture*/) {
  return {};
}
#endif

}  // namespace fathom
