#include "fathom/harness/survey.hpp"

#include <filesystem>
#include <set>
#include <system_error>
#include <utility>
#include <vector>

#include "fathom/core/random.hpp"
#include "fathom/core/text.hpp"

namespace fathom {

InputError at_origin(const Configuration& configuration, const InputError& error) {
  const std::string message = error.what();
  const std::string key = message.substr(0, message.find(':'));
  auto origin = configuration.origins.find(key);
  // What is not given is missed by what is.
  if (origin == configuration.origins.end() && key == "dataset.path") {
    origin = configuration.origins.find("dataset.type");
  }
  if (origin == configuration.origins.end()) return error;
  return InputError(origin->second + ": " + message);
}

namespace {

std::uint64_t seed_of(const Configuration& configuration, std::size_t survey) {
  return survey_seed(static_cast<std::uint64_t>(configuration.seed), survey);
}

// Runs an action; its errors name the origin of their key.
template <class Action>
void with_origin(const Configuration& configuration, Action action) {
  try {
    action();
  } catch (const InputError& error) {
    throw at_origin(configuration, error);
  }
}

// Says where it was looked for. A path on the command line is its own origin.
void require_path(const Configuration& configuration) {
  namespace fs = std::filesystem;
  const auto given = configuration.dataset.values.find("path");
  const auto origin = configuration.origins.find("dataset.path");
  if (given == configuration.dataset.values.end() || origin == configuration.origins.end()) return;
  const fs::path path = given->second.text();
  std::error_code error;
  if (path.empty() || path == origin->second || fs::exists(path, error) || error) return;
  const std::string base =
      path.is_absolute() ? ""
                         : "; paths start at the working folder, " + fs::current_path().string();
  throw InputError("dataset.path: there is no " + in_quotes(path.string()) + base);
}

void require_pictures(const Configuration& configuration) {
  if (!find_data_set(configuration.dataset.type).is_graph) return;
  std::string others;
  for (const DataSetEntry& entry : data_sets()) {
    if (!entry.is_graph) others += (others.empty() ? "" : " or ") + entry.name;
  }
  throw InputError("dataset.type: a " + configuration.dataset.type +
                   " graph has no pictures; use " + others);
}

void insert_keys(std::set<std::string>& keys, const std::string& group,
                 const std::vector<OptionDescription>& options) {
  for (const OptionDescription& option : options) keys.insert(group + "." + option.key);
}

std::set<std::string> keys_of_data(const Configuration& configuration) {
  const DataSetEntry& entry = find_data_set(configuration.dataset.type);
  std::set<std::string> of_a_trial;
  insert_keys(of_a_trial, "dataset", entry.trial_options);
  std::set<std::string> keys{"seed", "dataset.type"};
  insert_keys(keys, "dataset", entry.options);
  std::erase_if(keys, [&](const std::string& key) { return of_a_trial.contains(key); });
  return keys;
}

std::string settings_text(const Configuration& configuration, const std::set<std::string>& keys) {
  std::string text;
  for (const auto& [key, value] : configuration.in_force) {
    if (keys.contains(key)) text.append(key).append("=").append(value).append("\n");
  }
  return text;
}

}  // namespace

std::unique_ptr<const DataSet> open_data_set(const Configuration& configuration,
                                             std::size_t survey) {
  std::unique_ptr<const DataSet> data;
  with_origin(configuration, [&] {
    const DataSetEntry& entry = find_data_set(configuration.dataset.type);
    try {
      data = entry.open(configuration.dataset.values, seed_of(configuration, survey));
    } catch (const InputError& error) {
      if (!std::string(error.what()).starts_with("dataset.")) require_path(configuration);
      throw;
    }
  });
  return data;
}

Pictures::Pictures(const Configuration& configuration, RegistrationCache* cache, std::size_t survey)
    : configuration_(configuration), cache_(cache), survey_(survey) {
  with_origin(configuration, [&] { require_pictures(configuration); });
  data_ = open_data_set(configuration, survey);
  const bool is_drawn = find_data_set(configuration.dataset.type).makes_pictures;
  if (!is_drawn || survey > 0 || cache == nullptr || cache->pictures() == nullptr) return;
  rendered_ = std::make_unique<RenderedPictures>(*data_->frames(), *cache->pictures());
}

const PictureUse& Pictures::use() {
  // A simulator draws the floor alone; its pictures take long.
  const bool is_drawn = find_data_set(configuration_.dataset.type).makes_pictures;
  const MaskUse mask = is_drawn ? MaskUse::off : configuration_.front_end.mask;
  looked_.call([&] { use_ = picture_use(source(), mask); });
  return use_;
}

PairRegistrar& Pictures::registrar() {
  made_.call([&] {
    with_origin(configuration_, [&] {
      registrar_ = std::make_unique<PairRegistrar>(
          source(), configuration_.front_end.features, configuration_.front_end.registration,
          seed_of(configuration_, survey_), cache_, PairRegistrar::kFeatureBytes, use());
    });
  });
  return *registrar_;
}

std::vector<std::string> Pictures::remarks() {
  return remarks_on(use(), source());
}

const cv::Mat& Pictures::mask() {
  return use().mask;
}

std::string data_settings(const Configuration& configuration) {
  return settings_text(configuration, keys_of_data(configuration));
}

std::string picture_settings(const Configuration& configuration) {
  std::set<std::string> keys = keys_of_data(configuration);
  FrontEndOptions front_end;
  OptionTable of_registrations;
  front_end.describe_registration(of_registrations);
  insert_keys(keys, "front_end", of_registrations.descriptions());
  return settings_text(configuration, keys);
}

Survey::Survey(const Configuration& configuration, RegistrationCache* cache)
    : Survey(std::make_shared<Pictures>(configuration, cache), configuration,
             {seed_of(configuration, 0), 0}) {}

Survey::Survey(std::shared_ptr<Pictures> pictures, const Configuration& configuration,
               const TrialNoise& noise)
    : pictures_(std::move(pictures)) {
  with_origin(configuration, [&] { open(configuration, noise); });
}

void Survey::open(const Configuration& configuration, const TrialNoise& noise) {
  Trial trial = pictures_->data().trial(configuration.dataset.values, noise);
  measured_ = std::move(trial.frames);
  readings_ = std::move(trial.absolute);
  start_ = trial.start;
  const AddedNoise added{trial.added_noise, noise.seed, noise.trial};
  if (!measured().has_odometry() || trial.visual_odometry) {
    visual_odometry_ = std::make_unique<VisualOdometry>(
        measured(), pictures_->registrar(), configuration.front_end.visual_odometry, added);
  } else if (!added.covariance.isZero(0.0)) {
    noisy_odometry_ = std::make_unique<NoisyOdometry>(measured(), added);
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

void Survey::tell(const EstimatedSigmas& sigmas) {
  if (visual_odometry_) visual_odometry_ = visual_odometry_->told(sigmas);
}

std::size_t Survey::visual_odometry_failures() const {
  return visual_odometry_ ? visual_odometry_->failures() : 0;
}

}  // namespace fathom
