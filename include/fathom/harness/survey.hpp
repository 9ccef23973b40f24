#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "fathom/configuration/configuration.hpp"
#include "fathom/core/once.hpp"
#include "fathom/datasets/data_set.hpp"
#include "fathom/datasets/noisy_odometry.hpp"
#include "fathom/front_end/pair_registrar.hpp"
#include "fathom/front_end/rendered_pictures.hpp"
#include "fathom/front_end/visual_odometry.hpp"

namespace fathom {

/// An error that begins with a key, "dataset.altitude.base_m: …", with the key's origin in front:
/// "FILE:LINE: dataset.altitude.base_m: …".
InputError at_origin(const Configuration& configuration, const InputError& error);

/// What all trials of a survey share: its pictures, and their registrations. May be used from
/// several threads at once.
class Pictures {
 public:
  /// Opens a survey of the data set, which must be one of pictures. Registrations are looked up in
  /// the cache and kept there, where there is one; it must outlive this. Throws InputError.
  explicit Pictures(const Configuration& configuration, RegistrationCache* cache = nullptr,
                    std::size_t survey = 0);

  const DataSet& data() const { return *data_; }
  /// Rendered pictures of the first survey, of which mosaics are made, are kept in the cache, too.
  const FrameSource& source() const { return rendered_ ? *rendered_ : *data_->frames(); }
  /// Made when first asked for, as some pictures are looked at for what stays in place in them.
  PairRegistrar& registrar();
  /// What is to be said of them: what is masked, which repeat the one before.
  std::vector<std::string> remarks();
  /// What is masked of every picture; empty: nothing.
  const cv::Mat& mask();

 private:
  const PictureUse& use();

  Configuration configuration_;
  RegistrationCache* cache_;
  std::size_t survey_;
  std::unique_ptr<const DataSet> data_;
  std::unique_ptr<RenderedPictures> rendered_;
  Once looked_;
  PictureUse use_;
  Once made_;
  std::unique_ptr<PairRegistrar> registrar_;
};

/// All keys that pictures and their registrations depend on, with their values: configurations of
/// which these are the same may share them, survey by survey.
std::string picture_settings(const Configuration& configuration);

/// Opens a survey of a configuration's data set: what follows from its `survey_seed`. Throws
/// InputError at the origin of the key that is wrong.
std::unique_ptr<const DataSet> open_data_set(const Configuration& configuration,
                                             std::size_t survey = 0);

/// All keys that the data set itself depends on, with their values.
std::string data_settings(const Configuration& configuration);

/// The frames of one trial of a configuration's data set, with dead reckoning whatever its source.
class Survey {
 public:
  /// Trial 0 of survey 0 of a data set of its own. Throws InputError.
  explicit Survey(const Configuration& configuration, RegistrationCache* cache = nullptr);
  /// A trial over pictures that others share. Throws InputError.
  Survey(std::shared_ptr<Pictures> pictures, const Configuration& configuration,
         const TrialNoise& noise);

  /// Frames with dead reckoning: recorded, with noise added or not, simulated, or visual odometry.
  const FrameSource& frames() const;
  /// The same frames as they were measured: without visual odometry or added noise, so that asking
  /// for an altitude costs nothing.
  const FrameSource& measured() const;
  PairRegistrar& registrar() { return pictures_->registrar(); }
  Pictures& pictures() { return *pictures_; }
  /// What compass and positioning system measured of the frames, and what is told of the start.
  const AbsoluteReadings& readings() const { return readings_; }
  const StartOptions& start() const { return start_; }
  bool uses_visual_odometry() const { return visual_odometry_ != nullptr; }
  std::size_t visual_odometry_failures() const;
  /// Visual odometry, where that is what it has, anew with registrations of these.
  void tell(const EstimatedSigmas& sigmas);

 private:
  void open(const Configuration& configuration, const TrialNoise& noise);

  std::shared_ptr<Pictures> pictures_;
  std::unique_ptr<FrameSource> measured_;  ///< where every trial draws dead reckoning
  std::unique_ptr<VisualOdometry> visual_odometry_;
  std::unique_ptr<NoisyOdometry> noisy_odometry_;
  AbsoluteReadings readings_;
  StartOptions start_;
};

}  // namespace fathom
