#pragma once

#include <string>
#include <string_view>

namespace fathom {

/// Text as every LaTeX prints it: special characters escaped, ligatures of signs broken, Greek
/// letters, superscripts and signs of our own labels as mathematics, control characters as blanks.
/// What pdflatex has no letter for stands as its code, "[U+6D77]".
std::string latex_text(std::string_view text);

/// A number within $…$, rounded: "5.01 \times 10^{-5}" for 5.01e-05; "--" if it is not finite.
std::string latex_number(double value, int digits);

}  // namespace fathom
