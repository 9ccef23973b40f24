#include "fathom/workflow/run.hpp"

#include <algorithm>
#include <future>
#include <iterator>
#include <stop_token>
#include <utility>

#include "fathom/core/files.hpp"
#include "fathom/harness/frame_remarks.hpp"
#include "fathom/harness/loop_remarks.hpp"
#include "fathom/harness/manifest.hpp"
#include "fathom/harness/map_fit.hpp"
#include "fathom/harness/run_folder.hpp"
#include "fathom/workflow/inputs.hpp"
#include "fathom/workflow/trajectory_picture.hpp"
#include "map_files.hpp"
#include "run_mosaics.hpp"
#include "study_files.hpp"

namespace fathom::workflow {
namespace {

namespace fs = std::filesystem;

constexpr const char* kBatchOptimum = "batch_optimum";

// Asks to stop when it goes.
struct Stop {
  std::stop_source source;

  ~Stop() { source.request_stop(); }
};

// A run as it comes about.
class OneRun {
 public:
  OneRun(const RunRequest& request, const EstimatorRegistry& registry, const Machine& machine,
         Observer& observer)
      : request_(request),
        registry_(registry),
        machine_(machine),
        observer_(observer),
        configuration_(configure(request.settings, ConfigurationKind::single, registry)) {}

  RunOutcome outcome() {
    std::optional<StagedFolder> folder;
    if (!request_.out.empty()) {
      require_no_study(request_.out);
      folder.emplace(request_.out, request_.inputs);
    }
    const Recorder recorder(configuration_, request_.registrations);
    const Fingerprint data = record(recorder, folder.has_value());
    RunOutcome done{recording_, evaluated(), std::nullopt,
                    configuration_.study.evaluation.alignment};
    // What is wrong with the set-up comes first: it makes what follows.
    std::vector<std::string> remarks =
        recorder.calibration_of(*recording_, configuration_, noise()).findings;
    const bool set_up_is_wrong = !remarks.empty();
    std::ranges::copy(recorder.data().remarks(), std::back_inserter(remarks));
    std::ranges::copy(recording_->remarks, std::back_inserter(remarks));
    judge(done, set_up_is_wrong, remarks);
    if (folder) {
      write(*folder, recorder, data, done, remarks);
    }
    for (const std::string& remark : remarks) observer_.remark(remark);
    return done;
  }

 private:
  TrialNoise noise() const { return {static_cast<std::uint64_t>(configuration_.seed), 0}; }

  // Returns the hashes of the data, if asked for. They are made while pictures are looked at, and
  // not beside the estimator, whose cost is measured.
  Fingerprint record(const Recorder& recorder, bool with_hashes) {
    std::future<Fingerprint> hashes;
    const Stop stop;  // where recording throws
    if (with_hashes) {
      hashes = std::async([&, token = stop.source.get_token()] {
        return fingerprint(recorder.data().files(), token);
      });
    }
    recording_ = std::make_shared<const Recording>(
        recorder.record(configuration_, configuration_.reference, registry_, noise(),
                        [this](const FrontEndProgress& at) { observer_.front_end_progress(at); }));
    return with_hashes ? hashes.get() : Fingerprint{};
  }

  Result evaluated() const {
    const EstimatorConfiguration& estimator = configuration_.estimators.front();
    const auto meter = machine_.make_meter ? machine_.make_meter() : nullptr;
    EvaluationOptions options = evaluation_options(configuration_, estimator);
    options.memory = meter.get();
    options.progress = observer_.progress_of(estimator.name + ", keyframe");
    return evaluate(*recording_, estimator, registry_, {.metrics = configuration_.study.evaluation},
                    options);
  }

  // What looks wrong, and the batch optimum of the log where the estimate does not fit it.
  void judge(RunOutcome& done, bool set_up_is_wrong, std::vector<std::string>& remarks) const {
    const std::vector<Pose>& estimate = done.result.run.trajectory;
    std::ranges::copy(loop_remarks(*recording_, configuration_.front_end, estimate),
                      std::back_inserter(remarks));
    if (auto remark = frame_remark(*recording_)) remarks.push_back(std::move(*remark));
    if (auto remark = truth_remark(*recording_)) remarks.push_back(std::move(*remark));
    const auto optimum = batch_optimum(recording_->log, registry_, {}, done.result.run.errors);
    auto fit =
        optimum ? map_fit(recording_->log, estimate, *optimum, &done.result.run) : std::nullopt;
    if (!fit) return;
    const EstimatorConfiguration& estimator = done.result.estimator;
    const auto takes_as = [&](const char* word) {
      return takes_shared_errors_as(word, recording_->log, estimator, registry_);
    };
    fit->considers_shared_errors = takes_as("consider");
    std::ranges::copy(map_remarks(*fit, estimator.name, optimum->solver, set_up_is_wrong),
                      std::back_inserter(remarks));
    if (takes_as("independent")) {
      if (auto remark = sharing_remark(*fit, estimator.name)) remarks.push_back(std::move(*remark));
    }
    if (fit->estimate_fits() || fit->leaves_out_most()) return;
    EvaluationOptions options;
    options.mode = SolveMode::batch;
    done.optimum = evaluate(*recording_, {kBatchOptimum, optimum->solver, optimum->values},
                            registry_, {.metrics = configuration_.study.evaluation}, options);
  }

  void write(StagedFolder& folder, const Recorder& recorder, const Fingerprint& data,
             const RunOutcome& done, const std::vector<std::string>& remarks) const {
    write_run(folder.path(), *recording_, done.result,
              manifest_json(request_.made_by, configuration_.in_force,
                            with_code(data, estimators_in({configuration_}), registry_),
                            *recording_, done.result, registry_, remarks));
    std::vector<Result> results{done.result};
    if (done.optimum) {
      results.push_back(*done.optimum);
      fs::create_directory(folder.path() / kBatchOptimum);
      write_file(folder.path() / kBatchOptimum / "trajectory.tum",
                 to_tum(keyframe_trajectory(*recording_, done.optimum->run.trajectory)));
    }
    // Beside the mosaics, which wait for pictures.
    std::future<void> picture = std::async([&] {
      write_trajectory_picture(folder.path() / "trajectory.png",
                               request_.title + ", " + done.result.estimator.name, *recording_,
                               results);
    });
    const std::vector<std::string> maps = write_maps(recorder.pictures(), results, folder.path());
    picture.get();
    folder.commit(optional_run_files());
    observer_.wrote((folder.target() / "trajectory.png").string());
    for (const std::string& map : maps) observer_.wrote(map);
  }

  // Mosaics, footprints, and where the survey lies on Earth; returns a line each, of what was
  // written and of what could not be.
  std::vector<std::string> write_maps(const FrameSource* pictures,
                                      const std::vector<Result>& results,
                                      const fs::path& folder) const {
    if (pictures == nullptr) return {};
    std::vector<std::string> lines;
    const EarthOrWhyNot earth = earth_or_why_not(configuration_);
    if (!earth.why_not.empty()) lines.push_back(earth.why_not);
    const EarthFrame* on_earth = earth.frame ? &*earth.frame : nullptr;
    if (request_.mosaics) {
      std::ranges::copy(write_all_mosaics(*pictures, results, folder, on_earth),
                        std::back_inserter(lines));
    }
    const auto problem =
        try_map_files(folder, keyframe_map(*recording_, results.front()), on_earth);
    if (problem) lines.push_back(*problem);
    return lines;
  }

  // The run's, and its batch optimum's in a folder below.
  std::vector<std::string> write_all_mosaics(const FrameSource& pictures,
                                             const std::vector<Result>& results,
                                             const fs::path& folder,
                                             const EarthFrame* earth) const {
    std::vector<RunMosaic> mosaics;
    mosaics.reserve(results.size());
    for (const Result& result : results) {
      mosaics.push_back({mosaics.empty() ? folder : folder / kBatchOptimum,
                         placed_pictures(*recording_, result.run.trajectory)});
    }
    std::vector<std::string> lines = write_mosaics(pictures, mosaics, earth, observer_);
    for (std::size_t i = 1; i < lines.size(); ++i) lines[i] = kBatchOptimum + ("/" + lines[i]);
    return lines;
  }

  const RunRequest& request_;
  const EstimatorRegistry& registry_;
  const Machine& machine_;
  Observer& observer_;
  Configuration configuration_;
  std::shared_ptr<const Recording> recording_;
};

}  // namespace

RunOutcome run(const RunRequest& request, const EstimatorRegistry& registry, const Machine& machine,
               Observer& observer) {
  return OneRun(request, registry, machine, observer).outcome();
}

}  // namespace fathom::workflow
