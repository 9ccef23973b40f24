#pragma once

#include <memory>

#include "fathom/core/files.hpp"
#include "fathom/datasets/import.hpp"
#include "support/bags/bag_writer.hpp"
#include "support/fuzz.hpp"

namespace fathom::fuzz {

/// A survey of three pictures of 4×3 pixels, with altitudes and odometry.
inline void write_small_bag(test::BagWriter& bag) {
  constexpr std::int64_t kBegin = 1'700'000'000'000'000'000;
  for (int i = 0; i < 3; ++i) {
    const std::int64_t at = kBegin + 1'000'000'000LL * i;
    const test::Stamps stamps{at + 1'000'000, at};
    test::RawImage image;
    image.height = 3;
    image.width = 4;
    image.step = 4;
    image.data.assign(12, static_cast<std::uint8_t>(40 * i));
    bag.image("/camera/image_raw", stamps, image);
    test::CameraInformation camera;
    camera.height = 3;
    camera.width = 4;
    camera.D.assign(5, 0.0);
    camera.K = {5.0, 0.0, 1.5, 0.0, 5.0, 1.0, 0.0, 0.0, 1.0};
    camera.P = {5.0, 0.0, 1.5, 0.0, 0.0, 5.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0};
    bag.camera_info("/camera/camera_info", stamps, camera);
    bag.range("/altitude", stamps, {2.0F, 0.1F, 10.0F});
    test::BodyPose pose;
    pose.position = {0.5 * i, 0.0, 0.0};
    for (std::size_t d = 0; d < 36; d += 7) pose.covariance[d] = 0.01 * (i + 1);
    bag.odometry("/odom", stamps, pose);
  }
}

/// The bag that a writer writes; empty where the build has no such writer.
template <class MakeWriter>
std::string small_bag(const std::filesystem::path& path, MakeWriter make_writer) {
  {
    const std::unique_ptr<test::BagWriter> writer = make_writer(path);
    if (!writer) return "";
    write_small_bag(*writer);
  }
  return read_file(path);
}

inline void import(const Folder& folder, const std::filesystem::path& bag) {
  // A list refuses what cannot be opened alone; an import would, too.
  if (!is_taken([&] { bag_topic_list(bag, {}); })) return;
  const std::filesystem::path out = folder.path() / "out";
  is_taken([&] { import_bag(bag, {}, out); });
  std::filesystem::remove_all(out);
}

}  // namespace fathom::fuzz
