// Cost is measured on one thread, whatever the libraries below would like.

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include <gmock/gmock.h>

#include "apps/command_line.hpp"
#include "apps/graphs.hpp"

namespace fathom::test {
namespace {

namespace fs = std::filesystem;

/// Processor time of the threads of a process, in clock ticks; sampled while it runs, as they go.
class ThreadTimes {
 public:
  void sample(pid_t process) {
    const fs::path tasks = "/proc/" + std::to_string(process) + "/task";
    std::error_code gone;
    for (const auto& entry : fs::directory_iterator(tasks, gone)) {
      const std::string thread = entry.path().filename();
      const long ticks = ticks_of(entry.path() / "stat");
      long& known = (thread == std::to_string(process) ? main_ : others_[thread]);
      known = std::max(known, ticks);
    }
  }

  long main_ticks() const { return main_; }
  long other_ticks() const {
    long sum = 0;
    for (const auto& [thread, ticks] : others_) sum += ticks;
    return sum;
  }

 private:
  // Fields 14 and 15, user and system time; the name before them may hold blanks.
  static long ticks_of(const fs::path& stat) {
    std::ifstream file(stat);
    std::string text;
    std::getline(file, text);
    if (text.rfind(')') == std::string::npos) return 0;
    std::istringstream fields(text.substr(text.rfind(')') + 1));
    std::string skipped;
    for (int i = 3; i < 14; ++i) fields >> skipped;
    long user = 0;
    long system = 0;
    fields >> user >> system;
    return user + system;
  }

  long main_ = 0;
  std::map<std::string, long> others_;
};

class Threads : public CommandLine {
 protected:
  /// OpenBLAS keeps a pool of idle threads, so that threads are not counted but what they do.
  void expect_one_busy(const std::string& graph, const std::string& estimator) const {
    write("g.g2o", graph);
    ThreadTimes times;
    const Ended ended = fathom({"solve", "g.g2o", "--estimator", estimator, "--out", "out"},
                               [&](pid_t process) { times.sample(process); });
    ASSERT_EQ(ended.status, 0) << ended.err;
    EXPECT_GE(times.main_ticks(), 10) << "too little work to tell";
    EXPECT_LE(times.other_ticks(), times.main_ticks() / 20) << estimator;
  }
};

TEST_F(Threads, AGraphSolveKeepsToOne) {
  expect_one_busy(square_graph(3000, 3), "ceres_pose_graph");
}

TEST_F(Threads, FiltersKeepToOne) {
  for (const std::string estimator : {"trajectory_iekf", "ekf"}) {
    expect_one_busy(square_graph(900, 4), estimator);
  }
}

}  // namespace
}  // namespace fathom::test
