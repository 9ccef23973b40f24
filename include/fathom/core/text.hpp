#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fathom {

/// Splits at any run of the separators; no empty pieces.
std::vector<std::string_view> split(std::string_view text, std::string_view separators = " \t\r");

/// The pieces refer to the text: not of one that is gone with the statement.
template <std::same_as<std::string> Text>
std::vector<std::string_view> split(Text&& text, std::string_view separators = "") = delete;

/// Splits at every comma and trims blanks; empty fields are kept, as CSV has them.
std::vector<std::string_view> split_csv(std::string_view text);

std::string_view trim(std::string_view text);

struct TextLine {
  std::size_t number = 0;  ///< from 1
  std::string_view text;   ///< trimmed
};

/// The lines of a text, each found as a loop comes to it: a list of them would take twelve times a
/// text of short ones. Refers to the text.
class TextLines {
 public:
  TextLines(std::string_view content, bool with_blank)
      : content_(content), with_blank_(with_blank) {}

  class Iterator {
   public:
    Iterator(std::string_view rest, bool with_blank) : rest_(rest), with_blank_(with_blank) {
      ++*this;
    }
    const TextLine& operator*() const { return line_; }
    Iterator& operator++();
    bool operator==(std::default_sentinel_t) const { return is_end_; }

   private:
    std::string_view rest_;
    bool with_blank_;
    bool is_end_ = false;
    TextLine line_;
  };

  Iterator begin() const { return {content_, with_blank_}; }
  std::default_sentinel_t end() const { return {}; }

 private:
  std::string_view content_;
  bool with_blank_;
};

TextLines all_lines_of(std::string_view content);
/// The lines that are not blank.
TextLines lines_of(std::string_view content);

/// Readers refuse rows that are longer: a list of their fields would take sixteen times a row of
/// short ones.
inline constexpr std::size_t kLongestRow = 1 << 20;
inline constexpr const char* kTooLongRow = "has more than a mebibyte; expected a row of a table";

/// The words with the separator between them.
std::string joined(const std::vector<std::string>& words, const std::string& separator);

/// "1 run", "3 runs".
std::string counted(std::size_t count, const std::string& noun);

/// A word as a shell takes it back: in single quotes where it has more than letters, digits and
/// what names, numbers and settings are written with. words_of_command() takes it back, too.
std::string shell_word(std::string_view word);

/// The whole text as a finite number, or nothing: "1.5x", "nan" and "inf" are nothing.
std::optional<double> parse_real(std::string_view text);
std::optional<std::int64_t> parse_integer(std::string_view text);

/// What a file says, fit for a one-line message: in quotes, unprintable bytes as `?`, cut when
/// long.
std::string in_quotes(std::string_view text);

/// 17 significant digits: reads back to the same bits.
std::string exact(double value);

/// The shortest text that reads back to the same bits: 0.1 stays "0.1".
std::string number_text(double value);

/// So many significant digits, for messages: 0.02, 1.5e+06.
std::string short_number(double value, int digits = 3);

/// Nanoseconds as decimal seconds, digit by digit: a double would lose them.
std::string seconds_text(std::int64_t nanoseconds);

/// Those of which it may be a misspelling: all of the least edit distance, if that is small.
std::vector<std::string> nearest(std::string_view word, const std::vector<std::string>& among);

}  // namespace fathom
