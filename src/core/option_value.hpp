#pragma once

#include <string>
#include <vector>

#include "fathom/core/options.hpp"

namespace fathom {

/// "[0.5, 1]"; each number reads back to the same bits.
std::string list_text(const std::vector<double>& values);

/// Throws InputError: the key, what was expected and what was given.
[[noreturn]] void refuse(const std::string& key, const std::string& expected,
                         const OptionValue& value);

/// Whether the value is this word alone.
bool is_word(const OptionValue& value, const std::string& word);

/// The value as one number within the range. Else refuses it, with `alternative`, such as " or
/// off", behind what was expected.
double checked_real(const OptionDescription& option, const Range& range, const OptionValue& value,
                    const std::string& alternative = "");

/// Likewise a whole number that an int can hold.
int checked_integer(const OptionDescription& option, const Range& range, const OptionValue& value,
                    const std::string& alternative = "");

}  // namespace fathom
