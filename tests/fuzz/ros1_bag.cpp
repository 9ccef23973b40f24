// A bag of ROS 1: a small one that the tests' own writer has written, with some of its bytes
// replaced.
#include "support/bags.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fathom;
  static const fuzz::Folder folder("ros1");
  // While a bag is open the libraries stay loaded that librosbag loads for each one else.
  static const auto open_bag = test::ros1_bag_writer(folder.path() / "open.bag");
  static const std::string sound = fuzz::small_bag(
      folder.path() / "sound.bag", [](const auto& path) { return test::ros1_bag_writer(path); });
  if (sound.empty()) return 0;
  fuzz::import(folder, folder.write("edited.bag", fuzz::edited(sound, fuzz::Draws(data, size))));
  return 0;
}
