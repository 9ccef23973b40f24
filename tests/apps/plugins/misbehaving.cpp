// A plug-in with an estimator that does what none may: each run is dead reckoning until it does.

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <thread>
#include <unistd.h>
#include <vector>

#include "fathom/estimation/plugin.hpp"

namespace {

using namespace fathom;

enum class Fault { none, crash, hang, memory, c_memory, noise, fork, destructor, exit, random };

struct Options {
  Fault fault = Fault::none;

  void describe(OptionTable& table) {
    table.enumeration<Fault>("fault", fault,
                             {{"none", Fault::none},
                              {"crash", Fault::crash},
                              {"hang", Fault::hang},
                              {"memory", Fault::memory},
                              {"c_memory", Fault::c_memory},
                              {"noise", Fault::noise},
                              {"fork", Fault::fork},
                              {"destructor", Fault::destructor},
                              {"exit", Fault::exit},
                              {"random", Fault::random}},
                             "what it does wrong");
  }
};

class Misbehaving final : public Estimator {
 public:
  Misbehaving(const EstimatorSetup& setup, const Options& options)
      : fault_(options.fault), poses_{setup.start.pose} {}
  ~Misbehaving() override {
    if (fault_ == Fault::destructor && size() > 1) std::abort();
  }
  Misbehaving(const Misbehaving&) = delete;
  Misbehaving& operator=(const Misbehaving&) = delete;

  std::size_t size() const override { return poses_.size(); }
  Pose pose(std::size_t k) const override { return poses_[k]; }

  void add_keyframe(const RelativePose& step) override {
    poses_.push_back(compose(poses_.back(), step.forward().motion));
    if (fault_ == Fault::random && size() == 2) fault_ = drawn_from(step.motion.x);
    if (size() == 5) misbehave();
  }

  UpdateReport update(const Measurements& measurements) override {
    UpdateReport report;
    for (const RelativePose& z : measurements.registrations) {
      report.loops.push_back({z.from, z.to, LoopFate::used, std::nullopt});
    }
    for (const AbsolutePose& z : measurements.absolute) {
      report.absolute.push_back({z.keyframe, LoopFate::used, std::nullopt});
    }
    return report;
  }

  std::optional<Eigen::MatrixXd> joint_covariance(std::span<const std::size_t>) const override {
    return std::nullopt;
  }

 private:
  // The same for the same survey, whoever asks.
  static Fault drawn_from(double x) {
    unsigned long long bits = 0;
    std::memcpy(&bits, &x, sizeof bits);
    constexpr Fault kAll[] = {Fault::none, Fault::crash, Fault::hang, Fault::memory, Fault::exit};
    return kAll[(bits >> 8) % 5];
  }

  void misbehave() {
    switch (fault_) {
      case Fault::crash:
        std::fprintf(stderr, "first line\nabout to crash \xff\n");
        std::raise(SIGSEGV);
        break;
      case Fault::hang:
        while (true) std::this_thread::sleep_for(std::chrono::hours(1));
      case Fault::memory:
        // Not touched: on a busy machine pages would take longer than a run may.
        while (true) held_.emplace_back().reserve(std::size_t{16} << 20);
      case Fault::c_memory:
        while (true) {
          constexpr std::size_t kSome = std::size_t{1} << 20;
          auto* const block = static_cast<volatile char*>(std::malloc(kSome));
          for (std::size_t i = 0; i < kSome; i += 1024) block[i] = 'x';
        }
      case Fault::noise:
        for (int line = 0; line < 200'000; ++line) std::printf("noise %d\n", line);
        break;
      case Fault::fork:
        if (::fork() == 0) {
          ::execlp("sleep", "sleep", "7654.03125", nullptr);
          ::_exit(1);
        }
        break;
      case Fault::exit:
        ::_exit(3);
      case Fault::none:
      case Fault::destructor:
      case Fault::random:
        break;
    }
  }

  Fault fault_;
  std::vector<Pose> poses_;
  std::vector<std::vector<char>> held_;
};

void add_estimators(EstimatorRegistry& registry) {
  registry.add(make_entry<Options>("misbehaving", "dead reckoning that fails as it is told", false,
                                   [](const EstimatorSetup& setup, const Options& options) {
                                     return std::make_unique<Misbehaving>(setup, options);
                                   }));
}

}  // namespace

FATHOM_PLUGIN(add_estimators)
