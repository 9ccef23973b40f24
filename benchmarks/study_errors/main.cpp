// How often a study's statistics are wrong, on drawn studies whose truth is known: how often one of
// several exchangeable estimators is called worse, how often one that is off by the margin is
// called equivalent, or one that is off in rare trials alone, and how often a 95 % interval holds
// the mean. Prints Markdown tables.
//
//   study_errors [--repeats N] [--seed S] [--table worse|equivalent|rare|coverage|cells]

#include <cstdint>
#include <cstdio>
#include <exception>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "draws.hpp"

namespace fathom::study_errors {
namespace {

int run(int argc, const char* const* argv) {
  std::size_t repeats = 1000;
  std::uint64_t seed = 1;
  std::string only;
  CLI::App app{"Error rates of verdicts and coverage of intervals, on drawn studies."};
  app.add_option("--repeats", repeats, "studies a row")->check(CLI::PositiveNumber);
  app.add_option("--seed", seed, "of the draws");
  app.add_option("--table", only, "this one alone")
      ->check(CLI::IsMember({"worse", "equivalent", "rare", "coverage", "cells"}));
  CLI11_PARSE(app, argc, argv);
  using Print = void (*)(std::size_t, std::uint64_t);
  const std::vector<std::pair<std::string, Print>> tables{{"worse", print_worse},
                                                          {"equivalent", print_equivalent},
                                                          {"rare", print_rare},
                                                          {"coverage", print_coverage},
                                                          {"cells", print_cells}};
  for (const auto& [name, print] : tables) {
    if (!only.empty() && only != name) continue;
    if (only.empty() && name != "worse") std::printf("\n");
    print(repeats, seed);
  }
  return 0;
}

}  // namespace
}  // namespace fathom::study_errors

int main(int argc, char** argv) try {
  return fathom::study_errors::run(argc, argv);
} catch (const std::exception& error) {
  std::fprintf(stderr, "study_errors: error: %s\n", error.what());
  return 1;
}
