#pragma once

#include <vector>

#include "fathom/core/options.hpp"
#include "fathom/vision/features.hpp"

namespace fathom {

struct MatchingOptions {
  double ratio = 0.8;
  bool mutual = true;

  void describe(OptionTable& table);
};

/// Two features taken for the same place.
struct Match {
  int from = 0;           ///< row in the features of the one picture
  int to = 0;             ///< row in those of the other
  float distance = 0.0F;  ///< of the descriptors: Euclidean (SIFT), or differing bits (binary)

  bool operator==(const Match&) const = default;
};

/// Matches of `from` in `to`, by rising row of `from`, each row at most once.
///
/// Let n(i) be the row of `to` nearest to row i of `from`, d₁ its distance and d₂ that of the next
/// nearest row. (i, n(i)) is a match if
/// - ratio (Lowe 2004, section 7.1): d₁ < ratio · d₂. With ratio 1 this test is off. With a single
///   row in `to` there is no d₂, nothing says that the match is distinct, and there is none;
/// - mutual: i is the row of `from` nearest to row n(i) of `to`. The ratio is not asked that way.
/// Of equally near rows the first counts as nearest. No features on either side: no matches.
///
/// Throws InputError where the two kinds of descriptors differ.
std::vector<Match> match(const Features& from, const Features& to, const MatchingOptions& options);

}  // namespace fathom
