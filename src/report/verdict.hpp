#pragma once

#include <optional>
#include <string>
#include <vector>

#include "doubts.hpp"
#include "ranking.hpp"
#include "scaled_unit.hpp"

namespace fathom {

/// The answer of one cell, in sentences.
struct CellVerdict {
  std::optional<Ranking> ranking;     ///< by the study's metric; nothing where none is ranked
  std::optional<Ranking> by_cost;     ///< of those as good as the best
  std::vector<std::string> as_cheap;  ///< of these that are not shown to be dearer than the first
  std::vector<std::string> answer;    ///< which is best, which is worse, by how much
  std::vector<std::string> cost;
  std::vector<std::string> failed;
  std::vector<Doubt> doubts;
};

/// The answer of a study in sentences, and that of each of its cells.
struct StudyVerdict {
  std::optional<std::string> metric;  ///< by which estimators are ranked
  std::optional<std::string> cost;
  std::vector<CellVerdict> cells;  ///< as those of the results
  std::string rule;                ///< what the words of standing mean
  std::vector<std::string> answer;
  std::vector<std::string> cost_words;
  std::vector<std::string> failed;
  std::vector<std::string> doubts;
};

/// Fewer surveys than these say little of another one.
inline constexpr std::size_t kFewSurveys = 5;

/// Of a study of one cell it is that cell's.
StudyVerdict study_verdict(const StudyResults& results);

/// For a terminal: a line a sentence. Empty where there is nothing to say.
std::string verdict_text(const StudyVerdict& verdict);

// Its parts.
/// Of one cell. `by` ranks; nothing is said of cost without `cost`.
CellVerdict cell_verdict(const CellResults& cell, const StudyDescription& study,
                         const RankingMetric& by, const std::optional<std::string>& cost);

/// What is said before any ranking: which metrics were passed over, and where none is left.
std::vector<std::string> before_ranking(const RankingMetric& by);

/// What makes the answer of a cell doubtful.
std::vector<Doubt> doubts_of(const CellResults& cell, const CellVerdict& verdict);

/// "a, b and c"
std::string listed(const std::vector<std::string>& names);

/// "No verdict: with 5 surveys no difference between 3 estimators can be shown; 7 are needed."
std::string no_verdict_text(const Ranking& ranking, const CellResults& cell);

/// "3.5 mm [0.2, 10.4]": how far an estimator is from the best, without a sign.
std::string distance_text(const RankedEstimator& one, const ScaledUnit& scale);

}  // namespace fathom
