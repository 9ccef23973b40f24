// A survey of ten thousand keyframes is held in little memory.

#include <algorithm>
#include <mutex>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "fathom/front_end/front_end.hpp"

namespace fathom {
namespace {

constexpr std::size_t kKeyframes = 10'000;
constexpr std::size_t kLeg = 100;
constexpr int kSide = 48;

/// Legs up and down, one beside the other; every picture is cut from one random texture, so that
/// those of a leg overlap. Keeps what it hands out, to see who else does.
class ManyFrames : public FrameSource {
 public:
  ManyFrames() : handed_out_(kKeyframes) {
    cv::Mat noise(500, 500, CV_8UC1);
    cv::RNG(7).fill(noise, cv::RNG::UNIFORM, 0, 256);
    for (std::size_t i = 0; i < kKeyframes; ++i) {
      const std::size_t along = i % kLeg;
      const bool is_back = i / kLeg % 2 == 1;
      const auto x = static_cast<double>(is_back ? kLeg - 1 - along : along);
      poses_.push_back({0.5 * x, 0.5 * static_cast<double>(i / kLeg), 0.0});
      FrameInfo info{static_cast<std::int64_t>(i), 1.0, std::nullopt, std::nullopt};
      if (i > 0) {
        info.motion =
            UncertainPose{between(poses_[i - 1], poses_[i]), 1e-4 * Eigen::Matrix3d::Identity()};
      }
      infos_.push_back(info);
    }
    // Smooth enough to have features of its own size.
    cv::resize(noise, texture_, {}, 2.0, 2.0, cv::INTER_CUBIC);
  }

  const Pose& pose(std::size_t i) const { return poses_[i]; }
  /// Pictures that somebody still holds.
  std::size_t held() const {
    const std::lock_guard lock(mutex_);
    std::size_t count = 0;
    for (const cv::Mat& picture : handed_out_) {
      if (picture.u != nullptr && __atomic_load_n(&picture.u->refcount, __ATOMIC_RELAXED) > 1)
        ++count;
    }
    return count;
  }

  const Camera& camera() const override { return camera_; }
  std::size_t size() const override { return kKeyframes; }
  const FrameInfo& info(std::size_t i) const override { return infos_[i]; }
  std::uint64_t picture_id(std::size_t i) const override { return i; }
  bool has_odometry() const override { return true; }
  bool has_ground_truth() const override { return false; }
  cv::Mat image(std::size_t i) const override {
    const int along = static_cast<int>(poses_[i].x * 18.0);
    const int beside = static_cast<int>(i / kLeg) * 9;
    // Up in the picture is ahead.
    const cv::Rect part(beside, texture_.rows - kSide - along, kSide, kSide);
    cv::Mat picture = texture_(part).clone();
    const std::lock_guard lock(mutex_);
    handed_out_[i] = picture;
    return picture;
  }

 private:
  static Camera small() {
    CameraModel model;
    model.width = model.height = kSide;
    model.fx = model.fy = 18.0;
    model.cx = model.cy = 0.5 * (kSide - 1);
    return Camera(model);
  }

  Camera camera_ = small();
  cv::Mat texture_;
  std::vector<Pose> poses_;
  std::vector<FrameInfo> infos_;
  mutable std::mutex mutex_;
  mutable std::vector<cv::Mat> handed_out_;
};

class TrueView : public TrajectoryView {
 public:
  explicit TrueView(const ManyFrames& frames) : frames_(frames) {}
  std::size_t size() const override { return frames_.size(); }
  Pose pose(std::size_t k) const override { return frames_.pose(k); }

 private:
  const ManyFrames& frames_;
};

TEST(LongSurvey, FeaturesStayWithinTheirBoundAndPicturesAreNotKept) {
  const ManyFrames frames;
  FrontEndOptions options;
  options.keyframes.separation_frames = 1;
  options.candidates.max_distance_m = 1.1;
  options.candidates.max_per_keyframe = 3;
  options.features.max_features = 30;
  options.registration.ransac.iterations = 20;
  options.registration.ransac.min_inliers = 6;
  options.registration.ransac.min_places = 3;
  options.registration.ransac.max_error_m = 0.1;
  // The neighbours on the leg before are up to two legs back: 200 frames of at most 30 features.
  constexpr std::size_t kBytes = 1'200'000;
  PairRegistrar registrar(frames, options.features, options.registration, 1, nullptr, kBytes);
  FrontEnd front_end(frames, registrar, options);
  const TrueView view(frames);
  std::size_t most_bytes = 0;
  std::size_t most_pictures = 0;
  while (const auto keyframe = front_end.next_keyframe()) {
    front_end.register_newest(view);
    most_bytes = std::max(most_bytes, registrar.feature_bytes());
    if (keyframe->index % 1000 == 999) most_pictures = std::max(most_pictures, frames.held());
  }
  ASSERT_EQ(front_end.keyframes().size(), kKeyframes);
  // On the first leg and at its turn two, those before; then always three.
  EXPECT_EQ(front_end.registrations_tried(), 1 + 2 * (kLeg - 1) + 3 * (kKeyframes - kLeg - 1));
  EXPECT_GT(front_end.registrations_found(), kKeyframes / 2);
  EXPECT_LE(most_bytes, kBytes);
  EXPECT_GT(most_bytes, kBytes / 2);
  // Only what is being extracted at the moment.
  EXPECT_LE(most_pictures, PairRegistrar::look_ahead());
}

}  // namespace
}  // namespace fathom
