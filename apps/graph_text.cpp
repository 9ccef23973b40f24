#include "apps/graph_text.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <memory>

#include "fathom/core/text.hpp"
#include "fathom/report/table.hpp"

namespace fathom {

void print_rest(std::size_t count) {
  if (count > kShown) std::printf("    and %zu more\n", count - kShown);
}

void print_components(const GraphSummary& graph) {
  const auto& components = graph.components;
  for (std::size_t i = 0; i < std::min(components.size(), kShown); ++i) {
    std::printf("    %-2zu %s, %lld to %lld\n", i + 1, counted(components[i].poses, "pose").c_str(),
                static_cast<long long>(components[i].first_id),
                static_cast<long long>(components[i].last_id));
  }
  print_rest(components.size());
  std::printf("  borders\n");
  for (std::size_t i = 0; i < std::min(graph.borders.size(), kShown); ++i) {
    std::printf("    between %lld and %lld\n", static_cast<long long>(graph.borders[i].first),
                static_cast<long long>(graph.borders[i].second));
  }
  print_rest(graph.borders.size());
}

void print_priors(const GraphSummary& graph) {
  const PriorSummary& priors = graph.priors;
  std::printf("  priors       %zu: %zu of heading, %zu of position, %zu of both", priors.count(),
              priors.of_heading, priors.of_position, priors.of_both);
  if (priors.of_nothing > 0) std::printf(", %zu without information", priors.of_nothing);
  std::printf("; %s\n", graph.is_start_fixed ? "the first pose is fixed" : "they hold the graph");
  const auto range = [](double smallest, double largest, const char* unit) {
    return format_number(smallest, 3) + " to " + format_number(largest, 3) + unit;
  };
  std::string sigma;
  if (priors.largest_sigma_m > 0.0) {
    sigma = range(priors.smallest_sigma_m, priors.largest_sigma_m, " m");
  }
  if (priors.largest_sigma_rad > 0.0) {
    sigma += (sigma.empty() ? "" : ", ") +
             range(priors.smallest_sigma_rad, priors.largest_sigma_rad, " rad");
  }
  if (!sigma.empty()) std::printf("    sigma      %s\n", sigma.c_str());
}

void print_graph(const GraphSummary& graph) {
  const auto sigma = [](double value) { return format_number(value, 3); };
  std::printf("pose graph\n");
  std::printf("  poses        %zu%s\n", graph.poses,
              graph.vertices == 0 ? ", the file defines no vertices" : "");
  std::printf("  edges        %zu\n", graph.edges);
  std::printf("  odometry     %zu%s\n", graph.odometry_edges,
              graph.holes == 0 ? "" : (", " + counted(graph.holes, "hole")).c_str());
  std::printf("  loops        %zu", graph.loops);
  if (graph.backward_loops > 0) std::printf(", %zu written backwards", graph.backward_loops);
  std::printf("\n  components   %zu\n", graph.components.size());
  if (graph.components.size() > 1) print_components(graph);
  if (graph.priors.count() > 0) print_priors(graph);
  if (graph.edges == 0) return;
  std::printf("  sigma        %s to %s m, %s to %s rad\n", sigma(graph.smallest_sigma_m).c_str(),
              sigma(graph.largest_sigma_m).c_str(), sigma(graph.smallest_sigma_rad).c_str(),
              sigma(graph.largest_sigma_rad).c_str());
}

}  // namespace fathom
