#include "g2o_file.hpp"

#include <array>
#include <fmt/format.h>
#include <string_view>
#include <utility>

#include "edge_information.hpp"
#include "fathom/core/text.hpp"
#include "fathom/geometry/covariance.hpp"
#include "graph_landmarks.hpp"

namespace fathom {
namespace {

using Fields = std::vector<std::string_view>;

/// What ends the reading of one line.
struct LineFault {
  std::string what;
};

[[noreturn]] void fail(const std::string& what) {
  throw LineFault{what};
}

void expect_fields(const Fields& fields, std::size_t count, const std::string& what) {
  if (fields.size() == count) return;
  fail(fmt::format("{} takes {} ({} values), got {}", fields.front(), what, count - 1,
                   fields.size() - 1));
}

std::int64_t integer(std::string_view text) {
  const auto value = parse_integer(text);
  if (!value || *value < 0) fail(in_quotes(text) + " is not an id");
  return *value;
}

double real(std::string_view text) {
  const auto value = parse_real(text);
  if (!value) fail(in_quotes(text) + " is not a finite number");
  return *value;
}

Pose read_pose(const Fields& fields, std::size_t at) {
  return {real(fields[at]), real(fields[at + 1]), wrap_angle(real(fields[at + 2]))};
}

template <std::size_t Count>
std::array<double, Count> reals(const Fields& fields, std::size_t at) {
  std::array<double, Count> values{};
  for (std::size_t i = 0; i < Count; ++i) values[i] = real(fields[at + i]);
  return values;
}

// `# hole i j x y theta` and six information values: a step from i to j that was not measured.
std::optional<G2oFile::Edge> hole_of(const Fields& words) {
  if (words.size() != 12) return std::nullopt;
  try {
    G2oFile::Edge hole;
    hole.from = integer(words[1]);
    hole.to = integer(words[2]);
    hole.motion = read_pose(words, 3);
    hole.information = information_of(reals<6>(words, 6), GraphFormat::g2o);
    return is_positive_definite(hole.information) ? std::optional(hole) : std::nullopt;
  } catch (const LineFault&) {
    return std::nullopt;
  }
}

// `# start` and six values of a covariance, above the prior that is the log's start.
std::optional<Eigen::Matrix3d> start_covariance_of(const Fields& words) {
  if (words.size() != 7) return std::nullopt;
  try {
    const Eigen::Matrix3d covariance = information_of(reals<6>(words, 1), GraphFormat::g2o);
    return is_positive_definite(covariance) ? std::optional(covariance) : std::nullopt;
  } catch (const LineFault&) {
    return std::nullopt;
  }
}

class Scanner {
 public:
  Scanner(G2oFile& file, const G2oFault& fault, bool drop_self_edges)
      : file_(file), fault_(fault), drop_self_edges_(drop_self_edges) {}

  void read(const TextLine& line) {
    file_.lines = line.number;
    try {
      read_line(line.text);
    } catch (const LineFault& fault) {
      fault_(file_.lines, fault.what);
    }
  }

  /// What many lines have in common is told once.
  void finish() {
    if (first_landmark_ > 0) refuse_landmarks(landmarks_, first_landmark_, fault_);
    information_.tell(fault_);
  }

 private:
  void read_line(std::string_view line) {
    if (line.size() > kLongestRow) fail(kTooLongRow);
    const std::size_t comment = line.find('#');
    if (comment != std::string_view::npos) {
      read_comment(split(line.substr(comment + 1)));
      line = line.substr(0, comment);
    }
    const Fields fields = split(line);
    if (fields.empty()) return;
    const std::string_view tag = fields.front();
    if (tag == "VERTEX_SE2" || tag == "VERTEX2") {
      read_vertex(fields);
    } else if (tag == "EDGE_SE2" || tag == "EDGE2") {
      read_edge(fields, tag == "EDGE2" ? GraphFormat::toro : GraphFormat::g2o);
    } else if (tag == "EDGE_PRIOR_SE2") {
      read_prior(fields);
    } else if (tag == "EDGE_PRIOR_SE2_XY") {
      read_position_prior(fields);
    } else if (tag == "FIX") {
      read_fixed(fields);
    } else if (is_of_landmarks(tag)) {
      landmarks_.add(tag);
      if (first_landmark_ == 0) first_landmark_ = file_.lines;
    } else if (tag != "PARAMS_SE2OFFSET") {  // what goes by it is refused
      refuse_tag(tag);
    }
  }

  [[noreturn]] static void refuse_tag(std::string_view tag) {
    if (tag == "EQUIV") {
      fail(
          "EQUIV says that two ids are one vertex, which is not read; expected one of them in "
          "place of the other, on all lines, and one line that defines it");
    }
    fail("unknown tag " + in_quotes(tag) +
         "; a 2-D graph has VERTEX_SE2, EDGE_SE2, FIX, EDGE_PRIOR_SE2, EDGE_PRIOR_SE2_XY, "
         "VERTEX2, EDGE2");
  }

  void read_fixed(const Fields& fields) {
    if (fields.size() == 1) fail("FIX without an id");
    for (std::size_t i = 1; i < fields.size(); ++i)
      file_.fixed.push_back({integer(fields[i]), file_.lines});
  }

  // What to_g2o writes in comments; any other comment is just that.
  void read_comment(const Fields& words) {
    if (words.empty()) return;
    if (words[0] == "inliers" && words.size() == 2) {
      const std::int64_t count = parse_integer(words[1]).value_or(-1);
      if (count >= 0 && count < 1'000'000'000) told_.inliers = static_cast<int>(count);
    } else if (words[0] == "repeats" && words.size() > 1) {
      told_.repeats = parse_real(words[1]).value_or(1.0);
      told_.repeats_own = words.size() > 2;
    } else if (words[0] == "hole") {
      if (const auto hole = hole_of(words)) file_.holes.try_emplace({hole->from, hole->to}, *hole);
    } else if (words[0] == "start") {
      pending_start_ = start_covariance_of(words);
    }
  }

  void read_vertex(const Fields& fields) {
    expect_fields(fields, 5, "id x y theta");
    const std::int64_t id = integer(fields[1]);
    const Pose pose = read_pose(fields, 2);
    if (!file_.vertices.emplace(id, G2oFile::Vertex{pose, file_.lines}).second) {
      fail(fmt::format("vertex {} was defined on line {} already", id, file_.vertices.at(id).line));
    }
  }

  void read_edge(const Fields& fields, GraphFormat order) {
    expect_fields(fields, 12, "i j x y theta and six information values");
    G2oFile::Edge edge = std::exchange(told_, {});
    edge.from = integer(fields[1]);
    edge.to = integer(fields[2]);
    edge.motion = read_pose(fields, 3);
    edge.line = file_.lines;
    const auto values = reals<6>(fields, 6);
    if (edge.from == edge.to) return read_self_edge(edge.from);
    const auto information = information_.read(values, order, edge.line);
    if (!information) return;
    edge.information = *information;
    file_.edges.push_back(edge);
  }

  // Its residual is the same at any pose.
  void read_self_edge(std::int64_t id) {
    if (!drop_self_edges_) {
      fail(
          fmt::format("an edge from pose {} to itself, which says nothing of any pose; expected "
                      "none: --drop-self-edges or dataset.drop_self_edges leaves such edges out",
                      id));
    }
    ++file_.self_edges;
  }

  void read_prior(const Fields& fields) {
    expect_fields(fields, 11, "id x y theta and six information values");
    G2oFile::Prior prior;
    prior.id = integer(fields[1]);
    prior.pose = read_pose(fields, 2);
    prior.information = information_of(reals<6>(fields, 5), GraphFormat::g2o);
    add_prior(prior);
  }

  void read_position_prior(const Fields& fields) {
    expect_fields(fields, 7, "id x y and three information values");
    G2oFile::Prior prior;
    prior.id = integer(fields[1]);
    prior.pose = {real(fields[2]), real(fields[3]), 0.0};
    const auto values = reals<3>(fields, 4);
    prior.information =
        information_of({values[0], values[1], 0.0, values[2], 0.0, 0.0}, GraphFormat::g2o);
    add_prior(prior);
  }

  void add_prior(G2oFile::Prior& prior) {
    if (!is_positive_semidefinite(prior.information)) {
      fail(
          "the information matrix has a negative eigenvalue; expected a positive semi-definite "
          "one, zero for what is not measured");
    }
    prior.start_covariance = std::exchange(pending_start_, std::nullopt);
    prior.line = file_.lines;
    file_.priors.push_back(prior);
  }

  G2oFile& file_;
  const G2oFault& fault_;
  bool drop_self_edges_;
  EdgeInformation information_;
  TagCounts landmarks_;
  std::size_t first_landmark_ = 0;  ///< line; 0: none
  G2oFile::Edge told_;              // what comments above the next edge say of it
  std::optional<Eigen::Matrix3d> pending_start_;
};

}  // namespace

G2oFile scan_g2o(const std::string& content, const G2oFault& fault, bool drop_self_edges) {
  G2oFile file;
  Scanner scanner(file, fault, drop_self_edges);
  for (const TextLine& line : lines_of(content)) scanner.read(line);
  scanner.finish();
  return file;
}

}  // namespace fathom
