#include "run_checksum.hpp"

namespace fathom {

std::string_view bytes_of(const std::vector<double>& values) {
  // An address that is null would be stored as no value at all.
  if (values.empty()) return "";
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double)};
}

Hash hash_of(const RunRecord& run) {
  Hash hash;
  hash.add(run.key.cell).add(run.key.survey).add(run.key.trial).add(run.key.estimator);
  hash.add(run.outcome).add(run.fault).add(run.log_hash).add(run.jobs);
  hash.add(run.metrics.size());
  for (const auto& [name, value] : run.metrics) hash.add(name).add(value);
  return hash;
}

void add_series(Hash& hash, std::string_view name, std::string_view bytes) {
  hash.add(name).add(bytes);
}

std::int64_t checksum_of(const Hash& hash) {
  return static_cast<std::int64_t>(hash.value());
}

}  // namespace fathom
