#include "architecture/include_rules.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <string_view>

#include "architecture/third_parties.hpp"

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
      {"memory_meter", {"harness"}},
      {"report", {"results"}},
      {"workflow", {"harness", "report"}},
      {"apps", {"workflow", "estimators", "memory_meter"}},
      {"python", {"workflow", "estimators"}},
      {"benchmarks", {"workflow", "estimators", "memory_meter"}}};
  return rows;
}

bool may_use(const std::string& from, const std::string& to) {
  if (from == to) return true;
  const auto row = module_rows().find(from);
  return row != module_rows().end() &&
         std::any_of(row->second.begin(), row->second.end(),
                     [&](const std::string& next) { return may_use(next, to); });
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
  for (const std::string folder : {"adapters", "apps", "python", "benchmarks"}) {
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

// Linear algebra that knows no poses: what is below the estimators may stand on it, too.
bool is_linear_algebra_of(const std::string& module, const std::string& support) {
  return module == "measurements" && support == "sparse";
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
  const bool measures = from == "benchmarks";
  if (!to) {
    // A private header of the same folder; what tests and benchmarks draw alike.
    const bool is_private = include.target.find('/') == std::string::npos;
    const bool has_private = include.file.starts_with("src/") || measures;
    const bool is_shared = measures && include.target.starts_with("support/pairs/");
    return (is_private && has_private) || is_shared ? "" : "is neither ours nor private";
  }
  if (!module_rows().contains(*to)) return "is of no module that the design names";
  const std::string support = support_part_of(include.target);
  if (is_linear_algebra_of(from, support)) return "";
  if (!may_use(from, *to)) return from + " may not include " + *to;
  if (measures) return "";  // the inside of a module or an estimator, too
  if (include.target.starts_with("src/"))
    return "is a module's own; only its folder may include it";
  const bool reads_pictures = include.target == "fathom/vision/camera.hpp" ||
                              include.target == "fathom/vision/picture_codecs.hpp";
  if (from == "datasets" && *to == "vision" && !reads_pictures) {
    return "datasets may include no more of vision than its camera and codecs";
  }
  if (include.file.starts_with("estimators/support/")) {
    return complaint_about_support(support_part_of(include.file), support.empty() ? *to : support);
  }
  if (include.target.starts_with("adapters/")) {
    const std::string folder = folder_of(include.target);
    return folder == folder_of(include.file) || folder == "adapters/support/"
               ? ""
               : "is another adapter's";
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
  if (is_linear_algebra_of(from, support)) return "";
  if (from == "estimators" && to == "estimators") {
    const bool is_allowed = target == "fathom_estimators" || !support.empty();
    return is_allowed ? "" : target + " links another estimator, " + linked;
  }
  return from != to && may_use(from, to) ? "" : target + " may not link " + linked;
}

}  // namespace fathom::test
