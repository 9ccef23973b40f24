#include "estimators/sparse_gauss_newton/loop_judgement.hpp"

namespace fathom::sparse_gauss_newton {

void LoopJudgement::describe(OptionTable& table) {
  const Range share = Range::between(0.0, 1.0);
  table.real("reject_at", reject_at, Range{1.0, 2.0}, "",
             "squared scales from which a loop or a group is rejected; half weight is 0.5 before");
  table.real("worst_share", worst_share, share, "",
             "rejected at once: loops with this share of the largest chi-squared");
  table.integer("max_rejections", max_rejections, Range::at_least(1), "",
                "a loop that was rejected so often is not readmitted");
  table.real("settled_group_share", settled_group_share, share, "",
             "of a squared scale: a group below it is not judged again");
  table.real("group_loop_share", group_loop_share, share, "",
             "likewise: a group is rejected only where each of its loops has more against it");
  table.real("candidate_reach", candidate_reach, Range::positive(), "",
             "squared scales within which a rejected loop may be readmitted");
  table.real("drift_reach", drift_reach, Range::positive(), "",
             "likewise, the drift of dead reckoning counted, of new loops or where few are in");
  table.real("few_share", few_share, share, "", "few: less than this share of all loops");
  table.real("scale_factor", scale_factor, Range::positive(), "",
             "without loss_scale: reject_at squared scales are so many times the quantile");
  table.real("scale_quantile", scale_quantile, Range{0.0, 0.99}, "",
             "quantile of the loops' chi-squared, each left out, that sets the scale");
  table.integer("scale_loops", scale_loops, Range::at_least(1), "", "fewer loops set no scale");
  table.real("least_scale_share", least_scale_share, share, "",
             "of the default squared scale: the least that the loops may set");
  table.integer("group_reach", group_reach, Range::at_least(1), "keyframes",
                "keyframes between the ends of neighbouring loops of a group");
  table.real("lost_group_slack", lost_group_slack, Range::positive(), "",
             "squared scales within which two rejected loops agree");
  table.integer("hypotheses", hypotheses, Range::at_least(0), "",
                "groups of rejected loops that a batch solve trusts in turn");
  table.real("first_weight", first_weight, share, "",
             "weight under Geman-McClure from which a loop is in at first");
  table.integer("passes", passes, Range::at_least(1), "", "choices of candidates at most");
  table.integer("rounds", rounds, Range::at_least(1), "", "judgements of one choice at most");
  table.integer("weight_rounds", weight_rounds, Range::at_least(1), "",
                "rounds of weights at most");
  table.real("weight_tolerance", weight_tolerance, Range::positive(), "",
             "weights have settled when none changes by more");
}

}  // namespace fathom::sparse_gauss_newton
