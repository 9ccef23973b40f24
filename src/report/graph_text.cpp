#include "fathom/report/graph_text.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "fathom/core/text.hpp"
#include "fathom/report/table.hpp"

namespace fathom {
namespace {

std::string rest_text(std::size_t count) {
  return count > kMostShown ? fmt::format("    and {} more\n", count - kMostShown) : "";
}

std::string components_text(const GraphSummary& graph) {
  const auto& components = graph.components;
  std::string text;
  for (std::size_t i = 0; i < std::min(components.size(), kMostShown); ++i) {
    text += fmt::format("    {:<2} {}, {} to {}\n", i + 1, counted(components[i].poses, "pose"),
                        components[i].first_id, components[i].last_id);
  }
  text += rest_text(components.size()) + "  borders\n";
  for (std::size_t i = 0; i < std::min(graph.borders.size(), kMostShown); ++i) {
    text += fmt::format("    between {} and {}\n", graph.borders[i].first, graph.borders[i].second);
  }
  return text + rest_text(graph.borders.size());
}

std::string range_text(double smallest, double largest, const char* unit) {
  return fmt::format("{} to {} {}", format_number(smallest, 3), format_number(largest, 3), unit);
}

std::string priors_text(const GraphSummary& graph) {
  const PriorSummary& priors = graph.priors;
  std::string text =
      fmt::format("  priors       {}: {} of heading, {} of position, {} of both", priors.count(),
                  priors.of_heading, priors.of_position, priors.of_both);
  if (priors.of_nothing > 0) text += fmt::format(", {} without information", priors.of_nothing);
  text += graph.is_start_fixed ? "; the first pose is fixed\n" : "; they hold the graph\n";
  std::vector<std::string> sigma;
  if (priors.largest_sigma_m > 0.0) {
    sigma.push_back(range_text(priors.smallest_sigma_m, priors.largest_sigma_m, "m"));
  }
  if (priors.largest_sigma_rad > 0.0) {
    sigma.push_back(range_text(priors.smallest_sigma_rad, priors.largest_sigma_rad, "rad"));
  }
  if (!sigma.empty()) text += fmt::format("    sigma      {}\n", joined(sigma, ", "));
  return text;
}

}  // namespace

std::string graph_text(const GraphSummary& graph) {
  std::string text = fmt::format("pose graph\n  poses        {}{}\n", graph.poses,
                                 graph.vertices == 0 ? ", the file defines no vertices" : "");
  text += fmt::format("  edges        {}\n  odometry     {}{}\n", graph.edges, graph.odometry_edges,
                      graph.holes == 0 ? "" : ", " + counted(graph.holes, "hole"));
  text += fmt::format("  loops        {}", graph.loops);
  if (graph.backward_loops > 0) text += fmt::format(", {} written backwards", graph.backward_loops);
  text += fmt::format("\n  components   {}\n", graph.components.size());
  if (graph.components.size() > 1) text += components_text(graph);
  if (graph.priors.count() > 0) text += priors_text(graph);
  if (graph.edges == 0) return text;
  return text + fmt::format("  sigma        {}, {}\n",
                            range_text(graph.smallest_sigma_m, graph.largest_sigma_m, "m"),
                            range_text(graph.smallest_sigma_rad, graph.largest_sigma_rad, "rad"));
}

}  // namespace fathom
