#include <nlohmann/json.hpp>

#include "fathom/evaluation/proportion.hpp"
#include "output.hpp"

namespace fathom::benchmarks {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Interval& interval) {
  return Json::array({interval.low, interval.high});
}

Json json_of(const Share& share) {
  return {{"count", share.count},
          {"successes", share.successes},
          {"wilson_95", json_of(wilson_interval(share.successes, share.count))}};
}

Json json_of(const MedianAnd95& value) {
  return {{"median", value.median}, {"p95", value.p95}};
}

Json json_of(const ContenderSummary& s, const Settings& settings) {
  Json json{{"recall", json_of(s.recall)}, {"wrong_motions", json_of(s.wrong)}};
  const auto buckets = buckets_of(settings);
  for (std::size_t k = 0; k < buckets.size(); ++k) {
    Json bucket = json_of(s.recall_by_bucket[k]);
    bucket["overlap"] = Json::array({buckets[k].low, buckets[k].high});
    json["recall_by_overlap"].push_back(bucket);
  }
  json["translation_m"] = json_of(s.translation_m);
  json["translation_px"] = json_of(s.translation_px);
  json["heading_rad"] = json_of(s.heading_rad);
  if (s.nis) {
    json["nis"] = {{"count", s.nis->count},
                   {"mean", s.nis->mean},
                   {"expected_95", json_of(s.nis->expected)},
                   {"share_beyond_95", s.nis->share_beyond_95}};
  }
  json["match_ms"] = s.match_ms;
  json["solve_ms"] = s.solve_ms;
  return json;
}

Json json_of(const Negatives& n, bool opencv) {
  Json json{{"floor", n.floor},
            {"pairs", n.pairs},
            {"accepted", n.ours},
            {"least_false_alarms", n.least_false_alarms},
            {"upper_bound_95", clopper_pearson_upper(n.ours, n.pairs)}};
  if (opencv) {
    json["opencv_accepted"] = n.opencv;
    json["opencv_upper_bound_95"] = clopper_pearson_upper(n.opencv, n.pairs);
  }
  return json;
}

}  // namespace

std::string json_text(const Results& results) {
  const Settings& settings = results.settings;
  Json json{{"seed", settings.seed}, {"pairs_per_cell", settings.pairs_per_cell}};
  json["cells"] = Json::array();
  for (const CellSummary& cell : results.cells) {
    Json entry{{"floor", cell.floor},
               {"condition", cell.condition},
               {"extraction_ms", cell.extraction_ms},
               {"ours", json_of(cell.ours, settings)}};
    if (cell.opencv) entry["opencv"] = json_of(*cell.opencv, settings);
    json["cells"].push_back(entry);
  }
  json["negatives"] = Json::array();
  for (const Negatives& n : results.negatives) {
    json["negatives"].push_back(json_of(n, settings.opencv));
  }
  json["speed"] = Json::array();
  for (const auto& [floor, speed] : results.speeds) {
    json["speed"].push_back({{"floor", floor},
                             {"from_features", speed.from_features},
                             {"to_features", speed.to_features},
                             {"repeats", speed.repeats},
                             {"ours_ms", speed.ours_ms},
                             {"opencv_ms", speed.opencv_ms}});
  }
  return json.dump(2) + "\n";
}

}  // namespace fathom::benchmarks
