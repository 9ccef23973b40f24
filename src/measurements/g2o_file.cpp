#include "g2o_file.hpp"

#include <algorithm>
#include <array>
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
  fail(std::string(fields.front()) + " takes " + what + " (" + std::to_string(count - 1) +
       " values), got " + std::to_string(fields.size() - 1));
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
    } else if (tag == "FIX") {
      if (fields.size() == 1) fail("FIX without an id");
      for (std::size_t i = 1; i < fields.size(); ++i) {
        file_.fixed.push_back({integer(fields[i]), file_.lines});
      }
    } else {
      fail("unknown tag " + in_quotes(tag) +
           "; a 2-D graph has VERTEX_SE2, EDGE_SE2, FIX, VERTEX2, EDGE2");
    }
  }

  // `# inliers N` above an edge, as to_g2o writes it; any other comment is just that.
  void read_comment(const Fields& words) {
    if (words.size() != 2 || words[0] != "inliers") return;
    const auto count = parse_integer(words[1]);
    if (count && *count >= 0 && *count < 1'000'000'000) pending_inliers_ = static_cast<int>(*count);
  }

  void read_vertex(const Fields& fields) {
    expect_fields(fields, 5, "id x y theta");
    const std::int64_t id = integer(fields[1]);
    const Pose pose = read_pose(fields, 2);
    if (!file_.vertices.emplace(id, G2oFile::Vertex{pose, file_.lines}).second) {
      fail("vertex " + std::to_string(id) + " was defined on line " +
           std::to_string(file_.vertices.at(id).line) + " already");
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
    std::array<double, 6> values{};
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = real(fields[6 + i]);
    edge.information = toro ? toro_information(values) : g2o_information(values);
    if (!is_positive_definite(edge.information)) {
      fail("the information matrix is not positive definite");
    }
    edge.inliers = std::exchange(pending_inliers_, std::nullopt);
    edge.line = file_.lines;
    file_.edges.push_back(edge);
  }

  G2oFile& file_;
  const G2oFault& fault_;
  std::optional<int> pending_inliers_;
};

}  // namespace

std::map<std::int64_t, std::size_t> G2oFile::keyframes() const {
  std::map<std::int64_t, std::size_t> keyframe_of;
  for (const auto& [id, vertex] : vertices) keyframe_of.emplace(id, 0);
  for (const Edge& edge : edges) {
    keyframe_of.emplace(edge.from, 0);
    keyframe_of.emplace(edge.to, 0);
  }
  std::size_t next = 0;
  for (auto& [id, keyframe] : keyframe_of) keyframe = next++;
  return keyframe_of;
}

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

void check_references(const G2oFile& file, const G2oFault& fault) {
  for (const G2oFile::Edge& edge : file.edges) {
    for (const std::int64_t id : {edge.from, edge.to}) {
      if (!file.vertices.empty() && !file.vertices.contains(id)) {
        fault(edge.line, "the edge refers to vertex " + std::to_string(id) +
                             ", which the file does not define");
      }
    }
  }
  if (file.fixed.empty()) return;
  const auto keyframes = file.keyframes();
  const std::int64_t lowest = keyframes.begin()->first;
  for (const G2oFile::Fixed& fixed : file.fixed) {
    if (fixed.id != lowest) {
      fault(fixed.line, "FIX " + std::to_string(fixed.id) + ": only the lowest id (" +
                            std::to_string(lowest) + ") can be fixed, and it always is");
    }
  }
}

std::optional<std::size_t> find_step(const G2oFile& file, const std::vector<std::size_t>& edges,
                                     std::size_t k, const std::vector<std::int64_t>& ids) {
  const auto joins = [&](std::int64_t from, std::int64_t to) {
    return std::find_if(edges.begin(), edges.end(), [&](std::size_t e) {
      return file.edges[e].from == from && file.edges[e].to == to;
    });
  };
  auto found = joins(ids[k - 1], ids[k]);
  if (found == edges.end()) found = joins(ids[k], ids[k - 1]);
  if (found == edges.end()) return std::nullopt;
  return *found;
}

}  // namespace fathom
