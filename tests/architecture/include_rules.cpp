#include "architecture/include_rules.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <string_view>

namespace fathom::test {
namespace {

using Words = std::vector<std::string>;

// What each module may include; and what that may include in turn.
const std::map<std::string, Words>& module_rows() {
  static const std::map<std::string, Words> rows{
      {"core", {}},
      {"geometry", {"core"}},
      {"measurements", {"geometry"}},
      {"vision", {"measurements"}},
      {"datasets", {"vision", "measurements"}},
      {"front_end", {"vision", "datasets", "measurements"}},
      {"estimation", {"measurements"}},
      {"evaluation", {"measurements"}},
      {"estimators", {"estimation"}},
      {"adapters", {"estimation"}},
      {"configuration", {"front_end", "estimation", "evaluation"}},
      {"results", {"configuration", "evaluation"}},
      {"harness", {"front_end", "estimation", "results"}},
      {"report", {"harness"}},
      {"apps", {"harness", "report", "estimators"}}};
  return rows;
}

bool may_use(const std::string& from, const std::string& to) {
  if (from == to) return true;
  const auto row = module_rows().find(from);
  return row != module_rows().end() &&
         std::any_of(row->second.begin(), row->second.end(),
                     [&](const std::string& next) { return may_use(next, to); });
}

// A third party by the way its headers begin, and the folders or files that may use it.
struct ThirdParty {
  std::string header;
  Words users;
};

const std::vector<ThirdParty>& third_parties() {
  static const std::vector<ThirdParty> list{
      {"Eigen/", {""}},
      {"opencv2/",
       {"vision/", "datasets/", "front_end/", "src/report/pictures/", "src/report/earth/",
        "include/fathom/report/geo_tiff.hpp", "include/fathom/report/match_picture.hpp",
        "include/fathom/report/mosaic.hpp", "include/fathom/report/world_file.hpp",
        "include/fathom/report/picture.hpp", "apps/"}},
      {"boost/math/", {"src/core/chi_squared.cpp", "src/evaluation/distributions.cpp"}},
      {"ceres/", {"estimators/ceres_pose_graph/"}},
      {"mrpt/", {"adapters/mrpt/"}},
      {"yaml-cpp/",
       {"src/configuration/", "src/datasets/image_folder/camera_yaml.cpp",
        "src/datasets/image_folder/sensor_yaml.cpp", "src/datasets/import/ros2_metadata.cpp"}},
      {"immintrin.h", {"include/fathom/core/cpu.hpp"}},
      {"geo_normalize.h", {"src/report/earth/geo_tiff.cpp"}},
      {"geodesic.h",
       {"src/datasets/image_folder/earth_fixes.cpp", "src/report/earth/earth_frame.cpp"}},
      {"geotiffio.h", {"src/report/earth/geo_tiff.cpp"}},
      {"proj.h", {"src/report/earth/earth_frame.cpp"}},
      {"xtiffio.h", {"src/report/earth/geo_tiff.cpp"}},
      {"libexif/", {"src/datasets/pictures/exif.cpp"}},
      {"console_bridge/", {"src/datasets/import/ros1_module.cpp"}},
      {"rosbag/", {"src/datasets/import/ros1_module.cpp"}},
      {"dlfcn.h", {"src/datasets/import/ros1_bag.cpp", "src/estimation/plugin.cpp"}},
      {"fastcdr/", {"src/datasets/import/cdr_message.cpp"}},
      {"SQLiteCpp/",
       {"src/results/", "src/front_end/registration_", "src/datasets/import/ros2_bag.cpp"}},
      {"sqlite3.h", {"src/results/", "src/front_end/registration_"}},
      {"nlohmann/", {"src/results/", "src/harness/", "src/report/"}},
      {"cairo", {"src/report/"}},
      {"cblas.h", {"src/core/blas_memory.cpp", "src/vision/", "apps/pin_threads.cpp"}},
      {"CLI/", {"apps/"}},
      {"glog/", {"apps/main.cpp"}},
      {"omp.h", {"apps/pin_threads.cpp"}},
      {"malloc.h", {"apps/memory_meter.cpp", "src/core/system.cpp"}},
      {"signal.h", {"src/core/files.cpp", "src/core/system.cpp"}},
      {"fcntl.h",
       {"src/core/child_side.cpp", "src/core/file_lock.cpp", "src/core/forked_child.cpp",
        "src/core/program.cpp", "src/core/program_start.cpp", "src/core/system.cpp"}},
      {"sys/mman.h",
       {"estimators/support/filter/growing_memory.cpp",
        "estimators/support/sparse/panel_memory.cpp", "src/core/blas_memory.cpp",
        "src/core/child_side.cpp"}},
      {"sys/prctl.h", {"src/core/child_side.cpp"}},
      {"poll.h", {"src/core/forked_child.cpp", "src/core/program.cpp"}},
      {"spawn.h", {"src/core/program_start.cpp"}},
      {"sys/file.h", {"src/core/file_lock.cpp"}},
      {"sys/wait.h",
       {"apps/child_process.cpp", "src/core/forked_child.cpp", "src/core/program.cpp"}},
      {"sys/resource.h",
       {"src/core/child_side.cpp", "src/core/program.cpp", "src/core/system.cpp"}},
      {"unistd.h",
       {"src/core/child_side.cpp", "src/core/files.cpp", "src/core/file_lock.cpp",
        "src/core/forked_child.cpp", "src/core/program.cpp", "src/core/program_start.cpp",
        "src/core/system.cpp", "apps/child_process.cpp", "apps/common.cpp",
        "apps/out_of_memory.cpp", "apps/stop_signal.cpp"}}};
  return list;
}

bool is_one_of(const std::string& file, const Words& users) {
  for (const std::string& user : users) {
    if (file.starts_with(user)) return true;
    const bool module = user.find('/') == user.size() - 1;
    if (module && (file.starts_with("src/" + user) || file.starts_with("include/fathom/" + user))) {
      return true;
    }
  }
  return false;
}

// "vision" of src/vision/…, include/fathom/vision/…, or of an include of fathom/vision/….
std::optional<std::string> module_of(const std::string& path) {
  for (const std::string root : {"src/", "include/fathom/", "fathom/"}) {
    if (!path.starts_with(root)) continue;
    return path.substr(root.size(), path.find('/', root.size()) - root.size());
  }
  if (path.starts_with("estimators/")) return "estimators";
  for (const std::string folder : {"adapters", "apps"}) {
    if (path.starts_with(folder + "/")) return folder;
  }
  return std::nullopt;
}

std::string folder_of(const std::string& path) {
  return path.substr(0, path.rfind('/') + 1);
}

// What several estimators are built from: each part, and what it may include of ours.
const std::map<std::string, Words>& support_rows() {
  static const std::map<std::string, Words> rows{
      {"sparse", {"core"}}, {"pose_graph", {"sparse", "estimation"}}, {"filter", {"estimation"}}};
  return rows;
}

// "sparse" of estimators/support/sparse/…; empty elsewhere.
std::string support_part_of(const std::string& path) {
  const std::string root = "estimators/support/";
  if (!path.starts_with(root)) return "";
  return path.substr(root.size(), path.find('/', root.size()) - root.size());
}

bool support_may_use(const std::string& part, const std::string& to) {
  if (part == to) return true;
  const auto row = support_rows().find(part);
  return row != support_rows().end() &&
         std::any_of(row->second.begin(), row->second.end(), [&](const std::string& next) {
           return support_may_use(next, to) || may_use(next, to);
         });
}

// `to` is a module, or a part of the support.
std::string complaint_about_support(const std::string& part, const std::string& to) {
  if (!support_rows().contains(part)) return "lies in no support that the design names";
  return support_may_use(part, to) ? "" : "support " + part + " may not include " + to;
}

std::string judge_angled(const Include& include) {
  // A header of the standard library has neither a folder nor an ending.
  if (include.target.find_first_of("/.") == std::string::npos) return "";
  for (const ThirdParty& party : third_parties()) {
    if (!include.target.starts_with(party.header)) continue;
    return is_one_of(include.file, party.users) ? "" : "is not for this folder";
  }
  return "is of no third party that the design names";
}

std::string judge_quoted(const Include& include) {
  const std::string from = *module_of(include.file);
  const auto to = module_of(include.target);
  if (!to) {
    // A private header of the same folder.
    const bool is_private = include.target.find('/') == std::string::npos;
    return is_private && include.file.starts_with("src/") ? "" : "is neither ours nor private";
  }
  if (!module_rows().contains(*to)) return "is of no module that the design names";
  if (!may_use(from, *to)) return from + " may not include " + *to;
  const bool sees_a_camera = include.target == "fathom/vision/camera.hpp";
  if (from == "datasets" && *to == "vision" && !sees_a_camera) {
    return "datasets may include no more of vision than its camera";
  }
  const std::string support = support_part_of(include.target);
  if (include.file.starts_with("estimators/support/")) {
    return complaint_about_support(support_part_of(include.file), support.empty() ? *to : support);
  }
  if (!include.target.starts_with("estimators/")) return "";
  if (from == "estimators" && !support.empty()) return "";
  const bool is_own = folder_of(include.file) == folder_of(include.target);
  return is_own ? "" : "is an estimator's own; only its folder may include it";
}

}  // namespace

std::vector<Include> includes_of(const std::string& file, const std::string& text) {
  static const std::regex kInclude(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"].*$)");
  std::vector<Include> includes;
  std::istringstream lines(text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::smatch found;
    if (std::regex_match(line, found, kInclude)) {
      includes.push_back({file, number, found[2], found[1] == "<"});
    }
  }
  return includes;
}

std::string complaint_about(const Include& include) {
  const auto from = module_of(include.file);
  const std::string what = !from || !module_rows().contains(*from)
                               ? "lies in no module that the design names"
                           : include.angled ? judge_angled(include)
                                            : judge_quoted(include);
  if (what.empty()) return "";
  return include.file + ":" + std::to_string(include.line) + ": " + include.target + ": " + what;
}

std::string complaint_about_link(const std::string& target, const std::string& linked) {
  constexpr std::string_view kOurs = "fathom_";
  constexpr std::string_view kSupport = "fathom_support_";
  if (!linked.starts_with(kOurs)) return "";
  // Each estimator is a target of its own, of no other name in the table.
  const auto module = [&](const std::string& name) {
    const std::string bare = name.starts_with(kOurs) ? name.substr(kOurs.size()) : name;
    return module_rows().contains(bare) ? bare : std::string("estimators");
  };
  const std::string from = module(target);
  const std::string to = module(linked);
  const std::string support =
      linked.starts_with(kSupport) ? linked.substr(kSupport.size()) : std::string();
  if (target.starts_with(kSupport)) {
    const std::string complaint =
        complaint_about_support(target.substr(kSupport.size()), support.empty() ? to : support);
    return complaint.empty() ? "" : target + " may not link " + linked;
  }
  if (from == "estimators" && to == "estimators") {
    const bool is_allowed = target == "fathom_estimators" || !support.empty();
    return is_allowed ? "" : target + " links another estimator, " + linked;
  }
  return from != to && may_use(from, to) ? "" : target + " may not link " + linked;
}

}  // namespace fathom::test
