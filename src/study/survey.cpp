#include "fathom/study/survey.hpp"

#include "fathom/datasets/image_folder.hpp"

namespace fathom {

namespace {

// "dataset.altitude.base_m: …" becomes "FILE:LINE: dataset.altitude.base_m: …".
[[noreturn]] void rethrow_with_origin(const InputError& error, const Configuration& configuration) {
  const std::string message = error.what();
  const auto origin = configuration.origins.find(message.substr(0, message.find(':')));
  if (origin == configuration.origins.end()) throw InputError(message);
  throw InputError(origin->second + ": " + message);
}

}  // namespace

Survey::Survey(const Configuration& configuration) {
  try {
    open(configuration);
  } catch (const InputError& error) {
    rethrow_with_origin(error, configuration);
  }
}

void Survey::open(const Configuration& configuration) {
  const auto seed = static_cast<std::uint64_t>(configuration.seed);
  AddedNoise noise;
  noise.seed = seed;
  switch (configuration.dataset) {
    case DatasetType::simulated:
      source_ = std::make_unique<SimulatedSurvey>(configuration.simulation, seed);
      if (!source_->has_odometry()) {
        noise.covariance = configuration.simulation.odometry.noise_covariance("dataset.odometry.");
      }
      break;
    case DatasetType::image_folder:
      if (configuration.dataset_path.empty()) {
        throw InputError("dataset.path: say where the image folder is");
      }
      source_ = std::make_unique<ImageFolder>(configuration.dataset_path);
      break;
    case DatasetType::g2o:
      throw InputError("dataset.type: a g2o graph has no pictures; use simulated or image_folder");
  }
  features_ = std::make_unique<FeatureStore>(*source_, configuration.front_end.features);
  if (!source_->has_odometry()) {
    visual_odometry_ = std::make_unique<VisualOdometry>(*source_, *features_,
                                                        configuration.front_end, seed, noise);
  }
}

const FrameSource& Survey::frames() const {
  return visual_odometry_ ? *visual_odometry_ : *source_;
}

std::size_t Survey::visual_odometry_failures() const {
  return visual_odometry_ ? visual_odometry_->failures() : 0;
}

}  // namespace fathom
