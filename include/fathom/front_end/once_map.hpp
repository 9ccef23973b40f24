#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <future>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

namespace fathom {

/// Values that are made when first asked for, each once: of several threads that ask for the same
/// one the first makes it and the others wait. What the making throws, all of them get; it is not
/// kept, so that the next one to ask tries again. May be used from several threads at once.
template <class Key, class Value>
class OnceMap {
 public:
  OnceMap() = default;

  /// Of the values those used last are kept whose costs add up to no more than `bound`, and the
  /// last one however much it costs.
  OnceMap(std::size_t bound, std::function<std::size_t(const Value&)> cost)
      : bound_(bound), cost_(std::move(cost)) {}

  /// The value if it is made.
  std::optional<Value> find(const Key& key) const {
    const std::lock_guard lock(mutex_);
    const auto found = entries_.find(key);
    if (found == entries_.end() || !found->second.is_made) return std::nullopt;
    return found->second.value.get();
  }

  /// Whether it is made or being made.
  bool contains(const Key& key) const {
    const std::lock_guard lock(mutex_);
    return entries_.contains(key);
  }

  /// The value, made by `make()` unless somebody did or does already. `make` must not wait for
  /// another value of the same map.
  template <class Make>
  Value of(const Key& key, Make make) {
    std::packaged_task<Value()> task(std::move(make));
    std::unique_lock lock(mutex_);
    const auto [entry, is_mine] = entries_.try_emplace(key);
    if (is_mine) entry->second = {task.get_future().share(), ++serial_, 0, 0, false};
    entry->second.used = ++clock_;
    const std::shared_future<Value> value = entry->second.value;
    const std::uint64_t serial = entry->second.serial;
    lock.unlock();
    if (is_mine) task();
    return settled(key, serial, value);
  }

  /// Makes it in another thread, for who asks later, unless somebody did or does already.
  template <class Make>
  void start(const Key& key, Make make) {
    const std::lock_guard lock(mutex_);
    if (entries_.contains(key)) return;
    entries_[key] = {std::async(std::launch::async, std::move(make)).share(), ++serial_, ++clock_,
                     0, false};
  }

 private:
  struct Entry {
    std::shared_future<Value> value;
    std::uint64_t serial = 0;  ///< tells it from an earlier one of the same key
    std::uint64_t used = 0;
    std::size_t cost = 0;
    bool is_made = false;  ///< and known to be
  };

  Value settled(const Key& key, std::uint64_t serial, const std::shared_future<Value>& value) {
    try {
      const Value& made = value.get();
      const std::lock_guard lock(mutex_);
      const auto found = entries_.find(key);
      if (found != entries_.end() && found->second.serial == serial && !found->second.is_made) {
        found->second.is_made = true;
        found->second.cost = cost_ ? cost_(made) : 0;
        total_cost_ += found->second.cost;
        forget_oldest(key);
      }
      return made;
    } catch (...) {
      const std::lock_guard lock(mutex_);
      const auto found = entries_.find(key);
      if (found != entries_.end() && found->second.serial == serial) entries_.erase(found);
      throw;
    }
  }

  void forget_oldest(const Key& newest) {
    while (total_cost_ > bound_) {
      auto oldest = entries_.end();
      for (auto entry = entries_.begin(); entry != entries_.end(); ++entry) {
        if (!entry->second.is_made || entry->first == newest) continue;
        if (oldest == entries_.end() || entry->second.used < oldest->second.used) oldest = entry;
      }
      if (oldest == entries_.end()) return;
      total_cost_ -= oldest->second.cost;
      entries_.erase(oldest);
    }
  }

  const std::size_t bound_ = 0;
  const std::function<std::size_t(const Value&)> cost_;
  mutable std::mutex mutex_;
  std::uint64_t serial_ = 0;
  std::uint64_t clock_ = 0;
  std::size_t total_cost_ = 0;
  // Last, so that threads still at work are waited for before the rest goes.
  std::map<Key, Entry> entries_;
};

}  // namespace fathom
