#include "fathom/core/forked_child.hpp"

#include <chrono>
#include <csignal>
#include <fcntl.h>
#include <string>
#include <sys/resource.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include <gmock/gmock.h>

#include "core/few_descriptors.hpp"
#include "fathom/core/environment_error.hpp"

namespace fathom {
namespace {

using ::testing::HasSubstr;

constexpr ChildLimits kLimits{60.0, std::int64_t{1} << 32};

std::string environment_fault_of(const std::function<void(const MessagePipe&)>& action,
                                 std::string* heard = nullptr) {
  try {
    run_child(action, kLimits, [&](char, const std::string& text) {
      if (heard != nullptr) *heard += text;
    });
  } catch (const EnvironmentError& error) {
    return error.what();
  }
  return "none";
}

TEST(ForkedChild, SaysWhatItIsToSay) {
  std::string heard;
  const auto speak = [](const MessagePipe& parent) { parent.send('a', "well"); };
  EXPECT_EQ(environment_fault_of(speak, &heard), "none");
  EXPECT_EQ(heard, "well");
}

// What it forks may go on with its work, and be the first to have a result.
TEST(ForkedChild, HasTheWordAlone) {
  std::string heard;
  const auto speak_twice = [](const MessagePipe& parent) {
    const pid_t other = ::fork();
    if (other > 0) ::waitpid(other, nullptr, 0);
    parent.send('a', other > 0 ? "mine" : "another's");
  };
  EXPECT_EQ(environment_fault_of(speak_twice, &heard), "none");
  EXPECT_EQ(heard, "mine");
}

TEST(ForkedChild, AFaultOfItsEnvironmentIsThrownByItsParent) {
  std::string heard;
  const auto find_no_room = [](const MessagePipe& parent) {
    parent.send('a', "well");
    throw EnvironmentError("disk", "cannot be written", ENOSPC);
  };
  EXPECT_EQ(environment_fault_of(find_no_room, &heard),
            "disk: cannot be written: No space left on device");
  EXPECT_EQ(heard, "well");
}

TEST(ForkedChild, WithoutDescriptorsItIsNotBegun) {
  std::string said;
  try {
    const test::FewDescriptors none_left;
    run_child([](const MessagePipe&) {}, kLimits, [](char, const std::string&) {});
  } catch (const EnvironmentError& error) {
    said = error.what();
  }
  EXPECT_THAT(said, HasSubstr("Too many open files"));
}

TEST(ForkedChild, WithoutADescriptorForItsStreamsItSaysSo) {
  const int next = ::fcntl(0, F_DUPFD, 3);
  ::close(next);
  std::string said;
  {
    const test::FewDescriptors two_pipes(static_cast<rlim_t>(next) + 4);
    said = environment_fault_of([](const MessagePipe&) {});
  }
  EXPECT_THAT(said, HasSubstr("no streams: Too many open files"));
}

// Whoever signals all processes of a job means the one that waits.
TEST(ForkedChild, LeavesARequestToStopToItsParent) {
  std::string heard;
  const auto be_asked = [](const MessagePipe& parent) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) ::kill(::getpid(), signal);
    parent.send('a', "goes on");
  };
  EXPECT_EQ(environment_fault_of(be_asked, &heard), "none");
  EXPECT_EQ(heard, "goes on");
}

// In a process of its own.
template <class Action>
pid_t forked(const Action& action) {
  const pid_t id = ::fork();
  if (id == 0) ::_exit(action());
  return id;
}

int status_of(pid_t id) {
  int status = 0;
  ::waitpid(id, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

// As a plug-in ends a helper of its own, another program or a copy of its process.
TEST(ForkedChild, WhatItStartsEndsByASignal) {
  const auto end_helpers = [](const MessagePipe& parent) {
    const pid_t copy = forked([] { return ::pause(); });
    const pid_t program = forked([] { return ::execlp("sleep", "sleep", "1000", nullptr); });
    for (const pid_t id : {copy, program}) {
      ::kill(id, SIGTERM);
      parent.send('a', std::to_string(status_of(id)) + " ");
    }
  };
  std::string heard;
  EXPECT_EQ(environment_fault_of(end_helpers, &heard), "none");
  EXPECT_EQ(heard, "143 143 ");
}

// As Ctrl-Z stops it: the child works on, and waits for it to take what it sends.
TEST(ForkedChild, IsNotLateWhereItsParentWasSuspended) {
  using namespace std::chrono_literals;
  const pid_t parent = forked([] {
    std::size_t heard = 0;
    const ChildEnd end = run_child(
        [](const MessagePipe& to) {
          std::this_thread::sleep_for(300ms);
          to.send('a', std::string(1 << 20, 'x'));
        },
        {1.0, std::int64_t{1} << 32},
        [&heard](char, const std::string& text) { heard += text.size(); });
    return end.is_late || heard != 1 << 20 ? 1 : 0;
  });
  std::this_thread::sleep_for(100ms);
  ::kill(parent, SIGSTOP);
  std::this_thread::sleep_for(1500ms);
  ::kill(parent, SIGCONT);
  EXPECT_EQ(status_of(parent), 0);
}

// The limit was the system's.
TEST(ForkedChild, AtTheSystemsLimitOfProcessorTimeItIsNoResult) {
  const pid_t parent = forked([] {
    const rlimit second{1, 1};
    ::setrlimit(RLIMIT_CPU, &second);
    const std::string fault = environment_fault_of([](const MessagePipe&) {
      for (volatile int turns = 0; true;) turns = turns ^ 1;
    });
    return fault.find("'ulimit -t' gives a process 1 s") == std::string::npos ? 1 : 0;
  });
  EXPECT_EQ(status_of(parent), 0);
}

}  // namespace
}  // namespace fathom
