// A file of results: a small store that the program has written, with some of its bytes replaced.
#include <algorithm>

#include "fathom/core/files.hpp"
#include "fathom/results/result_store.hpp"
#include "results/stored_runs.hpp"
#include "support/fuzz.hpp"

namespace {

using namespace fathom;

std::string sound_store(const fuzz::Folder& folder) {
  const std::filesystem::path made = folder.path() / "made";
  {
    ResultStore store = ResultStore::write(made, test::description(), "{\"a\": 1}");
    store.add(test::record(3, 1, "plain"));
    store.add(test::record(0, 0, kDeadReckoning));
    store.finish();
  }
  return read_file(made / kResultsFile);
}

void look_at(const ResultStore& store) {
  for (const RunRecord& run : store.runs()) {
    store.run(run.key);
    store.series(run.key, "x");
  }
  store.manifests();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::Folder folder("store");
  static const std::string sound = sound_store(folder);
  const std::filesystem::path file =
      folder.write(kResultsFile, fuzz::edited(sound, fuzz::Draws(data, size)));
  const bool is_taken = fuzz::is_taken([&] { look_at(ResultStore::open(file)); });
  fuzz::require(is_taken || size > 0, "an untouched store is taken");
  return 0;
}
