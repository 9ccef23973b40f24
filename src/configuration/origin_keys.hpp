#pragma once

#include <string>

#include "fathom/configuration/config_file.hpp"
#include "fathom/datasets/earth_origin.hpp"

namespace fathom {

/// Whether a key is one of `dataset.origin`, which every data set of pictures has beside its own.
bool is_origin_key(const std::string& key);

/// Describes them, where the type of the data set is one of pictures.
void bind_origin(const std::string& data_set, EarthOriginOptions& options, OptionTable& table);

/// Throws InputError at the origin of a setting where one of the three is missing.
void check_origin(const Settings& settings, const EarthOriginOptions& options);

}  // namespace fathom
