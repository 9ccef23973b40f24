#pragma once

#include <limits>
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

/// The rows nearest to a row, in the distance of their descriptors.
struct Nearest {
  int row = -1;  ///< of equally near ones the first; −1: the other picture has no features
  float distance = std::numeric_limits<float>::infinity();
  float next_distance = std::numeric_limits<float>::infinity();  ///< of the next nearest
};

/// Who is nearest to whom, both ways.
struct NearestRows {
  std::vector<Nearest> in_to;    ///< of each row of `from`
  std::vector<Nearest> in_from;  ///< of each row of `to`; without `next_distance`
};

/// Compares every row with every other, exactly. Throws InputError where the two kinds of
/// descriptors differ.
NearestRows find_nearest(const Features& from, const Features& to);

/// Matches of `from` in `to`, by rising row of `from`, each row at most once.
///
/// Let n(i) be the row of `to` nearest to row i of `from`, d₁ its distance and d₂ that of the next
/// nearest row. (i, n(i)) is a match if
/// - ratio (Lowe 2004, section 7.1): d₁ < ratio · d₂. With ratio 1 this test is off. With a single
///   row in `to` there is no d₂, nothing says that the match is distinct, and there is none;
/// - mutual: i is the row of `from` nearest to row n(i) of `to`. The ratio is not asked that way.
/// No features on either side: no matches.
std::vector<Match> match(const NearestRows& nearest, const MatchingOptions& options);

/// The same, of two pictures.
std::vector<Match> match(const Features& from, const Features& to, const MatchingOptions& options);

/// All that are nearest one way at least, each pair once, however little they stand out: most are
/// wrong, but where a motion is known, those that it brings together speak for it.
std::vector<Match> all_nearest(const NearestRows& nearest);

}  // namespace fathom
