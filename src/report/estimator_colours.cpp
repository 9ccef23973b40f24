#include "estimator_colours.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace fathom {
namespace {

// Those that series_colour keeps for the estimators that come with Fathom, and those for others.
constexpr std::array<Colour, 3> kEstimators{palette::blue, palette::vermillion, palette::green};
constexpr std::array<Colour, 3> kOthers{palette::purple, palette::orange, palette::sky_blue};

bool is_of_an_estimator(Colour colour) {
  return std::find(kEstimators.begin(), kEstimators.end(), colour) != kEstimators.end();
}

}  // namespace

std::map<std::string, LineStyle> line_styles(const StudyDescription& study) {
  std::map<std::string, LineStyle> styles{{kDeadReckoning, {palette::grey, false}}};
  std::vector<Colour> taken;
  const auto is_free = [&taken](Colour colour) {
    return std::find(taken.begin(), taken.end(), colour) == taken.end();
  };
  for (std::size_t i = 0; i < study.estimators.size(); ++i) {
    const StudyEstimator& one = study.estimators[i];
    std::vector<Colour> wishes;
    for (const std::string& known : {one.name, one.type}) {
      if (is_of_an_estimator(series_colour(known))) wishes.push_back(series_colour(known));
    }
    wishes.insert(wishes.end(), kOthers.begin(), kOthers.end());
    wishes.insert(wishes.end(), kEstimators.begin(), kEstimators.end());
    const auto found = std::find_if(wishes.begin(), wishes.end(), is_free);
    const bool used_up = found == wishes.end();
    styles[one.name] = {used_up ? wishes[i % wishes.size()] : *found, used_up};
    taken.push_back(styles[one.name].colour);
  }
  return styles;
}

}  // namespace fathom
