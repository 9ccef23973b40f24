#pragma once

#include <cstddef>
#include <map>
#include <mutex>
#include <optional>

#include "fathom/front_end/registration_cache.hpp"

namespace fathom::test {

class MapCache : public RegistrationCache {
 public:
  std::optional<PairRegistration> find(const RegistrationKey& key) override {
    const std::lock_guard lock(mutex_);
    const auto found = values_.find(key);
    return found == values_.end() ? std::nullopt : std::optional(found->second);
  }
  void put(const RegistrationKey& key, const PairRegistration& value) override {
    const std::lock_guard lock(mutex_);
    values_[key] = value;
  }
  std::size_t size() const { return values_.size(); }

 private:
  std::mutex mutex_;
  std::map<RegistrationKey, PairRegistration> values_;
};

}  // namespace fathom::test
