#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "fathom/configuration/study.hpp"
#include "fathom/front_end/registration_cache.hpp"
#include "fathom/harness/recording.hpp"
#include "study_pace.hpp"

namespace fathom {

/// The surveys of a study's cells: cells that differ in nothing that pictures and registrations
/// depend on share them. A survey is opened for the first of its trials and closed after the last,
/// so that those whose trials are done one after the other are open one after the other. May be
/// used from several threads at once.
class StudyDataSets {
 public:
  /// Study and cache must outlive this.
  StudyDataSets(const Study& study, RegistrationCache* registrations)
      : study_(study), registrations_(registrations) {
    std::map<std::string, std::size_t> first_cells;
    for (std::size_t cell = 0; cell < study.cells.size(); ++cell) {
      first_cell_.push_back(
          first_cells.emplace(picture_settings(study.cells[cell]), cell).first->second);
    }
  }

  /// The first cell whose data set this cell shares.
  std::size_t shared_with(std::size_t cell) const { return first_cell_[cell]; }
  SharedSurvey shared(std::size_t cell, std::size_t survey) const {
    return {first_cell_[cell], survey};
  }

  /// Says that a trial of this cell and survey is to come.
  void expect_trial(std::size_t cell, std::size_t survey) { ++entry_of(cell, survey).trials; }

  std::shared_ptr<const Recorder> of(std::size_t cell, std::size_t survey) {
    const std::lock_guard hold(mutex_);
    Entry& entry = entry_of(cell, survey);
    if (!entry.recorder) {
      entry.recorder = std::make_shared<const Recorder>(study_.cells[cell], registrations_, survey);
    }
    return entry.recorder;
  }

  void trial_done(std::size_t cell, std::size_t survey) {
    const std::lock_guard hold(mutex_);
    Entry& entry = entry_of(cell, survey);
    if (--entry.trials == 0) entry.recorder.reset();
  }

 private:
  struct Entry {
    std::size_t trials = 0;
    std::shared_ptr<const Recorder> recorder;
  };

  Entry& entry_of(std::size_t cell, std::size_t survey) {
    return surveys_[{first_cell_[cell], survey}];
  }

  const Study& study_;
  RegistrationCache* registrations_;
  std::vector<std::size_t> first_cell_;  ///< by cell
  std::map<std::pair<std::size_t, std::size_t>, Entry> surveys_;
  std::mutex mutex_;
};

}  // namespace fathom
