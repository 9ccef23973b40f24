#include "fathom/core/folder_claim.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <sstream>
#include <system_error>

#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/system.hpp"
#include "partial_files.hpp"

namespace fathom {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr const char* kFile = "results.owner";

// Tells claims of one process apart, too.
std::string new_token() {
  return host_name() + " " + std::to_string(process_number()) + " " + process_space() + " " +
         unique_word();
}

// "HOST PROCESS SPACE WORD COUNT"; empty where there is no such file.
std::string content_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

struct Claimant {
  std::string host;
  long process = 0;
  std::string space;
};

Claimant claimant_of(const std::string& content) {
  Claimant who;
  std::istringstream words(content);
  words >> who.host >> who.process >> who.space;
  return who;
}

bool is_here(const Claimant& who) {
  return !who.space.empty() && who.space == process_space();
}

bool is_dead(const Claimant& who) {
  return is_here(who) && is_dead_process(who.process);
}

// Whether a file changes while one waits.
bool changes_within(const fs::path& file, const std::string& content,
                    std::chrono::milliseconds time) {
  const auto end = Clock::now() + time;
  while (Clock::now() < end) {
    std::this_thread::sleep_for(std::min<std::chrono::milliseconds>(
        std::chrono::milliseconds(100),
        std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now())));
    if (content_of(file) != content) return true;
  }
  return false;
}

// That its number runs says little: it may be another process's by now.
bool is_alive(const fs::path& file, const std::string& content, std::chrono::milliseconds wait) {
  return !content.empty() && !is_dead(claimant_of(content)) && changes_within(file, content, wait);
}

// So long a claim is looked at that is not to be taken over.
std::chrono::milliseconds look_of(const ClaimTimes& times) {
  return times.beat + times.beat / 2;
}

InputError is_held(const fs::path& file, const std::string& content) {
  const Claimant who = claimant_of(content);
  if (content.empty()) {
    return InputError(file.parent_path().string() +
                      ": another process has taken it over, and ended; run the same command again");
  }
  return InputError(file.parent_path().string() + ": process " + std::to_string(who.process) +
                    " on " + who.host + " is at work on it; wait for it, or use another --out");
}

}  // namespace

FolderClaim::FolderClaim(const fs::path& folder, ClaimTimes times)
    : file_(folder / kFile), times_(times), token_(new_token()) {
  const std::string there = content_of(file_);
  if (is_alive(file_, there, times_.patience)) throw is_held(file_, there);
  remove_abandoned(folder);
  write(token_ + " 0\n");
  // Of two that come at once the later one stands in the file.
  std::this_thread::sleep_for(times_.beat / 20);
  require_held();
  thread_ = std::thread([this] { beat(); });
}

FolderClaim::~FolderClaim() {
  {
    const std::lock_guard hold(mutex_);
    is_ended_ = true;
  }
  ended_.notify_all();
  thread_.join();
  std::error_code ignored;
  if (content_of(file_).starts_with(token_)) fs::remove(file_, ignored);
}

void FolderClaim::require_held() const {
  const std::string there = content_of(file_);
  if (there.starts_with(token_)) return;
  throw is_held(file_, there);
}

void FolderClaim::beat() {
  std::unique_lock hold(mutex_);
  for (std::size_t count = 1; !ended_.wait_for(hold, times_.beat, [this] { return is_ended_; });
       ++count) {
    if (!content_of(file_).starts_with(token_)) return;
    try {
      write(token_ + " " + std::to_string(count) + "\n");
    } catch (const InputError&) {
      // A folder that cannot be written now may be later on; what is stored there will say so.
    }
  }
}

void FolderClaim::write(const std::string& text) const {
  write_file(file_, text);
}

ClaimHolder FolderClaim::holder_of(const fs::path& folder, ClaimTimes times) {
  const fs::path file = folder / kFile;
  const std::string there = content_of(file);
  const Claimant who = claimant_of(there);
  return {who.host, who.process, is_alive(file, there, look_of(times))};
}

void FolderClaim::require_free(const fs::path& folder, ClaimTimes times) {
  const fs::path file = folder / kFile;
  const std::string there = content_of(file);
  if (is_alive(file, there, look_of(times))) throw is_held(file, there);
}

}  // namespace fathom
