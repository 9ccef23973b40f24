// What the test of the strongest features (decision.first_features) keeps and saves, over all pairs
// of the pictures of some folders, on one thread:
//
//     first_features DIR... [--set KEY=VALUE]      # an option below front_end
//
// A row a folder: its name, pictures, accepted pairs that stay, other pairs told at first, and the
// mean processor time of both kinds without and with the test.

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <string>
#include <vector>

#include <opencv2/core/utility.hpp>

#include "fathom/core/input_error.hpp"
#include "fathom/core/pin_threads.hpp"
#include "fathom/datasets/image_folder.hpp"
#include "fathom/front_end/options.hpp"
#include "fathom/vision/registration.hpp"

namespace fathom::benchmarks {
namespace {

struct Kind {
  int pairs = 0;
  int alike = 0;  ///< accepted that stay, or others told at first
  double without_ms = 0.0;
  double with_ms = 0.0;

  double mean(double sum_ms) const { return sum_ms / std::max(1, pairs); }
};

double processor_ms() {
  return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

std::vector<FloorFeatures> features_of(const ImageFolder& folder, const FrontEndOptions& options) {
  const FeatureExtractor extractor(options.features, options.registration.tuning.features);
  std::vector<FloorFeatures> features;
  for (std::size_t i = 0; i < folder.size(); ++i) {
    features.push_back(
        on_floor(extractor.extract(folder.image(i)), folder.camera(), folder.info(i).altitude_m));
  }
  return features;
}

void measure(const std::string& path, const FrontEndOptions& options) {
  const std::vector<FloorFeatures> pictures = features_of(ImageFolder(path), options);
  const RegistrationOptions& with = options.registration;
  RegistrationOptions without = with;
  without.decision.first_features.reset();
  Kind accepted;
  Kind others;
  for (std::size_t k = 0; k < pictures.size(); ++k) {
    for (std::size_t i = 0; i < k; ++i) {
      const double start_ms = processor_ms();
      const Registration all = register_pair(pictures[i], pictures[k], without, 1);
      const double middle_ms = processor_ms();
      const Registration first = register_pair(pictures[i], pictures[k], with, 1);
      Kind& kind = all.found ? accepted : others;
      ++kind.pairs;
      kind.without_ms += middle_ms - start_ms;
      kind.with_ms += processor_ms() - middle_ms;
      const bool is_told = first.reason.find("strongest features") != std::string::npos;
      kind.alike += all.found ? static_cast<int>(first.found && first.motion == all.motion)
                              : static_cast<int>(is_told);
    }
  }
  std::printf("| %s | %zu | %d of %d | %d of %d | %.1f | %.1f | %.1f | %.1f |\n", path.c_str(),
              pictures.size(), accepted.alike, accepted.pairs, others.alike, others.pairs,
              others.mean(others.without_ms), others.mean(others.with_ms),
              accepted.mean(accepted.without_ms), accepted.mean(accepted.with_ms));
}

int run(const std::vector<std::string>& arguments) {
  FrontEndOptions options;
  OptionTable table;
  options.describe(table);
  std::vector<std::string> folders;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i] != "--set" || i + 1 == arguments.size()) {
      folders.push_back(arguments[i]);
      continue;
    }
    const std::string& setting = arguments[++i];
    const std::size_t equals = setting.find('=');
    table.set(setting.substr(0, equals), OptionValue::scalar(setting.substr(equals + 1)));
  }
  pin_threads();
  cv::setNumThreads(1);
  for (const std::string& folder : folders) measure(folder, options);
  return 0;
}

}  // namespace
}  // namespace fathom::benchmarks

int main(int argc, char** argv) {
  try {
    return fathom::benchmarks::run({argv + 1, argv + argc});
  } catch (const fathom::InputError& error) {
    std::fprintf(stderr, "first_features: %s\n", error.what());
    return 2;
  }
}
