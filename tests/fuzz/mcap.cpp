// A bag of ROS 2 as MCAP: small ones that the tests' own writer has written, with some of the bytes
// replaced. The first byte says which: without checksums edits reach further.
#include "support/bags.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fathom;
  static const fuzz::Folder folder("mcap");
  static const auto sound = [](const test::McapLayout& layout) {
    return fuzz::small_bag(folder.path() / "sound.mcap",
                           [&](const auto& path) { return test::mcap_bag_writer(path, layout); });
  };
  static const std::string kinds[] = {sound({.has_sums = false}),
                                      sound({.is_chunked = false, .has_sums = false}),
                                      sound({.compression = "lz4", .has_sums = false}),
                                      sound({.compression = "zstd", .has_sums = false}), sound({})};
  fuzz::Draws draws(data, size);
  const std::string& kind = kinds[draws.below(std::size(kinds))];
  fuzz::import(folder, folder.write("edited.mcap", fuzz::edited(kind, draws)));
  return 0;
}
