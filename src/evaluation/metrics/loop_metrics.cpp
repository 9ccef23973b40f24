#include <algorithm>

#include "groups.hpp"

namespace fathom {
namespace {

using Value = std::optional<double>;

Value number(std::optional<std::size_t> count) {
  if (!count) return std::nullopt;
  return static_cast<double>(*count);
}

auto count_of(LoopFate fate) {
  return [fate](const JudgedRun& run) -> Value {
    if (run.facts.run == nullptr) return std::nullopt;
    return static_cast<double>(std::ranges::count(run.facts.run->loops, fate, &LoopDecision::fate));
  };
}

Value loops_kept(const JudgedRun& run) {
  if (run.facts.run == nullptr) return std::nullopt;
  return static_cast<double>(std::ranges::count_if(run.facts.run->loop_weights, is_kept));
}

// How many loops satisfy a condition on (is false, is kept), where it is known which are false.
template <class Condition>
auto count_where_known(Condition condition) {
  return [condition](const JudgedRun& run) -> Value {
    const RunFacts& facts = run.facts;
    if (facts.run == nullptr || facts.is_false_loop == nullptr || facts.run->loops.empty()) {
      return std::nullopt;
    }
    std::size_t count = 0;
    for (std::size_t j = 0; j < facts.run->loops.size(); ++j) {
      if (condition((*facts.is_false_loop)[j], is_kept(facts.run->loop_weights[j]))) ++count;
    }
    return static_cast<double>(count);
  };
}

Value mean_nis(const JudgedRun& run) {
  if (run.facts.run == nullptr) return std::nullopt;
  double sum = 0.0;
  std::size_t count = 0;
  for (const LoopDecision& loop : run.facts.run->loops) {
    if (loop.fate != LoopFate::used || !loop.nis) continue;
    sum += *loop.nis;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return sum / static_cast<double>(count);
}

Value precision(const JudgedRun& run) {
  if (run.facts.run == nullptr || run.facts.true_overlaps == nullptr) return std::nullopt;
  return loop_precision(run.facts.run->loops, *run.facts.true_overlaps);
}

Value recall(const JudgedRun& run) {
  if (run.facts.run == nullptr || run.facts.true_overlaps == nullptr) return std::nullopt;
  return loop_recall(run.facts.run->loops, *run.facts.true_overlaps,
                     run.facts.options.recalled_overlap);
}

// Where the log has a loop to tell it.
template <class Term>
auto of_loop_terms(Term term) {
  return [term](const JudgedRun& run) -> Value {
    const LoopTerms* terms = run.facts.loop_terms;
    if (terms == nullptr || terms->loops == 0) return std::nullopt;
    return term(*terms);
  };
}

// What the choice of a back end goes by (docs/which_back_end.md).
std::vector<Metric> term_metrics() {
  return {
      {"loop_misfit_rad", "heading misfit of loops", "rad", Better::neither,
       "of the log: the most that a loop misses by before its update, against what was known",
       of_loop_terms([](const LoopTerms& terms) { return terms.most_turned.misfit_rad(); })},
      {"loop_curvature", "curvature of loops", "", Better::neither,
       "of the log: what one linearisation leaves of its worst loop, in its sigmas",
       of_loop_terms([](const LoopTerms& terms) { return terms.curvature; })},
  };
}

std::vector<Metric> log_metrics() {
  return {
      {"keyframes", "keyframes", "", Better::neither, "of the log",
       [](const JudgedRun& run) { return number(run.facts.log.size()); }},
      {"registrations", "registrations", "", Better::neither, "of the log",
       [](const JudgedRun& run) {
         return run.facts.run != nullptr ? number(run.facts.log.registration_count())
                                         : std::nullopt;
       }},
      {"registrations_tried", "registrations tried", "", Better::neither,
       "pairs of keyframes given to registration; absent of a pose graph",
       [](const JudgedRun& run) { return number(run.facts.registrations_tried); }},
      {"registrations_left_out", "registrations left out", "", Better::neither,
       "loop candidates beyond max_per_keyframe or budget; absent of a pose graph",
       [](const JudgedRun& run) { return number(run.facts.registrations_left_out); }},
  };
}

std::vector<Metric> false_loop_metrics() {
  return {
      {"false_loops", "false loops", "", Better::neither,
       "false registrations of the log, where it is known which are",
       count_where_known([](bool is_false, bool) { return is_false; })},
      {"false_loops_kept", "false loops kept", "", Better::lower,
       "false registrations that weigh more than one half in the end",
       count_where_known([](bool is_false, bool is_kept) { return is_false && is_kept; })},
      {"right_loops_lost", "right loops lost", "", Better::lower,
       "right registrations that do not weigh more than one half in the end",
       count_where_known([](bool is_false, bool is_kept) { return !is_false && !is_kept; })},
  };
}

}  // namespace

std::vector<Metric> loop_metrics() {
  std::vector<Metric> all = log_metrics();
  append(all, term_metrics());
  const std::vector<Metric> uses{
      {"loop_closures", "loop closures", "", Better::neither, "registrations used",
       count_of(LoopFate::used)},
      {"rejected", "rejected", "", Better::neither, "registrations refused by the gate",
       count_of(LoopFate::rejected)},
      {"lost", "lost", "", Better::lower,
       "registrations let through by the gate, but their update failed", count_of(LoopFate::lost)},
      {"loops_kept", "loops kept", "", Better::neither,
       "registrations that weigh more than one half in the end", loops_kept},
      {"mean_nis_accepted", "mean NIS accepted", "", Better::neither,
       "mean normalised innovation squared of the used registrations; 3 expected", mean_nis},
      {"loop_precision", "loop precision", "", Better::higher,
       "share of the used registrations whose pictures truly overlap", precision},
      {"loop_recall", "loop recall", "", Better::higher,
       "share of the pairs of keyframes that truly overlap by evaluation.min_overlap or more that "
       "are used registrations",
       recall},
  };
  all.insert(all.end(), uses.begin(), uses.end());
  const std::vector<Metric> of_false_loops = false_loop_metrics();
  all.insert(all.end(), of_false_loops.begin(), of_false_loops.end());
  return all;
}

}  // namespace fathom
