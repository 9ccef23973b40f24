// What a program answers to the estimator `command`: poses in a file, and by lines.
#include <algorithm>
#include <stdexcept>

#include "estimators/command/dialogue.hpp"
#include "estimators/command/solver_files.hpp"
#include "support/fuzz.hpp"

namespace {

using namespace fathom;

constexpr std::size_t kNodes = 3;

// A failure of the program is a std::runtime_error, which InputError is one of.
template <class Action>
void let_fail(Action action) {
  try {
    const std::vector<Pose> poses = action();
    fuzz::require(poses.size() == kNodes, "there is a pose for every node");
    for (const Pose& pose : poses) fuzz::require(is_finite(pose), "poses are finite");
  } catch (const std::runtime_error&) {
  }
}

// A program's lines, one after the other.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}

  std::string next() {
    if (rest_.empty()) throw std::runtime_error("the program has ended");
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    const std::string line(rest_.substr(0, end));
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    return line;
  }

 private:
  std::string_view rest_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::Folder folder("answer");
  const std::string text(fuzz::text_of(data, size));
  let_fail([&] { return command::poses_in(text, kNodes); });
  Lines lines(text);
  let_fail([&] { return command::answered_poses([&] { return lines.next(); }, kNodes); });
  // By a process as well, which takes long: where that is asked for, and there may be an answer.
  if (!text.starts_with("process") || text.find("BEGIN") == std::string::npos) return 0;
  const std::filesystem::path file = folder.write("answer", "END\n" + text);
  command::ProgramGraph graph;
  graph.poses.resize(kNodes);
  // It ends when it has been told all: three lines at first, then two nodes and two commands.
  const std::string program = "cat " + file.string() + "; head -n 7 > /dev/null";
  let_fail([&] { return command::Dialogue({"/bin/sh", "-c", program}, 1).solve(graph); });
  return 0;
}
