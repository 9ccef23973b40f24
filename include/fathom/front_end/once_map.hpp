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

/// A memo of values that are made when first asked for, each once: of several threads
/// that ask for the same one the first makes it and the others wait. What the making throws, all of
/// them get; it is not kept, so that the next one to ask tries again. May be used from several
/// threads at once.
template <class Key, class Value>
class OnceMap {
 public:
  OnceMap() = default;

  /// Least recently used values are evicted beyond `bound`, the sum of costs; the last one is kept
  /// however much it costs.
  OnceMap(std::size_t bound, std::function<std::size_t(const Value&)> cost)
      : bound_(bound), cost_(std::move(cost)) {}

  /// The value if it is made.
  std::optional<Value> find(const Key& key) const {
    const std::lock_guard lock(mutex_);
    const auto found = entries_.find(key);
    return found == entries_.end() ? std::nullopt : found->second.value;
  }

  /// Whether it is made or being made.
  bool contains(const Key& key) const {
    const std::lock_guard lock(mutex_);
    return entries_.contains(key);
  }

  /// Made, or being made.
  std::size_t size() const {
    const std::lock_guard lock(mutex_);
    return entries_.size();
  }

  /// The summed costs of the values made.
  std::size_t cost() const {
    const std::lock_guard lock(mutex_);
    return total_cost_;
  }

  /// The value, made by `make()` unless somebody did or does already. `make` must not wait for
  /// another value of the same map.
  template <class Make>
  Value of(const Key& key, Make make) {
    std::packaged_task<Value()> task(std::move(make));
    std::shared_future<Value> own = task.get_future().share();
    std::unique_lock lock(mutex_);
    const auto [entry, is_mine] = entries_.try_emplace(key);
    if (is_mine) entry->second.making = std::move(own);
    if (is_mine) entry->second.serial = ++serial_;
    entry->second.used = ++clock_;
    if (entry->second.value) return *entry->second.value;
    const std::shared_future<Value> making = entry->second.making;
    const std::uint64_t serial = entry->second.serial;
    lock.unlock();
    if (is_mine) task();
    return settled(key, serial, making);
  }

  /// Makes it in another thread, for who asks later, unless somebody did or does already.
  template <class Make>
  void start(const Key& key, Make make) {
    const std::lock_guard lock(mutex_);
    if (entries_.contains(key)) return;
    Entry entry;
    entry.making = std::async(std::launch::async, std::move(make)).share();
    entry.serial = ++serial_;
    entry.used = ++clock_;
    entries_.emplace(key, std::move(entry));
  }

 private:
  struct Entry {
    std::optional<Value> value;        ///< once it is made and known to be
    std::shared_future<Value> making;  ///< until then: it takes some hundred bytes
    std::uint64_t serial = 0;          ///< tells it from an earlier one of the same key
    std::uint64_t used = 0;
    std::size_t cost = 0;
  };

  Value settled(const Key& key, std::uint64_t serial, const std::shared_future<Value>& making) {
    try {
      const Value& made = making.get();
      const std::lock_guard lock(mutex_);
      const auto found = entries_.find(key);
      if (found != entries_.end() && found->second.serial == serial && !found->second.value) {
        found->second.value = made;
        found->second.making = {};
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
        if (!entry->second.value || entry->first == newest) continue;
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
