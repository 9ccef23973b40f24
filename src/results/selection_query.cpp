#include "selection_query.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <set>

#include "fathom/core/options.hpp"
#include "fathom/core/text.hpp"

namespace fathom {
namespace {

// The nearest word, or all there are where none is near. No number is another one misspelt.
std::string hint(const std::string& word, const std::vector<std::string>& among) {
  const std::string near = parse_real(word) ? "" : suggestion(word, among);
  return near.empty() ? "; there are " + joined(among, ", ") : near;
}

std::size_t axis_of(const StudyDescription& study, const std::string& text,
                    const std::string& word) {
  std::vector<std::string> known;
  for (const StudyAxis& axis : study.axes) known.push_back(axis.name);
  for (const StudyAxis& axis : study.axes) known.push_back(axis.key);
  const auto found = std::find(known.begin(), known.end(), word);
  if (found == known.end()) {
    throw InputError("--where " + in_quotes(text) + ": " +
                     (study.axes.empty() ? "the study has no sweep"
                                         : "no axis is called '" + word + "'" + hint(word, known)));
  }
  return static_cast<std::size_t>(found - known.begin()) % study.axes.size();
}

std::size_t place_of(const StudyAxis& axis, const std::string& text, const std::string& label) {
  const auto found = std::find(axis.labels.begin(), axis.labels.end(), label);
  if (found == axis.labels.end()) {
    throw InputError(fmt::format("--where {}: {} is never '{}'{}", in_quotes(text), axis.name,
                                 label, hint(label, axis.labels)));
  }
  return static_cast<std::size_t>(found - axis.labels.begin());
}

void require_metric(const std::string& name, const StudyDescription& study,
                    const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), name) != known.end()) return;
  const std::string near = suggestion(name, known);
  if (!near.empty()) throw InputError("unknown metric '" + name + "'" + near);
  // Of some fifty, those that the study's tables show.
  std::vector<std::string> some;
  for (const std::string& metric : study.metrics) {
    if (std::find(known.begin(), known.end(), metric) != known.end()) some.push_back(metric);
  }
  throw InputError("unknown metric '" + name + "'; there are " +
                   (some.empty() ? joined(known, ", ") : joined(some, ", ") + " and others"));
}

}  // namespace

bool Requirement::holds(double value) const {
  switch (relation) {
    case Relation::at_most:
      return value <= bound;
    case Relation::below:
      return value < bound;
    case Relation::at_least:
      return value >= bound;
    case Relation::above:
      break;
  }
  return value > bound;
}

bool Requirement::is_upper_bound() const {
  return relation == Relation::at_most || relation == Relation::below;
}

std::string Requirement::text() const {
  const bool is_strict = relation == Relation::below || relation == Relation::above;
  return metric + (is_upper_bound() ? " <" : " >") + (is_strict ? " " : "= ") + number_text(bound);
}

Requirement parse_requirement(const std::string& text) {
  const auto refuse_it = [&text]() {
    throw InputError("requirement " + in_quotes(text) +
                     ": expected METRIC, one of <=, <, >= and >, and a number, for example "
                     "'mean_position_error_m <= 0.1'");
  };
  const std::size_t sign = text.find_first_of("<>");
  if (sign == std::string::npos) refuse_it();
  const bool is_strict = sign + 1 >= text.size() || text[sign + 1] != '=';
  Requirement requirement;
  requirement.metric = trim(text.substr(0, sign));
  if (text[sign] == '<') {
    requirement.relation = is_strict ? Relation::below : Relation::at_most;
  } else {
    requirement.relation = is_strict ? Relation::above : Relation::at_least;
  }
  const auto bound = parse_real(trim(text.substr(sign + (is_strict ? 1 : 2))));
  // "a => 1" and "a b <= 1": no metric has such a name.
  if (!bound || requirement.metric.empty() ||
      requirement.metric.find_first_of("= \t") != std::string::npos) {
    refuse_it();
  }
  requirement.bound = *bound;
  return requirement;
}

std::vector<std::size_t> cells_where(const StudyDescription& study,
                                     const std::vector<std::string>& where) {
  std::vector<std::set<std::size_t>> allowed(study.axes.size());
  for (const std::string& text : where) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) {
      throw InputError("--where " + in_quotes(text) +
                       ": expected AXIS=LABEL, for example separation=10");
    }
    const std::size_t axis = axis_of(study, text, std::string(trim(text.substr(0, equals))));
    const std::string label(trim(text.substr(equals + 1)));
    allowed[axis].insert(place_of(study.axes[axis], text, label));
  }
  std::vector<std::size_t> cells;
  for (std::size_t cell = 0; cell < study.cell_count(); ++cell) {
    const std::vector<std::size_t> places = study.places_of(cell);
    bool is_in = true;
    for (std::size_t a = 0; a < places.size(); ++a) {
      is_in = is_in && (allowed[a].empty() || allowed[a].contains(places[a]));
    }
    if (is_in) cells.push_back(cell);
  }
  return cells;
}

void require_metrics(const SelectionQuery& query, const StudyDescription& study,
                     const std::vector<std::string>& known) {
  for (const Requirement& requirement : query.requirements) {
    require_metric(requirement.metric, study, known);
  }
  require_metric(query.objective, study, known);
}

}  // namespace fathom
