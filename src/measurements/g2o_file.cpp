#include "g2o_file.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <string_view>
#include <utility>

#include "fathom/core/text.hpp"
#include "fathom/geometry/covariance.hpp"

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

/// The upper triangle by rows, as g2o writes it.
Eigen::Matrix3d g2o_information(const std::array<double, 6>& v) {
  Eigen::Matrix3d information;
  information << v[0], v[1], v[2], v[1], v[3], v[4], v[2], v[4], v[5];
  return information;
}

/// TORO's order: xx xy yy tt xt yt.
Eigen::Matrix3d toro_information(const std::array<double, 6>& v) {
  return g2o_information({v[0], v[1], v[4], v[2], v[5], v[3]});
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
    hole.information = g2o_information(reals<6>(words, 6));
    return is_positive_definite(hole.information) ? std::optional(hole) : std::nullopt;
  } catch (const LineFault&) {
    return std::nullopt;
  }
}

// `# start` and six values of a covariance, above the prior that is the log's start.
std::optional<Eigen::Matrix3d> start_covariance_of(const Fields& words) {
  if (words.size() != 7) return std::nullopt;
  try {
    const Eigen::Matrix3d covariance = g2o_information(reals<6>(words, 1));
    return is_positive_definite(covariance) ? std::optional(covariance) : std::nullopt;
  } catch (const LineFault&) {
    return std::nullopt;
  }
}

class Scanner {
 public:
  Scanner(G2oFile& file, const G2oFault& fault) : file_(file), fault_(fault) {}

  void read(std::string_view line) {
    ++file_.lines;
    try {
      read_line(line);
    } catch (const LineFault& fault) {
      fault_(file_.lines, fault.what);
    }
  }

 private:
  void read_line(std::string_view line) {
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
      read_edge(fields, tag == "EDGE2");
    } else if (tag == "EDGE_PRIOR_SE2") {
      read_prior(fields);
    } else if (tag == "EDGE_PRIOR_SE2_XY") {
      read_position_prior(fields);
    } else if (tag == "FIX") {
      if (fields.size() == 1) fail("FIX without an id");
      for (std::size_t i = 1; i < fields.size(); ++i) {
        file_.fixed.push_back({integer(fields[i]), file_.lines});
      }
    } else {
      fail("unknown tag " + in_quotes(tag) +
           "; a 2-D graph has VERTEX_SE2, EDGE_SE2, FIX, EDGE_PRIOR_SE2, EDGE_PRIOR_SE2_XY, "
           "VERTEX2, EDGE2");
    }
  }

  // What to_g2o writes in comments; any other comment is just that.
  void read_comment(const Fields& words) {
    if (words.empty()) return;
    if (words[0] == "inliers" && words.size() == 2) {
      const auto count = parse_integer(words[1]);
      const bool is_count = count && *count >= 0 && *count < 1'000'000'000;
      if (is_count) pending_inliers_ = static_cast<int>(*count);
    } else if (words[0] == "hole") {
      if (const auto hole = hole_of(words)) file_.holes.push_back(*hole);
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

  void read_edge(const Fields& fields, bool toro) {
    expect_fields(fields, 12, "i j x y theta and six information values");
    G2oFile::Edge edge;
    edge.from = integer(fields[1]);
    edge.to = integer(fields[2]);
    if (edge.from == edge.to) {
      fail("an edge from pose " + std::to_string(edge.from) + " to itself");
    }
    edge.motion = read_pose(fields, 3);
    const auto values = reals<6>(fields, 6);
    edge.information = toro ? toro_information(values) : g2o_information(values);
    if (!is_positive_definite(edge.information)) {
      fail("the information matrix is not positive definite");
    }
    edge.inliers = std::exchange(pending_inliers_, std::nullopt);
    edge.line = file_.lines;
    file_.edges.push_back(edge);
  }

  void read_prior(const Fields& fields) {
    expect_fields(fields, 11, "id x y theta and six information values");
    G2oFile::Prior prior;
    prior.id = integer(fields[1]);
    prior.pose = read_pose(fields, 2);
    prior.information = g2o_information(reals<6>(fields, 5));
    add_prior(prior);
  }

  void read_position_prior(const Fields& fields) {
    expect_fields(fields, 7, "id x y and three information values");
    G2oFile::Prior prior;
    prior.id = integer(fields[1]);
    prior.pose = {real(fields[2]), real(fields[3]), 0.0};
    const auto values = reals<3>(fields, 4);
    prior.information = g2o_information({values[0], values[1], 0.0, values[2], 0.0, 0.0});
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
  std::optional<int> pending_inliers_;
  std::optional<Eigen::Matrix3d> pending_start_;
};

}  // namespace

G2oFile scan_g2o(const std::string& content, const G2oFault& fault) {
  G2oFile file;
  Scanner scanner(file, fault);
  for (std::size_t begin = 0; begin < content.size();) {
    const std::size_t end = std::min(content.find('\n', begin), content.size());
    scanner.read(std::string_view(content).substr(begin, end - begin));
    begin = end + 1;
  }
  return file;
}

}  // namespace fathom
