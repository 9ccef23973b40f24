#pragma once

#include <string>

#include "fathom/core/options.hpp"

namespace fathom {

/// A number as a configuration would have it, the same for every spelling: the shorter of the
/// plain and the scientific notation, the latter with a digit after the point (YAML 1.1 asks for
/// it) and, where both are as long, preferred: 0.01, 1.25e-4, 1.0e-5. Noise is seeded by it.
std::string canonical_number(double value);

/// A value of an option of this type (OptionDescription) with its numbers in one spelling. What
/// does not fit the type stays as it is.
OptionValue canonical_value(const OptionValue& value, const std::string& type,
                            std::string (*text_of)(double) = canonical_number);

/// The same as one text, a list as "[a, b]".
std::string canonical_text(const OptionValue& value, const std::string& type,
                           std::string (*text_of)(double) = canonical_number);

}  // namespace fathom
