#include "fathom/front_end/registration_key.hpp"

#include <opencv2/core/utility.hpp>

namespace fathom {
namespace {

void add_options(Hash& hash, FeatureOptions& features, RegistrationOptions& registration) {
  OptionTable table;
  table.group("features", features);
  registration.describe(table);
  for (const std::string& key : table.keys()) hash.add(key).add(table.value(key));
}

void add_mask(Hash& hash, const cv::Mat& mask) {
  if (mask.empty()) return;
  hash.add("mask").add(mask.cols).add(mask.rows);
  const cv::Mat whole = mask.isContinuous() ? mask : mask.clone();
  hash.add(std::string_view(reinterpret_cast<const char*>(whole.data), whole.total()));
}

// A picture without roll and pitch has no more words, so that its keys are what they always were;
// likewise one whose altimeter states no precision.
void add_measured(Hash& hash, const char* picture, const SeenPicture& seen) {
  if (const auto& measured = seen.tilt) {
    hash.add("tilt").add(picture).add(measured->tilt.roll_rad).add(measured->tilt.pitch_rad);
    hash.add(measured->sigma_rad);
  }
  if (seen.altitude_sigma_m > 0.0) {
    hash.add("altitude sigma").add(picture).add(seen.altitude_sigma_m);
  }
}

}  // namespace

RegistrationKeys::RegistrationKeys(const CameraModel& camera, FeatureOptions features,
                                   RegistrationOptions registration, const cv::Mat& mask)
    : first_(1), second_(2) {
  for (Hash* hash : {&first_, &second_}) {
    hash->add("registration").add(kRegistrationVersion).add(cv::getVersionString());
    camera.add_to(*hash);
    add_options(*hash, features, registration);
    add_mask(*hash, mask);
  }
}

RegistrationKey RegistrationKeys::of(const SeenPicture& from, const SeenPicture& to,
                                     std::uint64_t pair_seed) const {
  const auto finished = [&](Hash hash) {
    hash.add(from.picture_id).add(from.altitude_m).add(to.picture_id).add(to.altitude_m);
    hash.add(pair_seed);
    add_measured(hash, "from", from);
    add_measured(hash, "to", to);
    return hash.value();
  };
  return {finished(first_), finished(second_)};
}

FeatureKeys::FeatureKeys(FeatureOptions features, FeatureTuning tuning, const cv::Mat& mask)
    : first_(1), second_(2) {
  OptionTable table;
  table.group("features", features);
  table.group("tuning", tuning);
  for (Hash* hash : {&first_, &second_}) {
    hash->add("features").add(kRegistrationVersion).add(cv::getVersionString());
    for (const std::string& key : table.keys()) hash->add(key).add(table.value(key));
    add_mask(*hash, mask);
  }
}

RegistrationKey FeatureKeys::of(std::uint64_t picture_id) const {
  return {Hash(first_).add(picture_id).value(), Hash(second_).add(picture_id).value()};
}

}  // namespace fathom
