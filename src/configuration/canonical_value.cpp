#include "canonical_value.hpp"

#include <charconv>

#include "fathom/core/text.hpp"

namespace fathom {
namespace {

std::string written(double value, std::chars_format format) {
  char buffer[400];  // the longest plain double has 309 digits before the point
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value, format);
  return {buffer, result.ptr};
}

std::string scientific(double value) {
  std::string text = written(value, std::chars_format::scientific);
  const std::size_t e = text.find('e');
  if (e == std::string::npos) return text;
  std::string mantissa = text.substr(0, e);
  if (mantissa.find('.') == std::string::npos) mantissa += ".0";
  return mantissa + "e" + std::to_string(std::stoi(text.substr(e + 1)));
}

std::string canonical_item(const std::string& item, const std::string& type,
                           std::string (*text_of)(double)) {
  if (type.starts_with("integer")) {
    const auto number = parse_integer(item);
    return number ? std::to_string(*number) : item;
  }
  const bool is_real = type.starts_with("real") || type == "list of real";
  const auto number = is_real ? parse_real(item) : std::nullopt;
  return number ? text_of(*number) : item;
}

}  // namespace

std::string canonical_number(double value) {
  // The two zeros are one value.
  if (value == 0.0) return "0";
  const std::string plain = written(value, std::chars_format::fixed);
  const std::string with_exponent = scientific(value);
  return plain.size() < with_exponent.size() ? plain : with_exponent;
}

OptionValue canonical_value(const OptionValue& value, const std::string& type,
                            std::string (*text_of)(double)) {
  OptionValue canonical = value;
  for (std::string& item : canonical.items) item = canonical_item(item, type, text_of);
  return canonical;
}

std::string canonical_text(const OptionValue& value, const std::string& type,
                           std::string (*text_of)(double)) {
  return canonical_value(value, type, text_of).text();
}

}  // namespace fathom
