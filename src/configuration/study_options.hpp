#pragma once

#include <string>
#include <vector>

#include "fathom/configuration/configuration.hpp"
#include "fathom/core/ignored_key.hpp"

namespace fathom {

/// Whether a key is of a comparison and not of a run.
bool is_study_key(const std::string& key);

/// Whether no result depends on it: the number of surveys, trials and jobs, and the report.
bool is_session_key(const std::string& key);

/// Keys of a comparison that say nothing beside the others.
std::vector<IgnoredKey> ignored_study_keys(const Settings& settings, const StudyOptions& study);

/// Several trials of a cell that draws nothing.
void add_unused_trials(const Settings& settings, const StudyOptions& study,
                       const DataSetEntry& data_set, std::vector<UnusedSetting>& unused);

/// What no single option's bounds can say. Throws InputError.
void check_study(const Settings& settings, const StudyOptions& study, const DataSetEntry& data_set,
                 const DataSetOptions& options);

}  // namespace fathom
