#pragma once

#include <string>
#include <vector>

namespace fathom {

using Words = std::vector<std::string>;

/// Whether one of the words of a topic's name is among `words`, which are in lower case; "alti*"
/// are all that begin with "alti". Words are runs of letters; a capital behind a small letter
/// begins one, too, and the last of several capitals may.
bool has_word(const std::string& name, const Words& words);

/// What names a topic of ground truth, of an altimeter, of any altitude.
const Words& truth_words();
const Words& altimeter_words();
const Words& altitude_words();

}  // namespace fathom
