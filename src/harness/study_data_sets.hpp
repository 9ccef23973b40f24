#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "fathom/configuration/study.hpp"
#include "fathom/front_end/registration_cache.hpp"
#include "fathom/harness/recording.hpp"

namespace fathom {

/// The data sets of a study's cells: those that differ in nothing that their pictures and
/// registrations depend on are one. It is opened for the first of its trials and closed after the
/// last. May be used from several threads at once.
class StudyDataSets {
 public:
  /// Study and cache must outlive this.
  StudyDataSets(const Study& study, RegistrationCache* registrations)
      : study_(study), registrations_(registrations) {}

  /// Says that a trial of this cell is to come.
  void expect_trial(std::size_t cell) { ++by_settings_[key_of(cell)].trials; }

  std::shared_ptr<const Recorder> of(std::size_t cell) {
    const std::lock_guard hold(mutex_);
    Entry& entry = by_settings_[key_of(cell)];
    if (!entry.recorder) {
      entry.recorder = std::make_shared<const Recorder>(study_.cells[cell], registrations_);
    }
    return entry.recorder;
  }

  void trial_done(std::size_t cell) {
    const std::lock_guard hold(mutex_);
    Entry& entry = by_settings_[key_of(cell)];
    if (--entry.trials == 0) entry.recorder.reset();
  }

 private:
  struct Entry {
    std::size_t trials = 0;
    std::shared_ptr<const Recorder> recorder;
  };

  std::string key_of(std::size_t cell) const { return picture_settings(study_.cells[cell]); }

  const Study& study_;
  RegistrationCache* registrations_;
  std::map<std::string, Entry> by_settings_;
  std::mutex mutex_;
};

}  // namespace fathom
