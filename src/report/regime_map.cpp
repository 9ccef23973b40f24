#include "regime_map.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "contenders.hpp"
#include "ranking.hpp"

namespace fathom {
namespace {

// Nothing of dead reckoning, which is no choice, and of an estimator that failed a trial: its mean
// leaves out the hardest ones.
std::optional<double> mean_of(const EstimatorResults& one, const std::string& metric) {
  const auto found = one.metrics.find(metric);
  if (one.name == kDeadReckoning || one.failures() > 0 || found == one.metrics.end()) return {};
  return found->second.moments.mean;
}

constexpr double kDarkest = 10.0;  // as many times the best mean, and more

Shade shade_of(double share) {
  return {tint(palette::blue, 0.06 + 0.94 * share), share > 0.5 ? palette::white : palette::black};
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

std::map<std::string, double> relative_to_best(const CellResults& cell, const std::string& metric) {
  std::map<std::string, double> relative;
  if (described(metric).better != Better::lower) return relative;
  const Contenders compared = contenders_of(cell, metric);
  if (compared.order.empty() || !(compared.order.front().mean > 0.0)) return relative;
  for (const Contender& entry : compared.order) {
    relative[entry.one->name] = entry.mean / compared.order.front().mean;
  }
  return relative;
}

std::vector<std::string> as_good_as_best(const CellResults& cell, const std::string& metric) {
  std::vector<std::string> names;
  if (described(metric).better != Better::lower) return names;
  const Contenders compared = contenders_of(cell, metric);
  if (compared.order.empty()) return names;
  const double best = compared.order.front().mean;
  // The best may be 0, as F above its optimum.
  const double most = best + std::max(kAsGoodAsBest * std::abs(best), least_difference(metric));
  for (const Contender& entry : compared.order) {
    if (entry.mean <= most) names.push_back(entry.one->name);
  }
  return names;
}

Shade shade_of_none() {
  return {tint(palette::grey, 0.35), palette::black};
}

Shade shade_of_choice(Colour colour) {
  return {tint(colour, 0.55), palette::black};
}

std::optional<SquareScale> scale_over(const StudyResults& results, const RegimeMap& map,
                                      const std::string& metric) {
  std::optional<SquareScale> scale;
  const bool is_relative =
      described(metric).better == Better::lower && no_ranking_text(results, metric).empty();
  for (const auto& column : map.cells) {
    for (const CellResults* cell : column) {
      if (cell == nullptr) continue;
      for (const EstimatorResults& one : cell->estimators) {
        const auto mean = mean_of(one, metric);
        if (!mean) continue;
        if (!scale) scale = SquareScale{is_relative, *mean, *mean};
        scale->least = std::min(scale->least, *mean);
        scale->most = std::max(scale->most, *mean);
      }
    }
  }
  return scale;
}

std::vector<std::optional<RegimeSquare>> regime_squares(const CellResults& cell,
                                                        const std::string& metric,
                                                        const SquareScale& scale) {
  std::vector<std::optional<RegimeSquare>> squares;
  const Contenders compared = scale.is_relative ? contenders_of(cell, metric) : Contenders{};
  const double best = compared.order.empty() ? 0.0 : compared.order.front().mean;
  for (const EstimatorResults& one : cell.estimators) {
    auto mean = mean_of(one, metric);
    if (scale.is_relative) {
      const Contender* contender = compared.find(one.name);
      mean = contender ? std::optional(contender->mean) : std::nullopt;
    }
    auto& square = squares.emplace_back();
    if (!mean) continue;
    square = RegimeSquare{*mean, std::nullopt, {}};
    double share = 0.0;
    if (best > 0.0) {
      square->relative = *mean / best;
      share = std::clamp(std::log(*square->relative) / std::log(kDarkest), 0.0, 1.0);
    } else if (scale.most > scale.least) {
      share = std::clamp((*mean - scale.least) / (scale.most - scale.least), 0.0, 1.0);
    }
    square->shade = shade_of(share);
  }
  return squares;
}

std::optional<std::string> cheapest_of_the_best(const CellResults& cell, const std::string& metric,
                                                const std::string& cost) {
  const std::vector<std::string> good = as_good_as_best(cell, metric);
  if (good.empty()) return std::nullopt;
  const Contenders by_cost = contenders_of(cell, cost, good);
  return by_cost.order.empty() ? std::nullopt : std::optional(by_cost.order.front().one->name);
}

}  // namespace fathom
