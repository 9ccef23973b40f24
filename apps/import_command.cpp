// fathom import: a bag, or the poses of another tool, as an image folder.

#include <filesystem>
#include <functional>
#include <memory>
#include <set>

#include "apps/child_process.hpp"
#include "apps/command.hpp"
#include "apps/common.hpp"
#include "apps/output.hpp"
#include "apps/terminal.hpp"
#include "fathom/core/environment_error.hpp"
#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "fathom/datasets/image_folder.hpp"
#include "fathom/datasets/import.hpp"
#include "fathom/workflow/inputs.hpp"

namespace fathom {
namespace {

struct ImportFlags {
  std::string source;
  std::string out;
  bool list = false;
  bool quiet = false;
  BagImportOptions bag;
  std::string camera;
  std::string clock = "auto";
  PoseImportOptions poses;
  std::string survey;
  std::string times;
};

void print_import(const ImportReport& report) {
  for (const std::string& fact : report.facts) print("%s\n", fact.c_str());
  for (const std::string& line : report.notes) print("note: %s\n", line.c_str());
}

// What a run would refuse is refused here, by the bag's name: the files are not kept.
void require_readable(const std::string& source, const std::filesystem::path& folder) {
  try {
    const ImageFolder readable(folder);
  } catch (const EnvironmentError&) {
    throw;
  } catch (const InputError& error) {
    const std::string here = folder.string() + "/";
    std::string what = error.what();
    for (std::size_t at = what.find(here); at != std::string::npos; at = what.find(here)) {
      what.erase(at, here.size());
    }
    throw InputError(source, "what is imported from it is no survey: " + what);
  }
}

void import_into(const ImportFlags& flags, ImportKind kind, StagedFolder& folder) {
  ImportReport report;
  bool is_survey = false;
  if (kind == ImportKind::colmap) {
    report = import_colmap(flags.source, flags.poses, folder.path());
  } else if (kind == ImportKind::kitti) {
    report = import_kitti(flags.source, flags.poses, folder.path());
  } else {
    Terminal terminal(flags.quiet);
    report = import_bag(flags.source, flags.bag, folder.path(), terminal.progress_of("import"));
    require_readable(flags.source, folder.path());
    is_survey = true;
  }
  folder.commit();
  if (flags.quiet) return;
  print_import(report);
  const std::string target = folder.target().string();
  if (is_survey) {
    print("\nwrote %s\nlook at it with: fathom check %s\n", (folder.target() / "mav0").c_str(),
          shell_word(target).c_str());
  } else {
    print("\nwrote %s\n      %s\n", (folder.target() / "state_groundtruth_estimate0").c_str(),
          (folder.target() / "reference.tum").c_str());
  }
}

// librosbag takes lengths and offsets within a chunk on trust.
void do_safely(ImportKind kind, const std::string& source, const std::function<void()>& action) {
  if (kind == ImportKind::ros1_bag) {
    in_child_process(source, action);
  } else {
    action();
  }
}

// Data of the user's are not replaced.
void refuse_existing(const std::filesystem::path& out, bool is_bag) {
  const std::filesystem::path there = out / (is_bag ? "mav0" : "state_groundtruth_estimate0");
  std::error_code error;
  if (!std::filesystem::exists(there, error)) return;
  throw InputError(there.string(),
                   "is there already; give another --out, or move it out of the way");
}

// Ignored, they would look as if they had been heeded.
void refuse_flags_of_others(const std::vector<std::string>& given, ImportKind kind, bool is_bag) {
  static const std::set<std::string> kOfAll{"--out", "--quiet", "--list"};
  static const std::set<std::string> kOfPoses{"--survey", "--scale", "--times"};
  for (const std::string& flag : given) {
    if (kOfAll.contains(flag)) continue;
    const bool is_of_poses = kOfPoses.contains(flag);
    if (is_bag == is_of_poses) {
      throw InputError(flag + ": goes with " + (is_of_poses ? "poses" : "bags") +
                       ", and the source is " + (is_bag ? "a bag" : "none"));
    }
    if (flag == "--times" && kind != ImportKind::kitti) {
      throw InputError(flag + ": goes with KITTI poses; a COLMAP model names its pictures");
    }
  }
}

void import_source(ImportFlags& flags, const std::vector<std::string>& given, Context& context) {
  flags.bag.camera_yaml = flags.camera;
  flags.bag.clock = flags.clock == "record"   ? BagClock::record
                    : flags.clock == "header" ? BagClock::header
                                              : BagClock::automatic;
  flags.poses.survey = flags.survey;
  flags.poses.times = flags.times;
  const ImportKind kind = import_kind(flags.source);
  const bool is_bag = kind == ImportKind::ros1_bag || kind == ImportKind::ros2_bag;
  refuse_flags_of_others(given, kind, is_bag);
  context.status = kDone;
  if (flags.list) {
    if (!is_bag) throw InputError("--list: " + flags.source + " is no bag, it has no topics");
    do_safely(kind, flags.source, [&] {
      for (const std::string& line : bag_topic_list(flags.source, flags.bag)) {
        print("%s\n", line.c_str());
      }
    });
    return;
  }
  const std::string out =
      flags.out.empty() ? "runs/" + workflow::stem_of(flags.source) + "-data" : flags.out;
  refuse_existing(out, is_bag);
  StagedFolder folder(out, {flags.source, flags.camera, flags.times});
  do_safely(kind, flags.source, [&] { import_into(flags, kind, folder); });
}

void add_topic_flags(Command& command, BagImportOptions& bag) {
  command.text("--images", bag.images, "TOPIC", "Image or CompressedImage");
  command.text("--camera-info", bag.camera_info, "TOPIC", "CameraInfo");
  command.text("--altitude", bag.altitude, "TOPIC",
               "Altitude: Range, PointStamped, Float64 or Float32");
  command.text("--odometry", bag.odometry, "TOPIC",
               "Dead reckoning: Odometry, PoseWithCovarianceStamped or PoseStamped; or none");
  command.text("--reference", bag.reference, "TOPIC", "Ground truth: the same types; or none");
  command.text("--heading", bag.heading, "TOPIC", "Imu with an orientation; or none");
  command.text("--attitude", bag.attitude, "TOPIC",
               "Roll and pitch: Imu with an orientation (default: that of the heading); or none");
}

void add_value_flags(Command& command, ImportFlags& flags) {
  BagImportOptions& bag = flags.bag;
  command.text("--camera", flags.camera, "FILE", "A sensor.yaml in place of a CameraInfo");
  command.real("--mount-x", bag.mount_x_m, Range::any(), "M", "Camera in the body, m forward");
  command.real("--mount-y", bag.mount_y_m, Range::any(), "M", "Camera in the body, m to port");
  command.real("--mount-yaw", bag.mount_yaw_rad, Range::any(), "RAD",
               "Camera in the body, counter-clockwise seen from above; 0: top of the picture "
               "forward");
  command.real("--altitude-m", bag.altitude_m, Range::positive(), "M",
               "One altitude for all pictures in place of a topic");
  command.choice("--altitude-axis", bag.altitude_axis, {"x", "y", "z"}, "AXIS",
                 "Of a PointStamped");
  command.real("--odometry-sigma-m", bag.odometry_sigma_m, Range::positive(), "M",
               "Error of dead reckoning in one second, in place of the bag's covariances");
  command.real("--odometry-sigma-rad", bag.odometry_sigma_rad, Range::positive(), "RAD",
               "The same of its heading");
  command.real("--attitude-sigma", bag.attitude_sigma_rad, Range::between(0, 0.5), "RAD",
               "Error of roll and of pitch, in place of the bag's covariances");
  command.choice("--clock", flags.clock, {"auto", "header", "record"}, "CLOCK",
                 "Times: of the headers, checked against recording; of the headers; of recording");
}

}  // namespace

void add_import(CLI::App& program, Context& context) {
  auto flags = std::make_shared<ImportFlags>();
  Command command(
      program, "import",
      "Make an image folder of a ROS bag, or a reference of another tool's poses",
      "Examples: fathom import dive.bag --list\n"
      "          fathom import dive.bag --images /cam/image_raw --altitude /dvl/range --out dive\n"
      "          fathom import colmap_text --survey dive --scale 1.83 --out dive/mav0\n"
      "Topics are guessed by their types and named by flags. A COLMAP text model and KITTI poses\n"
      "become state_groundtruth_estimate0 and reference.tum (docs/import.md).");
  command.argument("source", flags->source,
                   "Bag of ROS 1 (.bag) or ROS 2 (.db3, .mcap or folder), COLMAP text model or "
                   "KITTI poses");
  command.text("--out", flags->out, "DIR", "Output folder (default: runs/SOURCE's name-data)");
  command.boolean("--list", flags->list, "List the topics of a bag and what they are taken for");
  command.boolean("--quiet", flags->quiet, "No output but errors");
  add_topic_flags(command, flags->bag);
  add_value_flags(command, *flags);
  command.text("--survey", flags->survey, "DIR", "Poses: the survey that they are of");
  command.text("--times", flags->times, "FILE", "KITTI poses: seconds, one a line");
  command.real("--scale", flags->poses.scale, Range::positive(), "M", "Poses: metres per unit");
  command.on_run([flags, command, &context] { import_source(*flags, command.given(), context); });
}

}  // namespace fathom
