#include "estimators/command/solver_files.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "fathom/core/environment_error.hpp"
#include "fathom/core/files.hpp"
#include "fathom/core/program.hpp"
#include "fathom/core/text.hpp"
#include "fathom/geometry/trajectory_file.hpp"

namespace fathom::command {
namespace {

namespace fs = std::filesystem;

// Read at once, and then forgotten: it need not be on a disk.
void put(const fs::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw EnvironmentError(path.string(), "cannot be written", errno);
}

void replace_all(std::string& text, std::string_view what, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size()) {
    text.replace(at, what.size(), by);
  }
}

bool is_vertex(const std::vector<std::string_view>& words) {
  return words[0] == "VERTEX_SE2" || words[0] == "VERTEX2";
}

// id x y θ behind the word of a vertex.
void take_vertex(const std::vector<std::string_view>& words, std::vector<Pose>& poses,
                 std::vector<bool>& is_there) {
  if (words.size() != 5) {
    throw std::runtime_error("its output has a vertex that is no four numbers");
  }
  const auto id = parse_integer(words[1]);
  if (!id || *id < 0 || static_cast<std::size_t>(*id) >= poses.size()) {
    throw std::runtime_error("its output names vertices that it was not given");
  }
  const auto node = static_cast<std::size_t>(*id);
  if (is_there[node]) {
    throw std::runtime_error("its output has vertex " + std::to_string(node) + " twice");
  }
  Pose& pose = poses[node];
  double* const fields[] = {&pose.x, &pose.y, &pose.theta};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto number = parse_real(words[i + 2]);
    if (!number) throw std::runtime_error("its output has a vertex that is no four numbers");
    *fields[i] = *number;
  }
  is_there[node] = true;
}

struct PoseAtTime {
  double time = 0.0;
  Pose pose;
};

PoseAtTime of_tum(const std::vector<std::string_view>& words) {
  double values[8];
  for (std::size_t i = 0; i < 8; ++i) {
    const auto number = parse_real(words[i]);
    if (!number) throw std::runtime_error("its output is neither g2o nor TUM");
    values[i] = *number;
  }
  const Eigen::Quaterniond q(values[7], values[4], values[5], values[6]);
  // As of a trajectory file: few digits are no fault.
  if (!(q.squaredNorm() > 0.5 && q.squaredNorm() < 2.0)) {
    throw std::runtime_error("its output has a quaternion whose length is not 1");
  }
  const double yaw = yaw_of({values[7], values[4], values[5], values[6]});
  return {values[0], {values[1], values[2], yaw}};
}

// Words of each line that is no comment.
template <class Take>
void for_each_line(const std::string& text, Take take) {
  std::istringstream all(text);
  for (std::string line; std::getline(all, line);) {
    const auto words = split(line);
    if (!words.empty() && words[0].front() != '#') take(words);
  }
}

// In the order of the nodes, which times that do not rise would contradict.
std::vector<Pose> poses_of_tum(const std::string& text) {
  std::vector<Pose> poses;
  double last = -std::numeric_limits<double>::infinity();
  for_each_line(text, [&](const std::vector<std::string_view>& words) {
    if (words.size() != 8) return;
    const auto [time, pose] = of_tum(words);
    if (!(time > last)) throw std::runtime_error("its output has times that do not rise");
    last = time;
    poses.push_back(pose);
  });
  return poses;
}

}  // namespace

std::string to_text(const ProgramGraph& graph) {
  std::string text;
  for (std::size_t k = 0; k < graph.poses.size(); ++k) {
    text += "VERTEX_SE2 " + std::to_string(k) + text_of(graph.poses[k]) + '\n';
  }
  text += "FIX 0\n";
  for (const RelativePose& z : graph.edges) text += "EDGE_SE2" + text_of(z) + '\n';
  return text;
}

std::vector<Pose> poses_in(const std::string& text, std::size_t count) {
  std::vector<Pose> poses(count);
  std::vector<bool> is_there(count, false);
  bool is_g2o = false;
  for_each_line(text, [&](const std::vector<std::string_view>& words) {
    if (!is_vertex(words)) return;
    is_g2o = true;
    take_vertex(words, poses, is_there);
  });
  if (!is_g2o) poses = poses_of_tum(text);
  const auto found =
      is_g2o ? static_cast<std::size_t>(std::ranges::count(is_there, true)) : poses.size();
  if (found != count) {
    throw std::runtime_error("its output has " + std::to_string(found) + " poses, expected " +
                             std::to_string(count));
  }
  return poses;
}

std::vector<Pose> SolverFiles::call(const ProgramGraph& graph, double& processor_s,
                                    std::int64_t& peak_bytes) {
  const std::string input = (folder_->path() / "input.g2o").string();
  const std::string output = (folder_->path() / "output").string();
  std::error_code is_not_there;
  fs::remove(output, is_not_there);
  const std::string text = to_text(graph);
  put(input, text);
  std::vector<std::string> words = words_;
  for (std::string& word : words) {
    replace_all(word, "{input}", input);
    replace_all(word, "{output}", output);
  }
  Program program(words);
  try {
    program.finish();
    processor_s = program.processor_s();
    peak_bytes = program.peak_bytes();
    if (!fs::is_regular_file(output)) {
      throw std::runtime_error("'" + words.front() + "' wrote no " + output);
    }
    return poses_in(read_file(output), graph.poses.size());
  } catch (const std::runtime_error&) {
    // Where no more room is left than it found it is not to blame.
    put(folder_->path() / "room", text);
    throw;
  }
}

// What it takes for a graph of two nodes and a step, which leaves nothing to be solved: the median,
// as one call alone may be delayed by what else the machine does.
void SolverFiles::measure_start_up(const ProgramGraph& graph) {
  if (start_up_s_ || graph.edges.empty()) return;
  start_up_s_ = 0.0;
  RelativePose step = graph.edges.front();
  step.from = 0;
  step.to = 1;
  const ProgramGraph smallest{{graph.poses[0], compose(graph.poses[0], step.motion)}, {step}};
  std::int64_t peak_bytes = 0;
  std::array<double, 3> start_ups{};
  try {
    for (double& start_up_s : start_ups) call(smallest, start_up_s, peak_bytes);
  } catch (const EnvironmentError&) {
    throw;
  } catch (const std::runtime_error&) {
    // One that refuses so small a graph has its start-up among the rest.
    return;
  }
  std::ranges::sort(start_ups);
  start_up_s_ = start_ups[1];
}

std::vector<Pose> SolverFiles::solve(const ProgramGraph& graph) {
  ForProgram work;
  if (!folder_) folder_.emplace("fathom-command");
  measure_start_up(graph);
  double processor_s = 0.0;
  std::int64_t peak_bytes = 0;
  const std::vector<Pose> poses = call(graph, processor_s, peak_bytes);
  const double start_up_s = std::min(start_up_s_.value_or(0.0), processor_s);
  work.add_start_up_s(start_up_s);
  work.add_processor_s(processor_s - start_up_s);
  work.note_peak(peak_bytes);
  return poses;
}

}  // namespace fathom::command
