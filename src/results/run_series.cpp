#include "fathom/results/run_series.hpp"

#include <cmath>
#include <fmt/format.h>

#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"

namespace fathom {

double number_of(double entry) {
  return entry;
}

double number_of(std::size_t entry) {
  return static_cast<double>(entry);
}

double number_of(bool entry) {
  return entry ? 1.0 : 0.0;
}

double number_of(LoopFate entry) {
  return static_cast<double>(entry);
}

double number_of(const std::optional<double>& entry) {
  return entry.value_or(-1.0);
}

bool read_number(double number, double& entry) {
  entry = number;
  return true;
}

bool read_number(double number, std::size_t& entry) {
  constexpr double kLargestExact = 9007199254740992.0;  // 2^53
  if (!(number >= 0.0 && number <= kLargestExact && number == std::floor(number))) return false;
  entry = static_cast<std::size_t>(number);
  return true;
}

bool read_number(double number, LoopFate& entry) {
  for (const LoopFate fate : {LoopFate::used, LoopFate::rejected, LoopFate::lost}) {
    if (number != number_of(fate)) continue;
    entry = fate;
    return true;
  }
  return false;
}

bool read_number(double number, std::optional<double>& entry) {
  if (number >= 0.0) entry = number;
  return true;
}

void refuse_entry(const ResultStore& store, const RunKey& key, const char* series, double number) {
  throw InputError(store.file().string(),
                   fmt::format("series {} of {} has an entry of {}, which 'fathom compare' does "
                               "not write; run the study again, into another folder",
                               series, key.estimator, number_text(number)));
}

}  // namespace fathom
