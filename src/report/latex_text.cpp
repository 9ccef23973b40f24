#include "latex_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "fathom/core/utf8.hpp"
#include "fathom/report/table.hpp"

namespace fathom {
namespace {

using Replaced = std::pair<std::string_view, std::string_view>;

constexpr std::array<Replaced, 22> kReplaced{{{"\\", "\\textbackslash{}"},
                                              {"&", "\\&"},
                                              {"%", "\\%"},
                                              {"$", "\\$"},
                                              {"#", "\\#"},
                                              {"_", "\\_"},
                                              {"{", "\\{"},
                                              {"}", "\\}"},
                                              {"~", "\\textasciitilde{}"},
                                              {"^", "\\textasciicircum{}"},
                                              {"<", "\\textless{}"},
                                              {">", "\\textgreater{}"},
                                              {"|", "\\textbar{}"},
                                              {"\"", "''"},
                                              {"`", "{`}"},
                                              {"-", "{-}"},
                                              {"²", "$^2$"},
                                              {"³", "$^3$"},
                                              {"°", "$^\\circ$"},
                                              {"×", "$\\times$"},
                                              {"–", "--"},
                                              {"…", "\\dots{}"}}};

constexpr std::array<Replaced, 20> kGreek{
    {{"α", "alpha"}, {"β", "beta"},  {"γ", "gamma"}, {"δ", "delta"},  {"ε", "epsilon"},
     {"η", "eta"},   {"θ", "theta"}, {"κ", "kappa"}, {"λ", "lambda"}, {"µ", "mu"},
     {"ν", "nu"},    {"π", "pi"},    {"ρ", "rho"},   {"σ", "sigma"},  {"τ", "tau"},
     {"φ", "phi"},   {"χ", "chi"},   {"ω", "omega"}, {"Σ", "Sigma"},  {"Ω", "Omega"}}};

// A single hyphen is itself; two would become a dash.
std::string_view found_among(std::string_view text, std::string_view character) {
  if (character == "-" && !text.starts_with("--")) return "-";
  const auto known = std::find_if(kReplaced.begin(), kReplaced.end(),
                                  [&](const Replaced& one) { return one.first == character; });
  return known == kReplaced.end() ? std::string_view() : known->second;
}

std::string code_text(std::uint32_t value) {
  char buffer[16];
  std::snprintf(buffer, sizeof buffer, "[U+%04X]", value);
  return buffer;
}

std::string character_text(std::string_view text, const CodePoint& point) {
  const std::string_view character = text.substr(0, point.bytes);
  if (!point.valid) return "?";
  if (point.value < 0x20 || point.value == 0x7F) return " ";
  if (const std::string_view known = found_among(text, character); !known.empty()) {
    return std::string(known);
  }
  const auto greek = std::find_if(kGreek.begin(), kGreek.end(),
                                  [&](const Replaced& one) { return one.first == character; });
  if (greek != kGreek.end()) return "$\\" + std::string(greek->second) + "$";
  // ASCII, and the letters of Latin-1 and Latin Extended-A, of which inputenc knows all.
  const bool is_letter = point.value < 0x80 || (point.value >= 0xC0 && point.value <= 0x17F);
  return is_letter ? std::string(character) : code_text(point.value);
}

}  // namespace

std::string latex_text(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const CodePoint point = first_code_point(text);
    result += character_text(text, point);
    text.remove_prefix(point.bytes);
  }
  return result;
}

std::string latex_number(double value, int digits) {
  if (!std::isfinite(value)) return "--";
  const std::string text = format_number(value, digits);
  const std::size_t exponent = text.find('e');
  if (exponent == std::string::npos) return "$" + text + "$";
  return "$" + text.substr(0, exponent) + " \\times 10^{" +
         std::to_string(std::stoi(text.substr(exponent + 1))) + "}$";
}

}  // namespace fathom
