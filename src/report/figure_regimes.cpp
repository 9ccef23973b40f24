#include <algorithm>
#include <cstdio>
#include <map>

#include "fathom/configuration/axis_words.hpp"
#include "ranking.hpp"
#include "regime_map.hpp"
#include "scaled_unit.hpp"
#include "study_figures.hpp"
#include "text_layout.hpp"

namespace fathom {
namespace {

constexpr double kMapHeight = 92.0;
constexpr double kHeading = 10.0;
constexpr double kCellText = 5.5;
constexpr double kLeastText = 3.5;

// What one square shows.
struct Square {
  Shade shade;
  std::string text;
  bool may_be_cut = false;  ///< words; else a figure, of which the colour says it alone
};

// A map by place across, then up.
struct DrawnMap {
  std::string heading;
  std::vector<std::vector<Square>> squares;
};

std::string relative_text(double relative) {
  char text[32];
  if (relative < 9.995) {
    std::snprintf(text, sizeof text, "%.2f", relative);
  } else if (relative < 999.5) {
    std::snprintf(text, sizeof text, "%.0f", relative);
  } else {
    std::snprintf(text, sizeof text, "%.0e", relative);
  }
  return text;
}

Square drawn_square(const EstimatorResults& one, const std::optional<RegimeSquare>& square,
                    const std::string& unit) {
  if (one.failures() > 0) {
    return {shade_of_none(), std::to_string(one.failures()) + " failed", true};
  }
  if (!square) return {shade_of_none(), "–"};
  return {square->shade,
          square->relative ? relative_text(*square->relative) : quantity(square->mean, unit)};
}

// From 1 on, where the colours alone do not tell the estimators apart; else empty.
std::string number_of(const StudyDescription& study, const std::string& estimator) {
  if (study.estimators.size() <= kEstimatorColours) return "";
  const auto found = std::ranges::find(study.estimators, estimator, &StudyEstimator::name);
  return std::to_string(found - study.estimators.begin() + 1);
}

Square choice_square(const CellResults& cell, const std::string& metric, const std::string& cost,
                     const StudyDescription& study,
                     const std::map<std::string, LineStyle>& styles) {
  const auto choice = cheapest_of_the_best(cell, metric, cost);
  if (!choice) return {};
  const std::string number = number_of(study, *choice);
  return {shade_of_choice(styles.at(*choice).colour), number.empty() ? *choice : number, true};
}

template <class SquareOf>
DrawnMap drawn_map(const RegimeMap& map, const std::string& heading, const SquareOf& square_of) {
  DrawnMap drawn{heading, {}};
  for (const auto& column : map.cells) {
    drawn.squares.emplace_back();
    for (const CellResults* cell : column) {
      drawn.squares.back().push_back(cell == nullptr ? Square{} : square_of(*cell));
    }
  }
  return drawn;
}

std::vector<DrawnMap> drawn_maps(const ChartInput& input, const RegimeMap& map,
                                 const std::string& metric, const std::optional<std::string>& cost,
                                 const std::map<std::string, LineStyle>& styles) {
  std::vector<DrawnMap> list;
  const SquareScale scale = scale_over(input.results, map, metric).value_or(SquareScale{});
  for (const auto& [name, type] : input.results.study.estimators) {
    list.push_back(drawn_map(map, name, [&, of = name](const CellResults& cell) {
      const auto one = std::ranges::find(cell.estimators, of, &EstimatorResults::name);
      if (one == cell.estimators.end()) return Square{};
      const auto squares = regime_squares(cell, metric, scale);
      const auto place = static_cast<std::size_t>(one - cell.estimators.begin());
      return drawn_square(*one, squares[place], described(metric).unit);
    }));
  }
  if (cost) {
    list.push_back(drawn_map(map, "cheapest within 5 %", [&](const CellResults& cell) {
      return choice_square(cell, metric, *cost, input.results.study, styles);
    }));
  }
  return list;
}

std::vector<double> numbers_from_0(std::size_t count) {
  std::vector<double> positions;
  for (std::size_t i = 0; i < count; ++i) positions.push_back(static_cast<double>(i));
  return positions;
}

// Squares lie about whole numbers.
ChartAxis square_axis(const StudyAxis& axis) {
  ChartAxis made =
      labelled_axis(title_of(axis), numbers_from_0(axis.labels.size()), axis.labels, 0.0);
  made.low = -0.5;
  made.high = static_cast<double>(axis.labels.size()) - 0.5;
  return made;
}

// As small as it must be, and words shortened.
void draw_square_text(Canvas& canvas, const Square& square, const Eigen::Vector2d& middle,
                      const Eigen::Vector2d& extent) {
  const double needed = text_width(square.text, 1.0);
  const double fitting = std::min({kCellText, extent.x() / needed, extent.y()});
  if (fitting < kLeastText && !square.may_be_cut) return;
  const double size = std::max(fitting, std::min({kLeastText, 0.5 * extent.x(), extent.y()}));
  const std::string text = shortened(square.text, size, extent.x());
  canvas.text(text, middle + Eigen::Vector2d(0.0, 0.35 * size),
              {size, square.shade.ink, TextAlign::centre});
}

void draw_map(Canvas& canvas, const DrawnMap& map, const ChartFrame& frame, const Box& outer) {
  canvas.text(shortened(map.heading, kFontSize, outer.width - 4.0), {outer.left, outer.top - 2.0},
              {kFontSize});
  frame.draw(canvas);  // its grid lies below the squares
  for (std::size_t i = 0; i < map.squares.size(); ++i) {
    for (std::size_t j = 0; j < map.squares[i].size(); ++j) {
      const Square& square = map.squares[i][j];
      const auto x = static_cast<double>(i);
      const auto y = static_cast<double>(j);
      const std::vector<Eigen::Vector2d> corners = frame.at(
          {{x - 0.5, y - 0.5}, {x + 0.5, y - 0.5}, {x + 0.5, y + 0.5}, {x - 0.5, y + 0.5}});
      canvas.area(corners, square.shade.fill);
      canvas.outline(corners, {palette::white, 0.6, {}, 1.0});
      draw_square_text(
          canvas, square, frame.at(x, y),
          {corners[1].x() - corners[0].x() - 1.0, corners[0].y() - corners[2].y() - 1.0});
    }
  }
}

std::string trials_text(const RegimeMap& map) {
  std::vector<const CellResults*> cells;
  for (const auto& column : map.cells) cells.insert(cells.end(), column.begin(), column.end());
  return repeats_of(cells);
}

std::string conditions_of(const StudyResults& results, const RegimeMap& map,
                          const std::string& metric, const std::optional<std::string>& cost) {
  const std::string against = no_ranking_text(results, metric);
  std::string text = described(metric).label + ", mean over trials";
  text += against.empty() ? ", over the best estimator's" : "; no best one is shown: " + against;
  if (cost) text += "; cheapest by " + described(*cost).label + ", mean over trials";
  return text + "; " + trials_text(map) + " a square";
}

std::vector<LegendEntry> legend_of(const StudyDescription& study,
                                   const std::map<std::string, LineStyle>& styles) {
  std::vector<LegendEntry> legend;
  legend.reserve(study.estimators.size());
  for (const auto& [name, type] : study.estimators) {
    const std::string number = number_of(study, name);
    legend.push_back(disc_entry(number.empty() ? name : number + " " + name,
                                shade_of_choice(styles.at(name).colour).fill));
  }
  return legend;
}

StudyFigure regime_figure(const ChartInput& input, const RegimeMap& map,
                          const std::string& metric) {
  const StudyDescription& study = input.results.study;
  // Without a metric that ranks no choice is among the best.
  const bool is_ranked_by = no_ranking_text(input.results, metric).empty();
  const auto cost = is_ranked_by ? first_metric(input.results, true) : std::nullopt;
  const auto styles = line_styles(study);
  const std::vector<DrawnMap> maps = drawn_maps(input, map, metric, cost, styles);
  const FigureLayout layout(std::vector<double>((maps.size() + 1) / 2, kMapHeight + kHeading),
                            legend_of(study, styles),
                            conditions_of(input.results, map, metric, cost));
  std::vector<ChartFrame> frames;
  std::vector<Box> boxes;
  for (std::size_t i = 0; i < maps.size(); ++i) {
    Box box = layout.chart(i / 2);
    box.width /= 2.0;
    if (i % 2 == 1) box.left += box.width;
    box.top += kHeading;
    box.height -= kHeading;
    boxes.push_back(box);
    frames.emplace_back(square_axis(study.axes[map.across]), square_axis(study.axes[map.up]), box);
  }
  return {"", layout.height(), [maps, frames, boxes, layout](Canvas& canvas) {
            for (std::size_t i = 0; i < maps.size(); ++i) {
              draw_map(canvas, maps[i], frames[i], boxes[i]);
            }
            layout.draw_footer(canvas);
          }};
}

}  // namespace

void add_regime_figures(const ChartInput& input, std::vector<StudyFigure>& figures) {
  const auto metric = accuracy_shown(input.results);
  if (!metric || described(*metric).better != Better::lower) return;
  const std::vector<RegimeMap> maps = regime_maps(input.results);
  for (const RegimeMap& map : maps) {
    figures.push_back(regime_figure(input, map, *metric));
    figures.back().name = "regime_map" + map.others;
  }
}

}  // namespace fathom
