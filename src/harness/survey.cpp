#include "fathom/harness/survey.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "fathom/datasets/image_folder.hpp"

namespace fathom {
namespace {

std::uint64_t seed_of(const Configuration& configuration) {
  return static_cast<std::uint64_t>(configuration.seed);
}

std::unique_ptr<FrameSource> open_source(const Configuration& configuration) {
  switch (configuration.dataset) {
    case DatasetType::simulated:
      return std::make_unique<SimulatedSurvey>(configuration.simulation, seed_of(configuration));
    case DatasetType::image_folder:
      if (configuration.dataset_path.empty()) {
        throw InputError("dataset.path: say where the image folder is");
      }
      return std::make_unique<ImageFolder>(configuration.dataset_path);
    case DatasetType::g2o:
      break;
  }
  throw InputError("dataset.type: a g2o graph has no pictures; use simulated or image_folder");
}

// Runs an action; "dataset.altitude.base_m: …" becomes "FILE:LINE: dataset.altitude.base_m: …".
template <class Action>
void with_origin(const Configuration& configuration, Action action) {
  try {
    action();
  } catch (const InputError& error) {
    const std::string message = error.what();
    const auto origin = configuration.origins.find(message.substr(0, message.find(':')));
    if (origin == configuration.origins.end()) throw;
    throw InputError(origin->second + ": " + message);
  }
}

// Keys that only say what a trial measures, or what is made of registrations.
bool is_of_a_trial(const std::string& key) {
  constexpr std::array kPrefixes{
      "dataset.odometry.",    "dataset.added_noise.",  "dataset.altitude.altimeter_sigma_m",
      "front_end.keyframes.", "front_end.candidates.", "front_end.visual_odometry."};
  return std::any_of(kPrefixes.begin(), kPrefixes.end(),
                     [&key](const char* prefix) { return key.starts_with(prefix); });
}

}  // namespace

Pictures::Pictures(const Configuration& configuration, RegistrationCache* cache) {
  with_origin(configuration, [&] {
    // A noise that cannot be is said before a folder is opened.
    configuration.added_noise.noise_covariance("dataset.added_noise.");
    source_ = open_source(configuration);
    registrar_ = std::make_unique<PairRegistrar>(*source_, configuration.front_end.features,
                                                 configuration.front_end.registration,
                                                 seed_of(configuration), cache);
  });
}

std::string picture_settings(const Configuration& configuration) {
  std::string text;
  for (const auto& [key, value] : configuration.in_force) {
    const bool counts =
        key == "seed" || key.starts_with("dataset.") || key.starts_with("front_end.");
    if (counts && !is_of_a_trial(key)) text.append(key).append("=").append(value).append("\n");
  }
  return text;
}

Survey::Survey(const Configuration& configuration, RegistrationCache* cache)
    : Survey(std::make_shared<Pictures>(configuration, cache), configuration,
             {seed_of(configuration), 0}) {}

Survey::Survey(std::shared_ptr<Pictures> pictures, const Configuration& configuration,
               const TrialNoise& noise)
    : pictures_(std::move(pictures)) {
  with_origin(configuration, [&] { open(configuration, noise); });
}

void Survey::open(const Configuration& configuration, const TrialNoise& noise) {
  const FrameSource* source = &pictures_->source();
  AddedNoise added{Eigen::Matrix3d::Zero(), noise.seed, noise.trial};
  if (const auto* simulated = dynamic_cast<const SimulatedSurvey*>(source)) {
    const SimulatedSurveyOptions& options = configuration.simulation;
    measured_ = std::make_unique<SimulatedSurvey>(simulated->remeasured(
        options.odometry, options.altitude.altimeter_sigma_m, noise.seed, noise.trial));
    source = measured_.get();
    if (!source->has_odometry()) {
      added.covariance = options.odometry.noise_covariance("dataset.odometry.");
    }
  } else {
    added.covariance = configuration.added_noise.noise_covariance("dataset.added_noise.");
  }
  const bool wants_visual_odometry =
      configuration.dataset == DatasetType::image_folder &&
      configuration.folder_odometry == FolderOdometry::visual_odometry;
  if (!source->has_odometry() || wants_visual_odometry) {
    visual_odometry_ = std::make_unique<VisualOdometry>(
        *source, pictures_->registrar(), configuration.front_end.visual_odometry, added);
  } else if (!added.covariance.isZero(0.0)) {
    noisy_odometry_ = std::make_unique<NoisyOdometry>(*source, added);
  }
}

const FrameSource& Survey::frames() const {
  if (visual_odometry_) return *visual_odometry_;
  if (noisy_odometry_) return *noisy_odometry_;
  return measured();
}

const FrameSource& Survey::measured() const {
  return measured_ ? *measured_ : pictures_->source();
}

std::size_t Survey::visual_odometry_failures() const {
  return visual_odometry_ ? visual_odometry_->failures() : 0;
}

}  // namespace fathom
