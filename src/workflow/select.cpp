#include "fathom/workflow/select.hpp"

#include <algorithm>

#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/datasets/image_folder.hpp"
#include "fathom/datasets/picture_folder.hpp"
#include "fathom/harness/advice.hpp"
#include "fathom/harness/recording.hpp"
#include "fathom/report/selection_text.hpp"
#include "fathom/results/selected_config.hpp"
#include "fathom/workflow/named_code.hpp"

namespace fathom::workflow {
namespace {

namespace fs = std::filesystem;

constexpr const char* kConfigName = "selected.yaml";

std::filesystem::path folder_of(const SelectRequest& request) {
  if (!request.out.empty()) return request.out;
  const std::filesystem::path& results = request.results;
  if (std::filesystem::is_directory(results)) return results;
  return results.has_parent_path() ? results.parent_path() : ".";
}

// Returns the file as the user would name it.
std::filesystem::path write_config(const SelectRequest& request, const std::string& text) {
  try {
    StagedFolder folder(folder_of(request), {request.results});
    write_file(folder.path() / kConfigName, text);
    folder.commit();
    return folder_of(request) / kConfigName;
  } catch (const InputError& error) {
    if (!request.out.empty()) throw;
    throw InputError(std::string(error.what()) + "; --out DIR says where " + kConfigName +
                     " may be written");
  }
}

// The pose graph that a path is, or that a run has left in its folder.
std::optional<fs::path> graph_of(const fs::path& path) {
  const std::string ending = path.extension().string();
  const bool is_other = ending == ".sqlite" || ending == ".yaml" || ending == ".yml";
  if (fs::is_regular_file(path)) return is_other ? std::nullopt : std::optional(path);
  if (fs::exists(path / kResultsFile)) return std::nullopt;
  const fs::path log = path / "measurements.g2o";
  return fs::is_regular_file(log) ? std::optional(log) : std::nullopt;
}

// A store may be anybody's: what its plug-ins bring is taken as the store has it.
EstimatorRegistry with_those_of(const StudyDescription& study, EstimatorRegistry registry) {
  Settings settings;
  for (const auto& [key, value] : study.configuration) {
    if (key != "plugins" && !key.starts_with("estimators.")) continue;
    settings.put({key, parse_override(key + "=" + value).value, "the store"});
  }
  for (const StudyAxis& axis : study.axes) {
    settings.put({axis.key, OptionValue::scalar(""), "the store"});
  }
  for (std::size_t e = 0; e < study.estimators.size(); ++e) {
    settings.put({"estimators." + std::to_string(e) + ".type",
                  OptionValue::scalar(study.estimators[e].type), "the store"});
  }
  add_unloaded(settings, named_code(settings).plugins, registry);
  return registry;
}

}  // namespace

SelectOutcome select(const SelectRequest& request, const EstimatorRegistry& registry) {
  // A study's folder has pictures of its own.
  if (!fs::exists(request.results / kResultsFile) && is_plain_picture_folder(request.results)) {
    throw InputError(request.results.string(),
                     "has plain pictures, which do not say of what survey they are; expected the "
                     "folder of a run ('fathom init' writes its configuration) or of a study");
  }
  const ResultStore store = ResultStore::open(request.results);
  SelectOutcome outcome;
  outcome.selection = select_estimator(store, request.query);
  if (outcome.selection.chosen) {
    outcome.config = write_config(
        request, selected_configuration(store.study(), outcome.selection, request.query,
                                        with_those_of(store.study(), registry)));
    outcome.named = named_code(read_settings(outcome.config));
  }
  outcome.text = selection_text(outcome.selection, request.query, store.study());
  return outcome;
}

std::optional<std::string> advice_for(const fs::path& path) {
  if (const auto graph = graph_of(path))
    return text_of(advise(loop_terms(record_graph(*graph).log)));
  if (!fs::is_directory(path / "mav0")) return std::nullopt;
  const auto advice = advise(outlook(ImageFolder(path), FrontEndOptions{}));
  if (advice) return text_of(*advice, "survey");
  throw InputError(path.string(),
                   "dead reckoning says of no loop how well its heading is known; 'fathom run' "
                   "records a log, and select takes the folder of the run");
}

}  // namespace fathom::workflow
