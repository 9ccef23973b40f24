#include "fathom/core/text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <utility>

namespace fathom {

std::vector<std::string_view> split(std::string_view text, std::string_view separators) {
  std::vector<std::string_view> pieces;
  std::size_t begin = text.find_first_not_of(separators);
  while (begin != std::string_view::npos) {
    const std::size_t end = std::min(text.find_first_of(separators, begin), text.size());
    pieces.push_back(text.substr(begin, end - begin));
    begin = text.find_first_not_of(separators, end);
  }
  return pieces;
}

std::string_view trim(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r\n") - begin + 1);
}

TextLines::Iterator& TextLines::Iterator::operator++() {
  do {
    is_end_ = rest_.empty();
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    line_ = {line_.number + 1, trim(rest_.substr(0, end))};
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
  } while (!is_end_ && !with_blank_ && line_.text.empty());
  return *this;
}

TextLines all_lines_of(std::string_view content) {
  return {content, true};
}

TextLines lines_of(std::string_view content) {
  return {content, false};
}

std::string joined(const std::vector<std::string>& words, const std::string& separator) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += separator;
    text += words[i];
  }
  return text;
}

std::vector<std::string_view> split_csv(std::string_view text) {
  std::vector<std::string_view> fields;
  std::size_t begin = 0;
  while (true) {
    const std::size_t comma = text.find(',', begin);
    if (comma == std::string_view::npos) break;
    fields.push_back(trim(text.substr(begin, comma - begin)));
    begin = comma + 1;
  }
  fields.push_back(trim(text.substr(begin)));
  return fields;
}

namespace {

template <class Number>
std::optional<Number> parse_whole(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

std::string counted(std::size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

std::string shell_word(std::string_view word) {
  constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+./,:=@%";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string_view::npos) {
    return std::string(word);
  }
  std::string quoted = "'";
  for (const char letter : word) quoted += letter == '\'' ? "'\"'\"'" : std::string(1, letter);
  return quoted + "'";
}

std::optional<double> parse_real(std::string_view text) {
  const auto value = parse_whole<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::optional<std::int64_t> parse_integer(std::string_view text) {
  return parse_whole<std::int64_t>(text);
}

namespace {

// What is not seen, or is taken for a hyphen or a blank: shown by its code point.
struct Unseen {
  std::string_view bytes;
  std::string_view name;
};
constexpr Unseen kUnseen[] = {
    {"\xC2\xA0", "<U+00A0>"},     {"\xC2\xAD", "<U+00AD>"},     {"\xE2\x80\x8B", "<U+200B>"},
    {"\xE2\x80\x8C", "<U+200C>"}, {"\xE2\x80\x8D", "<U+200D>"}, {"\xE2\x80\x8E", "<U+200E>"},
    {"\xE2\x80\x8F", "<U+200F>"}, {"\xE2\x80\x90", "<U+2010>"}, {"\xE2\x80\x91", "<U+2011>"},
    {"\xE2\x80\x92", "<U+2012>"}, {"\xE2\x80\x93", "<U+2013>"}, {"\xE2\x80\xAF", "<U+202F>"},
    {"\xE2\x81\xA0", "<U+2060>"}, {"\xE2\x88\x92", "<U+2212>"}, {"\xEF\xBB\xBF", "<U+FEFF>"}};

}  // namespace

std::string in_quotes(std::string_view text) {
  std::size_t length = std::min<std::size_t>(text.size(), 60);
  // Never inside a UTF-8 character.
  while (length > 0 && length < text.size() && (text[length] & 0xC0) == 0x80) --length;
  std::string shown;
  for (std::size_t i = 0; i < length;) {
    const Unseen* unseen = nullptr;
    for (const Unseen& one : kUnseen) {
      if (text.substr(i).starts_with(one.bytes)) unseen = &one;
    }
    if (unseen != nullptr) {
      shown += unseen->name;
      i += unseen->bytes.size();
      continue;
    }
    const char letter = text[i++];
    shown += static_cast<unsigned char>(letter) < 0x20 || letter == 0x7f ? '?' : letter;
  }
  return "'" + shown + (text.size() > length ? "…'" : "'");
}

std::string number_text(double value) {
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
  return {buffer, result.ptr};
}

std::string exact(double value) {
  char buffer[40];
  const int length = std::snprintf(buffer, sizeof buffer, "%.17g", value);
  return {buffer, static_cast<std::size_t>(length)};
}

std::string short_number(double value, int digits) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.*g", digits, value);
  return buffer;
}

std::string seconds_text(std::int64_t nanoseconds) {
  constexpr std::int64_t kPerSecond = 1'000'000'000;
  const std::int64_t fraction = std::abs(nanoseconds % kPerSecond);
  char buffer[48];
  std::snprintf(buffer, sizeof buffer, "%s%lld.%09lld",
                nanoseconds < 0 && nanoseconds > -kPerSecond ? "-" : "",
                static_cast<long long>(nanoseconds / kPerSecond), static_cast<long long>(fraction));
  return buffer;
}

namespace {

// Of letters that are added, left out, exchanged for another, or two that have changed places.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  std::vector<std::size_t> above;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    const std::vector<std::size_t> second = std::exchange(above, row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({substituted, above[j] + 1, row[j - 1] + 1});
      const bool is_swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (is_swapped) row[j] = std::min(row[j], second[j - 2] + 1);
    }
  }
  return row[b.size()];
}

// At most the edit distance, in one pass: what the two do not share is changed, added or left out.
std::size_t least_edit_distance(std::string_view a, std::string_view b) {
  std::array<int, 256> counts{};
  for (const char letter : a) ++counts[static_cast<unsigned char>(letter)];
  std::size_t shared = 0;
  for (const char letter : b) shared += counts[static_cast<unsigned char>(letter)]-- > 0 ? 1 : 0;
  return std::max(a.size(), b.size()) - shared;
}

// What both begin with, up to a dot or hyphen: it is right, and tells nothing of the rest.
std::size_t common_groups(std::string_view a, std::string_view b) {
  const auto differ = std::ranges::mismatch(a, b).in1;
  const std::string_view common = a.substr(0, static_cast<std::size_t>(differ - a.begin()));
  return common.find_last_of(".-") + 1;
}

}  // namespace

std::vector<std::string> nearest(std::string_view word, const std::vector<std::string>& among) {
  std::vector<std::string> best;
  std::size_t best_distance = word.size();
  for (const std::string& candidate : among) {
    const std::size_t common = common_groups(word, candidate);
    const std::string_view given = word.substr(common);
    const std::string_view right = std::string_view(candidate).substr(common);
    const auto [shorter, longer] = std::minmax({given.size(), right.size()});
    // Beyond two letters in five it is another word, not a misspelt one; but one that was not
    // written to its end has one slip.
    const bool is_begun = right.starts_with(given);
    const std::size_t limit = std::max<std::size_t>(longer * 2 / 5, is_begun ? 1 : 0);
    if (longer - shorter > limit) continue;  // so many letters are added at least
    const std::size_t most = std::min(limit, best_distance);
    if (!is_begun && least_edit_distance(given, right) > most) continue;
    const std::size_t distance = is_begun ? 1 : edit_distance(given, right);
    if (distance > most) continue;
    if (distance < best_distance) best.clear();
    best_distance = distance;
    best.push_back(candidate);
  }
  return best;
}

}  // namespace fathom
