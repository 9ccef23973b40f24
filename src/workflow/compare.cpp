#include "fathom/workflow/compare.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>

#include <opencv2/core/utility.hpp>

#include "fathom/core/text.hpp"
#include "fathom/core/work_folder.hpp"
#include "fathom/harness/frame_remarks.hpp"
#include "fathom/harness/ground_truth.hpp"
#include "fathom/harness/loop_remarks.hpp"
#include "fathom/harness/manifest.hpp"
#include "fathom/results/scratch_store.hpp"
#include "fathom/results/store_folder.hpp"
#include "fathom/workflow/inputs.hpp"
#include "study_example.hpp"
#include "study_files.hpp"

namespace fathom::workflow {
namespace {

namespace fs = std::filesystem;

// Of estimators, as progress and `fathom status` count them.
std::size_t runs_stored(const ResultStore& store) {
  return static_cast<std::size_t>(std::ranges::count_if(
      store.runs(), [](const RunRecord& run) { return run.key.estimator != kDeadReckoning; }));
}

StudyRunOptions options_of(const CompareRequest& request, const Study& study,
                           const Machine& machine, Observer& observer) {
  StudyRunOptions options;
  options.jobs = jobs_of(study);
  options.registrations = request.registrations;
  options.make_meter = machine.make_meter;
  options.on_thread_start = machine.on_thread_start;
  options.stop = request.stop;
  if (request.shard) options.shard = *request.shard;
  options.progress = [&observer](const StudyProgress& at) { observer.study_progress(at); };
  return options;
}

// The threads there are for all jobs together; no result depends on them.
class SharedThreads {
 public:
  explicit SharedThreads(int jobs) : before_(cv::getNumThreads()) {
    cv::setNumThreads(std::max(1, before_ / jobs));
  }
  ~SharedThreads() { cv::setNumThreads(before_); }
  SharedThreads(const SharedThreads&) = delete;
  SharedThreads& operator=(const SharedThreads&) = delete;

 private:
  int before_;
};

// A study as it comes about.
class Comparison {
 public:
  Comparison(const CompareRequest& request, const EstimatorRegistry& registry,
             const Machine& machine, Observer& observer)
      : request_(request),
        registry_(registry),
        observer_(observer),
        study_(configured()),
        data_set_(study_.cells.front(), request.registrations),
        options_(options_of(request, study_, machine, observer)) {}

  CompareOutcome whole() {
    StoreFolder folder(request_.out, study_.description,
                       session_json(request_.made_by, options_.jobs));
    ResultStore& store = folder.store();
    StudyRun done = run_study(study_, registry_, store, options_);
    CompareOutcome outcome{done.is_finished, runs_stored(store), false, {}, {}};
    if (!done.is_finished) return outcome;
    store.finish();
    const std::vector<std::string> remarks = remarks_on(done);
    write_example_of(done, remarks);
    outcome.table = write_study_files(store, request_.out, observer_);
    say(remarks);
    say(faults_beside(done, store));
    outcome.all_usable = all_usable(store);
    outcome.example = std::move(done.example);
    return outcome;
  }

  CompareOutcome shard() {
    const ShardPlan plan = plan_of(study_, *request_.shard, request_.made_by);
    ScratchStore store(request_.out,
                       request_.scratch.empty() ? temporary_place() : request_.scratch,
                       study_.description, session_json(plan, options_.jobs));
    const auto heard = options_.progress;
    options_.progress = [&store, &heard](const StudyProgress& at) {
      heard(at);
      store.publish_when_due();
    };
    StudyRun done = run_study(study_, registry_, store.store(), options_);
    store.publish();
    if (!done.is_finished) return {false, runs_stored(store.store()), true, {}, {}};
    if (!done.example.empty()) {
      const std::vector<std::string> remarks = remarks_on(done);
      write_example_of(done, remarks);
      say(remarks);
    }
    return {true, plan.runs, true, std::move(done.example), {}};
  }

  bool registrations() {
    const bool is_finished = register_pictures(study_, registry_, options_);
    RegistrationStore& kept = *request_.registrations;
    kept.flush();
    if (const std::string problem = kept.problem(); !problem.empty()) throw InputError(problem);
    return is_finished;
  }

  int jobs() const { return options_.jobs; }

 private:
  // What would be overwritten, and a data set that cannot be opened or lacks what is asked for, are
  // refused before anything is written.
  Study configured() const {
    if (!request_.out.empty()) {
      require_separate(request_.out, configure_study(request_.settings, registry_),
                       request_.inputs);
    }
    return settled_study(request_.settings, registry_);
  }

  void write_example_of(const StudyRun& done, const std::vector<std::string>& remarks) const {
    const std::string& title = study_.description.title;
    write_example({request_.out, title.empty() ? request_.title : title, request_.made_by,
                   request_.mosaics ? data_set_.pictures() : nullptr, remarks},
                  study_, done.example, registry_, observer_);
  }

  // What looks wrong with set-up and loops of the trial that is drawn; the page says what its
  // figures show.
  std::vector<std::string> remarks_on(const StudyRun& done) const {
    const ExampleRun& example = done.example.front();
    const Recording& recording = *example.recording;
    const Configuration& cell = study_.cells.front();
    const TrialNoise noise{study_.noise_seeds.front(), 0};
    std::vector<std::string> remarks = data_set_.calibration_of(recording, cell, noise).findings;
    const auto add = [&remarks](const std::vector<std::string>& more) {
      remarks.insert(remarks.end(), more.begin(), more.end());
    };
    add(data_set_.data().remarks());
    add(recording.remarks);
    add(loop_remarks(recording, cell.front_end, example.result.run.trajectory));
    if (const auto remark = frame_remark(recording)) add({*remark});
    if (const auto remark = truth_remark(recording)) add({*remark});
    for (const ExampleRun& one : done.example) {
      const std::string& fault = one.result.run.fault;
      if (!fault.empty()) add({one.result.estimator.name + ": " + fault});
    }
    return remarks;
  }

  // How estimators broke their contract in other runs than the one that is drawn, whose remarks
  // have its own.
  static std::vector<std::string> faults_beside(const StudyRun& done, const ResultStore& store) {
    std::map<std::string, std::vector<std::string>> faults;
    for (const RunRecord& run : store.runs()) {
      if (!run.fault.empty()) faults[run.key.estimator].push_back(run.fault);
    }
    for (const ExampleRun& one : done.example) {
      if (!one.result.run.fault.empty()) faults.erase(one.result.estimator.name);
    }
    std::vector<std::string> remarks;
    remarks.reserve(faults.size());
    for (const auto& [estimator, own] : faults) {
      remarks.push_back(fmt::format("{}: {} ended by a fault, the first: {}", estimator,
                                    counted(own.size(), "run"), own.front()));
    }
    return remarks;
  }

  void say(const std::vector<std::string>& remarks) const {
    for (const std::string& remark : remarks) observer_.remark(remark);
  }

  const CompareRequest& request_;
  const EstimatorRegistry& registry_;
  Observer& observer_;
  Study study_;
  Recorder data_set_;
  StudyRunOptions options_;
};

}  // namespace

Study settled_study(const Settings& settings, const EstimatorRegistry& registry) {
  Study study = configure_study(settings, registry);
  settle_reference(study, registry);
  study.description.data = with_code(data_of(study), estimators_in(study.cells), registry);
  return study;
}

CompareOutcome compare(const CompareRequest& request, const EstimatorRegistry& registry,
                       const Machine& machine, Observer& observer) {
  Comparison comparison(request, registry, machine, observer);
  const SharedThreads threads(comparison.jobs());
  return request.shard ? comparison.shard() : comparison.whole();
}

bool register_study(const CompareRequest& request, const EstimatorRegistry& registry,
                    const Machine& machine, Observer& observer) {
  if (request.registrations == nullptr) throw InputError("no folder for the registrations");
  Comparison comparison(request, registry, machine, observer);
  const SharedThreads threads(comparison.jobs());
  return comparison.registrations();
}

}  // namespace fathom::workflow
