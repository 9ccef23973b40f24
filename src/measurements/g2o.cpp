#include "fathom/measurements/g2o.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <utility>
#include <vector>

#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "fathom/measurements/shared_file.hpp"
#include "g2o_file.hpp"
#include "graph_components.hpp"
#include "shared_lines.hpp"

namespace fathom {
namespace {

using KeyframeOf = std::map<std::int64_t, std::size_t>;

RelativePose measurement(const G2oFile::Edge& edge, const KeyframeOf& keyframe_of) {
  RelativePose z;
  z.from = keyframe_of.at(edge.from);
  z.to = keyframe_of.at(edge.to);
  z.motion = edge.motion;
  z.information = edge.information;
  z.inliers = edge.inliers;
  if (!edge.repeats_own || edge.shared) z.repeats = std::clamp(edge.repeats, 1.0, 1e9);
  return z;
}

AbsolutePose absolute(const G2oFile::Prior& prior, std::size_t keyframe) {
  return {keyframe, prior.pose, prior.information};
}

// A step that no edge measures: as a comment declares it, else by the file's vertices.
RelativePose hole(const G2oFile& file, std::size_t k, const std::vector<std::int64_t>& ids,
                  const GraphOptions& options) {
  RelativePose step;
  step.from = k - 1;
  step.to = k;
  step.is_hole = true;
  if (const auto declared = file.holes.find({ids[k - 1], ids[k]}); declared != file.holes.end()) {
    step.motion = declared->second.motion;
    step.information = declared->second.information;
    return step;
  }
  if (!file.vertices.empty()) {
    step.motion = between(file.vertices.at(ids[k - 1]).pose, file.vertices.at(ids[k]).pose);
  }
  const Eigen::Vector3d sigma(options.gap_sigma_m, options.gap_sigma_m, options.gap_sigma_rad);
  step.information = sigma.cwiseAbs2().cwiseInverse().asDiagonal();
  return step;
}

bool is_start(const G2oFile::Prior& prior) {
  if (!prior.start_covariance) return false;
  const auto start = AbsolutePose::from_covariance(0, prior.pose, *prior.start_covariance);
  return start.information.isApprox(prior.information, 1e-9);
}

// The prior that is the log's own start, if it is one: to_g2o says so. Edited by hand it is a prior
// as any other.
const G2oFile::Prior* start_prior(const G2oFile& file, std::int64_t first_id) {
  if (file.is_start_fixed()) return nullptr;
  for (const G2oFile::Prior& prior : file.priors) {
    if (prior.id == first_id && is_start(prior)) return &prior;
  }
  return nullptr;
}

StartPose start_of(const G2oFile& file, const G2oFile::Prior* prior) {
  StartPose start(file.vertices.empty() ? Pose{} : file.vertices.begin()->second.pose);
  if (file.vertices.empty() && !file.is_start_fixed()) start.pose = file.priors.front().pose;
  if (prior != nullptr) {
    start.pose = prior->pose;
    start.covariance = *prior->start_covariance;
  } else {
    start.is_free = !file.is_start_fixed();
  }
  return start;
}

// The lines of a file by the keyframe that they arrive with, in file order.
struct Arrivals {
  explicit Arrivals(const G2oFile& file)
      : keyframe_of(file.keyframes()), edges(keyframe_of.size()), priors(keyframe_of.size()) {
    for (std::size_t e = 0; e < file.edges.size(); ++e) {
      const G2oFile::Edge& edge = file.edges[e];
      edges[keyframe_of.at(std::max(edge.from, edge.to))].push_back(e);
    }
    for (const G2oFile::Prior& prior : file.priors) {
      priors[keyframe_of.at(prior.id)].push_back(&prior);
    }
  }

  KeyframeOf keyframe_of;
  std::vector<std::vector<std::size_t>> edges;
  std::vector<std::vector<const G2oFile::Prior*>> priors;
};

MeasurementLog build_log(const G2oFile& file, const GraphOptions& options) {
  const Arrivals arrivals(file);
  const G2oFile::Prior* own_start = start_prior(file, arrivals.keyframe_of.begin()->first);
  MeasurementLog log(start_of(file, own_start));
  for (const auto& [id, keyframe] : arrivals.keyframe_of) log.ids.push_back(id);
  log.self_edges = file.self_edges;
  const auto add_priors = [&](std::size_t k) {
    for (const G2oFile::Prior* prior : arrivals.priors[k]) {
      if (prior != own_start) log.add_absolute(absolute(*prior, k));
    }
  };
  add_priors(0);
  for (std::size_t k = 1; k < log.ids.size(); ++k) {
    const auto step = find_step(file, arrivals.edges[k], k, log.ids);
    log.add_keyframe(step ? measurement(file.edges[*step], arrivals.keyframe_of)
                          : hole(file, k, log.ids, options));
    for (const std::size_t e : arrivals.edges[k]) {
      if (step && e == *step) continue;
      RelativePose z = measurement(file.edges[e], arrivals.keyframe_of);
      z.shared = file.edges[e].shared;  // a step shares nothing
      log.add_registration(z);
    }
    add_priors(k);
  }
  if (!file.vertices.empty()) {
    log.guess.emplace();
    for (const auto& [id, vertex] : file.vertices) log.guess->push_back(vertex.pose);
  }
  return log;
}

// The component that is asked for, or all of a graph that is one.
G2oFile wanted_component(G2oFile file, const GraphOptions& options, const std::string& name,
                         const G2oFault& fault) {
  const GraphComponents components = components_of(file);
  const std::size_t count = components.members.size();
  std::size_t index = 0;
  if (options.component) {
    index = static_cast<std::size_t>(*options.component) - 1;
    if (index >= count) {
      throw InputError(name, fmt::format("has no component {}; expected 1{}", *options.component,
                                         count > 1 ? " to " + std::to_string(count) : ""));
    }
    if (count > 1) file = component_of(file, components, index);
  } else if (count > 1) {
    fault(line_about(file, components.ids[components.members[1].front()]),
          several_components(components));
  }
  check_fixed(file, fault);
  check_held(file, components, index, fault);
  return file;
}

}  // namespace

void GraphOptions::describe(OptionTable& table) {
  table.real("gap_sigma_m", gap_sigma_m, Range::between(1e-3, 1e6), "m",
             "standard deviation of the guess for a step without an odometry edge, along x and y");
  table.real("gap_sigma_rad", gap_sigma_rad, Range::between(1e-4, 100.0), "rad",
             "the same of its heading");
  table.integer_or_off("component", component, Range::at_least(1), "",
                       "of a graph that falls into several: this one alone; off: it must be one");
  table.boolean("drop_self_edges", drop_self_edges,
                "leave out edges from a pose to itself; otherwise they are refused");
}

MeasurementLog read_g2o(const std::filesystem::path& path, const GraphOptions& options) {
  // Of a run or a study.
  const std::filesystem::path inside = path / "measurements.g2o";
  std::error_code error;
  if (std::filesystem::exists(inside, error)) {
    throw InputError(path.string(), "is a folder; the graph in it is " + inside.string());
  }
  const std::optional<SharedText> shared = shared_beside(path);
  return parse_g2o(read_text(path), path.string(), options, shared ? &*shared : nullptr);
}

MeasurementLog parse_g2o(const std::string& content, const std::string& name,
                         const GraphOptions& options, const SharedText* shared) {
  const G2oFault fault = [&name](std::size_t line, const std::string& what) {
    throw InputError(name, line, what);
  };
  G2oFile file = scan_g2o(content, fault, options.drop_self_edges);
  if (file.edges.empty() && file.vertices.empty()) {
    throw InputError(name, "holds no pose graph: no vertex and no edge");
  }
  check_references(file, fault);
  if (shared != nullptr) {
    read_shared(shared->content, file, name, [shared](std::size_t line, const std::string& what) {
      throw InputError(shared->name, line, what);
    });
  }
  return build_log(wanted_component(std::move(file), options, name, fault), options);
}

}  // namespace fathom
