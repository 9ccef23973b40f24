// A bag of ROS 2: a small one that the tests' own writer has written, with some of its bytes
// replaced.
#include "support/bags.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fathom;
  static const fuzz::Folder folder("ros2");
  static const std::string sound = fuzz::small_bag(
      folder.path() / "sound.db3", [](const auto& path) { return test::ros2_bag_writer(path); });
  if (sound.empty()) return 0;
  fuzz::import(folder, folder.write("edited.db3", fuzz::edited(sound, fuzz::Draws(data, size))));
  return 0;
}
