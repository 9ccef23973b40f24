#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "apps/command.hpp"
#include "apps/common.hpp"
#include "fathom/configuration/study.hpp"
#include "fathom/front_end/registration_store.hpp"
#include "fathom/harness/study_run.hpp"

namespace fathom {

/// The flags of `compare`.
struct CompareFlags {
  CommonFlags common;
  std::string config;
  std::optional<int> surveys;
  std::optional<int> trials;
  std::optional<int> jobs;
  std::string cache;
  std::string read_only_cache;
  bool no_cache = false;
  bool only_registrations = false;
  std::string shard;
  std::string scratch;
  bool no_mosaic = false;

  Settings settings() const {
    Settings settings = common.settings(config);
    if (surveys) {
      settings.put({"surveys", OptionValue::scalar(std::to_string(*surveys)), "--surveys"});
    }
    if (trials) settings.put({"trials", OptionValue::scalar(std::to_string(*trials)), "--trials"});
    if (jobs) settings.put({"jobs", OptionValue::scalar(std::to_string(*jobs)), "--jobs"});
    return settings;
  }
};

/// A study, with its page and files. All modes can be asked to stop by SIGINT and SIGTERM
/// (StopSignal); `cache` may be null.
void run_whole(const Study& study, const std::filesystem::path& out, const FrameSource* pictures,
               StudyRunOptions& options, RegistrationStore* cache, const CompareFlags& flags,
               Context& context);

/// A part of a study: its store is made on a disk of this machine, and no page is written of it.
void run_shard(const Study& study, const Shard& shard, const std::filesystem::path& out,
               const FrameSource* pictures, StudyRunOptions& options, RegistrationStore* cache,
               const CompareFlags& flags, Context& context);

/// The registrations of a study or a part of it.
void only_register(const Study& study, RegistrationStore& cache, StudyRunOptions& options,
                   const CompareFlags& flags, Context& context);

}  // namespace fathom
