#include "regime_map.hpp"

#include <algorithm>
#include <map>

namespace fathom {
namespace {

// Nothing of dead reckoning, which is no choice, and of an estimator that failed a trial: its mean
// leaves out the hardest ones.
std::optional<double> mean_of(const EstimatorResults& one, const std::string& metric) {
  const auto found = one.metrics.find(metric);
  if (one.name == kDeadReckoning || one.failures() > 0 || found == one.metrics.end()) return {};
  return found->second.moments.mean;
}

std::optional<double> best_of(const CellResults& cell, const std::string& metric) {
  if (described(metric).better != Better::lower) return {};
  std::optional<double> best;
  for (const EstimatorResults& one : cell.estimators) {
    const auto mean = mean_of(one, metric);
    if (mean && (!best || *mean < *best)) best = mean;
  }
  return best;
}

}  // namespace

std::vector<RegimeMap> regime_maps(const StudyResults& results) {
  const StudyDescription& study = results.study;
  std::vector<std::size_t> axes;
  for (std::size_t i = 0; i < study.axes.size(); ++i) {
    if (study.axes[i].labels.size() > 1) axes.push_back(i);
  }
  if (axes.size() < 2) return {};
  std::map<std::vector<std::size_t>, RegimeMap> maps;
  for (const CellResults& cell : results.cells) {
    const std::vector<std::size_t> places = study.places_of(cell.cell);
    std::vector<std::size_t> others = places;
    others[axes[0]] = others[axes[1]] = 0;
    const auto [found, is_new] = maps.try_emplace(others);
    RegimeMap& map = found->second;
    if (is_new) {
      map.across = axes[0];
      map.up = axes[1];
      const std::vector<const CellResults*> column(study.axes[map.up].labels.size(), nullptr);
      map.cells.assign(study.axes[map.across].labels.size(), column);
      for (std::size_t i = 2; i < axes.size(); ++i) {
        const StudyAxis& axis = study.axes[axes[i]];
        map.others += " " + axis.name + " " + axis.labels[places[axes[i]]];
      }
    }
    map.cells[places[map.across]][places[map.up]] = &cell;
  }
  std::vector<RegimeMap> list;
  list.reserve(maps.size());
  for (auto& [others, map] : maps) list.push_back(std::move(map));
  return list;
}

std::optional<double> relative_to_best(const CellResults& cell, const EstimatorResults& estimator,
                                       const std::string& metric) {
  const auto best = best_of(cell, metric);
  const auto mean = mean_of(estimator, metric);
  if (!best || !mean || !(*best > 0.0)) return {};
  return *mean / *best;
}

std::optional<std::string> cheapest_of_the_best(const CellResults& cell, const std::string& metric,
                                                const std::string& cost) {
  const EstimatorResults* cheapest = nullptr;
  for (const EstimatorResults& one : cell.estimators) {
    const auto relative = relative_to_best(cell, one, metric);
    if (!relative || *relative > 1.0 + kAsGoodAsBest || !mean_of(one, cost)) continue;
    if (cheapest == nullptr || *mean_of(one, cost) < *mean_of(*cheapest, cost)) cheapest = &one;
  }
  return cheapest == nullptr ? std::nullopt : std::optional(cheapest->name);
}

}  // namespace fathom
