#include "fathom/core/workers.hpp"

#include <ctime>
#include <system_error>

namespace fathom {
namespace {

thread_local double helped_seconds = 0.0;

double own_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

Workers::Workers(int threads) {
  helpers_.reserve(static_cast<std::size_t>(std::max(threads - 1, 0)));
  for (int worker = 1; worker < threads; ++worker) {
    try {
      helpers_.emplace_back([this, worker] { help(worker); });
    } catch (const std::system_error&) {
      return;
    }
  }
}

Workers::~Workers() {
  {
    const std::lock_guard lock(mutex_);
    task_ = -1;
  }
  begun_.notify_all();
}

void Workers::help(int worker) {
  long seen = 0;
  std::unique_lock lock(mutex_);
  for (;;) {
    begun_.wait(lock, [&] { return task_ != seen; });
    if (task_ < 0) return;
    seen = task_;
    const auto& part = *part_;
    lock.unlock();
    const double before = own_seconds();
    part(worker);
    const double spent = own_seconds() - before;
    lock.lock();
    cpu_seconds_ += spent;
    if (--at_work_ == 0) done_.notify_one();
  }
}

void Workers::run(const std::function<void(int)>& part) {
  {
    const std::lock_guard lock(mutex_);
    part_ = &part;
    at_work_ = static_cast<int>(helpers_.size());
    cpu_seconds_ = 0.0;
    ++task_;
  }
  begun_.notify_all();
  part(0);
  std::unique_lock lock(mutex_);
  done_.wait(lock, [&] { return at_work_ == 0; });
  helped_seconds += cpu_seconds_;
}

double thread_processor_seconds() {
  return own_seconds() + helped_seconds;
}

void Barrier::wait() {
  const unsigned round = round_.load(std::memory_order_acquire);
  if (waiting_.fetch_add(1, std::memory_order_acq_rel) + 1 == parts_) {
    waiting_.store(0, std::memory_order_relaxed);
    round_.fetch_add(1, std::memory_order_release);
    return;
  }
  wait_until([&] { return round_.load(std::memory_order_acquire) != round; });
}

}  // namespace fathom
