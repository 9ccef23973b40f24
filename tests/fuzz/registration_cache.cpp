// A cache of registrations: one that the program has written, with some of its bytes replaced.
#include "fathom/core/files.hpp"
#include "fathom/front_end/registration_store.hpp"
#include "support/fuzz.hpp"

namespace {

using namespace fathom;

constexpr const char* kFile = "registrations.sqlite";

std::string sound_cache(const fuzz::Folder& folder) {
  const std::filesystem::path made = folder.path() / "made";
  RegistrationStore store(made);
  for (std::uint64_t i = 0; i < 3; ++i) {
    PairRegistration registration;
    registration.found = i > 0;
    registration.motion = {0.5, 0.25, 0.125};
    registration.covariance = 1e-4 * Eigen::Matrix3d::Identity();
    registration.inliers = 40;
    store.put({i, i}, registration);
  }
  store.finish();
  return read_file(made / kFile);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::Folder folder("cache");
  static const std::string sound = sound_cache(folder);
  folder.write(kFile, fuzz::edited(sound, fuzz::Draws(data, size)));
  fuzz::is_taken([&] {
    const auto store = RegistrationStore::read_only(folder.path());
    for (const auto& [key, registration] : store->all()) {
      const auto found = store->find(key);
      fuzz::require(!found || *found == registration, "a key has one registration");
    }
  });
  return 0;
}
