// fathom convert: trajectories and pose graphs from one format to another.

#include <filesystem>
#include <fmt/format.h>
#include <memory>

#include "apps/command.hpp"
#include "apps/common.hpp"
#include "apps/output.hpp"
#include "apps/trajectories.hpp"
#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "fathom/measurements/graph_conversion.hpp"
#include "fathom/measurements/shared_file.hpp"
#include "fathom/report/projection_text.hpp"

namespace fathom {
namespace {

namespace fs = std::filesystem;

struct ConvertFlags {
  std::string input;
  std::string to;
  std::string out;
  TrajectoryFlags trajectory;
  std::string times_out;
  ConversionOptions graph;
};

// What is said once all is written.
using Notes = std::vector<std::string>;

void refuse_flags_of_trajectories(const ConvertFlags& flags) {
  const std::pair<const char*, const std::string*> all[]{{"--from", &flags.trajectory.format},
                                                         {"--plane", &flags.trajectory.plane},
                                                         {"--times", &flags.trajectory.times},
                                                         {"--times-out", &flags.times_out}};
  for (const auto& [flag, value] : all) {
    if (!value->empty()) throw InputError(std::string(flag) + ": is for trajectories alone");
  }
}

fs::path whole(const fs::path& path) {
  std::error_code ignored;
  return fs::weakly_canonical(fs::absolute(path), ignored);
}

Notes convert_graph_file(const ConvertFlags& flags) {
  refuse_flags_of_trajectories(flags);
  const GraphFormat to = flags.to == "g2o" ? GraphFormat::g2o : GraphFormat::toro;
  const ConvertedGraph graph = convert_graph(read_text(flags.input), flags.input, to, flags.graph);
  const fs::path its_own = shared_file_of(flags.input);
  const fs::path beside = shared_file_of(flags.out);
  std::error_code ignored;
  const bool is_its_own = whole(beside) == whole(its_own);
  if (!is_its_own && fs::exists(beside, ignored)) {
    throw InputError(beside.string(), "is of another graph and would be read with " + flags.out +
                                          "; remove it, or give another --out");
  }
  write_file(output_file(flags.out), graph.text);
  Notes notes{fmt::format("{} vertices, {} edges", graph.vertices, graph.edges)};
  for (const auto& [tag, count] : graph.left_out) {
    notes.push_back(
        fmt::format("left out: {} {}, which TORO does not have", counted(count, "line"), tag));
  }
  for (const auto& [tag, count] : graph.landmarks) {
    notes.push_back(fmt::format("left out: {} {}, of landmarks", counted(count, "line"), tag));
  }
  if (!is_its_own && fs::exists(its_own, ignored)) {
    notes.push_back("left out: " + its_own.string() +
                    ", the errors that registrations share; without it they are independent");
  }
  if (graph.self_edges > 0) {
    notes.push_back("left out: " + counted(graph.self_edges, "edge") + " from a pose to itself");
  }
  return notes;
}

// On its plane, at height 0 and level.
void flatten(SpatialTrajectory& trajectory, const std::string& plane_name, Notes& notes) {
  const Plane plane = named("--plane", plane_name, plane_names());
  const PlaneAxes axes = axes_of(plane, trajectory.poses);
  const BodyAxes body = body_axes(trajectory.poses, axes);
  const Projection projection = project(trajectory.poses, axes, body);
  const auto cells = loss_cells(plane_text(plane, axes), projection.loss);
  for (std::size_t i = 0; i < cells.size(); ++i) notes.push_back(loss_rows()[i] + ": " + cells[i]);
  for (const auto& warning : projection_warnings(axes, projection, body, "the trajectory")) {
    notes.push_back("warning: " + warning);
  }
  trajectory.poses = to_space(projection.trajectory);
}

void add_what_is_lost(const ConvertFlags& flags, const SpatialTrajectory& read, TrajectoryFormat to,
                      Notes& notes) {
  if (read.further_columns > 0) {
    notes.push_back("left out: columns 9 to " + std::to_string(8 + read.further_columns) +
                    " (velocity, biases)");
  }
  if (to == TrajectoryFormat::kitti && read.has_times && flags.times_out.empty()) {
    notes.push_back("left out: the times, which KITTI does not have; --times-out FILE writes them");
  }
  if (to != TrajectoryFormat::kitti && !read.has_times) {
    notes.push_back(
        "KITTI poses have no times: the time is the index, in seconds; --times FILE "
        "gives them");
  }
}

Notes convert_trajectory_file(const ConvertFlags& flags) {
  if (flags.graph.drop_landmarks) throw InputError("--drop-landmarks: is for pose graphs alone");
  if (flags.graph.drop_self_edges) throw InputError("--drop-self-edges: is for pose graphs alone");
  const TrajectoryFormat to = named("--to", flags.to, trajectory_format_names());
  SpatialTrajectory trajectory = flags.trajectory.read(flags.input, "--from");
  if (trajectory.poses.empty()) throw InputError(flags.input, "holds no pose");
  if (!flags.times_out.empty() && !trajectory.has_times) {
    throw InputError("--times-out: " + flags.input + " has no times; --times FILE gives them");
  }
  Notes notes{fmt::format("{} poses, {} to {}", trajectory.poses.size(),
                          title_of(trajectory.format), title_of(to))};
  add_what_is_lost(flags, trajectory, to, notes);
  if (!flags.trajectory.plane.empty()) flatten(trajectory, flags.trajectory.plane, notes);
  write_file(output_file(flags.out), to_text(trajectory.poses, to));
  if (!flags.times_out.empty()) {
    write_file(output_file(flags.times_out), times_text(trajectory.poses));
  }
  return notes;
}

void convert(const ConvertFlags& flags, Context& context) {
  const bool to_graph = flags.to == "g2o" || flags.to == "toro";
  for (const std::string& output : {flags.out, flags.times_out}) {
    if (output.empty()) continue;
    refuse_replacing(output_file(output), {flags.input, flags.trajectory.times});
  }
  if (!flags.times_out.empty() && whole(flags.out) == whole(flags.times_out)) {
    throw InputError("--times-out: is the same file as --out");
  }
  if (is_graph(read_text(flags.input)) != to_graph) {
    throw InputError(flags.input, to_graph ? "is no pose graph; --to takes tum, kitti or euroc"
                                           : "is a pose graph; --to takes g2o or toro, and fathom "
                                             "solve writes its trajectory");
  }
  const Notes notes = to_graph ? convert_graph_file(flags) : convert_trajectory_file(flags);
  context.status = kDone;
  for (const std::string& note : notes) print("%s\n", note.c_str());
  print("wrote %s\n", flags.out.c_str());
  if (!flags.times_out.empty()) print("      %s\n", flags.times_out.c_str());
}

}  // namespace

void add_convert(CLI::App& program, Context& context) {
  auto flags = std::make_shared<ConvertFlags>();
  Command command(
      program, "convert", "Write a trajectory or a pose graph in another format",
      "Example: fathom convert mav0/state_groundtruth_estimate0/data.csv --to tum --out "
      "truth.tum\n"
      "         fathom convert poses.txt --times times.txt --plane xz --to tum --out "
      "flat.tum\n"
      "         fathom convert intel.g2o --to toro --out intel.graph");
  command.argument("input", flags->input,
                   "Trajectory (TUM, KITTI or EuRoC) or pose graph (g2o or TORO)");
  command
      .choice("--to", flags->to, {"tum", "kitti", "euroc", "g2o", "toro"}, "FORMAT",
              "Format to write")
      .required();
  command.text("--out", flags->out, "FILE", "File to write").required();
  command.text("--from", flags->trajectory.format, "FORMAT",
               "tum, kitti or euroc; else by the content");
  command.text("--plane", flags->trajectory.plane, "PLANE",
               "Project onto it, and level: xy, xz, yz or fit");
  command.text("--times", flags->trajectory.times, "FILE", "Times of KITTI poses, one a line (s)");
  command.text("--times-out", flags->times_out, "FILE", "Write the times there, one a line (s)");
  command.boolean("--drop-landmarks", flags->graph.drop_landmarks,
                  "Leave out landmarks and what poses see of them");
  add_drop_self_edges_to(command, flags->graph.drop_self_edges);
  command.quiet();
  command.on_run([flags, &context] { convert(*flags, context); });
}

}  // namespace fathom
