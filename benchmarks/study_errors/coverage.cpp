// How often 95 % intervals hold the mean.

#include <cstdio>
#include <vector>

#include "draws.hpp"
#include "fathom/evaluation/clustered.hpp"

namespace fathom::study_errors {

// Of the mean over cells of independent trials, each cell of another mean.
void print_cells(std::size_t repeats, std::uint64_t seed) {
  std::printf("| errors | cells | trials of each | the 95 %% interval holds the mean, %% |\n");
  std::printf("|---|---|---|---|\n");
  for (const Shape shape : {Shape::normal, Shape::skewed, Shape::heavy}) {
    for (const std::size_t cells : {2, 4}) {
      for (const std::size_t trials : {2, 3, 5, 10}) {
        RandomStream random(seed, "coverage over cells");
        std::size_t held = 0;
        for (std::size_t i = 0; i < repeats; ++i) {
          std::vector<std::vector<double>> values(cells, std::vector<double>(trials));
          double mean = 0.0;
          for (std::size_t c = 0; c < cells; ++c) {
            const auto of_cell = static_cast<double>(c + 1);
            mean += of_cell / static_cast<double>(cells);
            for (double& value : values[c]) value = of_cell * drawn(shape, random);
          }
          held += stratified_interval(values)->contains(mean) ? 1 : 0;
        }
        std::printf("| %s | %zu | %zu | %.1f |\n", name_of(shape), cells, trials,
                    percent(held, repeats));
      }
    }
  }
}

// Of means, which are 1.
void print_coverage(std::size_t repeats, std::uint64_t seed) {
  std::printf("| errors | surveys | trials of each | the 95 %% interval holds the mean, %% |\n");
  std::printf("|---|---|---|---|\n");
  struct Size {
    std::size_t surveys;
    std::size_t trials;
  };
  for (const Shape shape : {Shape::normal, Shape::skewed, Shape::heavy}) {
    for (const auto& [surveys, trials] :
         {Size{1, 5}, Size{1, 10}, Size{1, 20}, Size{1, 50}, Size{1, 200}, Size{3, 5}, Size{5, 5},
          Size{10, 5}, Size{20, 5}}) {
      RandomStream random(seed, "coverage");
      std::size_t held = 0;
      for (std::size_t i = 0; i < repeats; ++i) {
        ClusteredValues values;
        for (std::size_t s = 0; s < surveys; ++s) {
          // The only survey is the one that is asked about.
          const double of_survey = surveys > 1 ? drawn(shape, random) : 1.0;
          for (std::size_t t = 0; t < trials; ++t) {
            values[s].push_back(of_survey * drawn(shape, random));
          }
        }
        held += hierarchical_interval(values)->contains(1.0) ? 1 : 0;
      }
      std::printf("| %s | %zu | %zu | %.1f |\n", name_of(shape), surveys, trials,
                  percent(held, repeats));
    }
  }
}

}  // namespace fathom::study_errors
