#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
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
std::vector<TextLine> all_lines_of(std::string_view content);
/// The lines that are not blank.
std::vector<TextLine> lines_of(std::string_view content);

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

/// The candidate with the least edit distance, if it is near enough to be a misspelling.
std::optional<std::string> nearest(std::string_view word, const std::vector<std::string>& among);

}  // namespace fathom
