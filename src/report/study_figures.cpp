#include "study_figures.hpp"

#include <algorithm>
#include <cctype>

#include "fathom/evaluation/metrics.hpp"

namespace fathom {

std::string figure_name(const std::string& what, const std::string& label, bool alone) {
  if (alone) return what;
  std::string name = what + "_";
  for (const char letter : label) {
    const bool plain =
        std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '.' || letter == '-';
    if (plain) {
      name += letter;
    } else if (name.back() != '_') {
      name += '_';
    }
  }
  if (name.back() == '_') name.pop_back();
  return name;
}

Box axes_box(double height) {
  return {38.0, 8.0, kFigureWidth - 38.0 - 10.0, height - 8.0 - 66.0};
}

void draw_footer(VectorCanvas& canvas, const Box& axes,
                 const std::vector<FigureLegendEntry>& entries, const std::string& conditions) {
  constexpr double kMargin = 8.0;
  const double top = axes.bottom() + 3.5 * kFontSize;
  const double taken =
      draw_figure_legend(canvas, entries, {kMargin, top}, kFigureWidth - 2.0 * kMargin);
  // A long label of a cell is set smaller rather than cut.
  const double width = canvas.text_width(conditions, 6.0);
  const double size = 6.0 * std::min(1.0, (kFigureWidth - 2.0 * kMargin) / std::max(1.0, width));
  canvas.text(conditions, {kMargin, top + taken + 3.0}, size, kSoftInk);
}

std::optional<std::string> first_metric(const StudyResults& results, bool cost) {
  const auto& wanted = results.study.metrics;
  const auto found = std::find_if(wanted.begin(), wanted.end(), [&](const std::string& name) {
    return is_cost_metric(name) == cost &&
           std::find(results.metrics.begin(), results.metrics.end(), name) != results.metrics.end();
  });
  return found == wanted.end() ? std::nullopt : std::optional(*found);
}

std::vector<StudyFigure> study_figures(const FigureInput& input) {
  std::vector<StudyFigure> figures;
  add_sweep_figures(input, figures);
  add_nees_figures(input, figures);
  add_trajectory_figures(input, figures);
  add_cost_figures(input, figures);
  // Labels may differ in nothing that a file's name can have.
  std::set<std::string> names;
  for (StudyFigure& figure : figures) {
    const std::string name = figure.name;
    for (int i = 2; !names.insert(figure.name).second; ++i) {
      figure.name = name + "-" + std::to_string(i);
    }
  }
  return figures;
}

}  // namespace fathom
