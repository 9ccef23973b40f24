#include "sensor_csv.hpp"

#include <utility>

#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "fathom/datasets/asl_files.hpp"

namespace fathom {
SensorCsv::SensorCsv(std::filesystem::path path, const std::string& columns,
                     const std::string& more, std::int64_t time_offset_ns)
    : file_(std::move(path), columns, more) {
  for (const CsvRow& fields : file_.rows()) {
    const std::string& stamp = fields.fields.front();
    const auto time_ns = parse_integer(stamp);
    if (!time_ns) {
      file_.refuse(fields,
                   "time stamp " + in_quotes(stamp) + " is not a whole number of nanoseconds");
    }
    if (*time_ns < -kMostTimeNs || *time_ns > kMostTimeNs) {
      file_.refuse(fields, "time stamp " + stamp + " is beyond the limit of " +
                               std::to_string(kMostTimeNs) + " ns, which is in 2112");
    }
    const std::int64_t corrected_ns = *time_ns + time_offset_ns;
    if (!rows_.empty() && corrected_ns <= rows_.back().time_ns) {
      file_.refuse(fields, "time stamp " + in_quotes(stamp) + " does not come after " +
                               rows_.back().fields.front() +
                               "; rows must be sorted, without repeats");
    }
    rows_.push_back({fields, corrected_ns});
  }
  if (rows_.empty()) {
    throw InputError(file_.path().string(), "has no data; expected rows of " + columns);
  }
}

}  // namespace fathom
