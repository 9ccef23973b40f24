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

Survey::Survey(const Configuration& configuration, RegistrationCache* cache) {
  try {
    open(configuration, cache);
  } catch (const InputError& error) {
    rethrow_with_origin(error, configuration);
  }
}

void Survey::open(const Configuration& configuration, RegistrationCache* cache) {
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
      noise.covariance = configuration.added_noise.noise_covariance("dataset.added_noise.");
      source_ = std::make_unique<ImageFolder>(configuration.dataset_path);
      break;
    case DatasetType::g2o:
      throw InputError("dataset.type: a g2o graph has no pictures; use simulated or image_folder");
  }
  const FrontEndOptions& options = configuration.front_end;
  registrar_ = std::make_unique<PairRegistrar>(*source_, options.features, options.registration,
                                               seed, cache);
  add_noise(noise, options);
}

void Survey::add_noise(const AddedNoise& noise, const FrontEndOptions& options) {
  if (!source_->has_odometry()) {
    visual_odometry_ =
        std::make_unique<VisualOdometry>(*source_, *registrar_, options.visual_odometry, noise);
  } else if (!noise.covariance.isZero(0.0)) {
    noisy_odometry_ = std::make_unique<NoisyOdometry>(*source_, noise);
  }
}

const FrameSource& Survey::frames() const {
  if (visual_odometry_) return *visual_odometry_;
  if (noisy_odometry_) return *noisy_odometry_;
  return *source_;
}

std::size_t Survey::visual_odometry_failures() const {
  return visual_odometry_ ? visual_odometry_->failures() : 0;
}

}  // namespace fathom
