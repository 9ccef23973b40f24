#include "fathom/measurements/g2o.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom {
namespace {

using Fields = std::vector<std::string_view>;

struct FileEdge {
  std::int64_t from = 0;
  std::int64_t to = 0;
  Pose motion;
  Eigen::Matrix3d information;
  std::optional<int> inliers;
  std::size_t line = 0;
};

struct FileVertex {
  Pose pose;
  std::size_t line = 0;
};

struct FixedVertex {
  std::int64_t id = 0;
  std::size_t line = 0;
};

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

class Reader {
 public:
  Reader(const std::string& content, const std::string& name) : content_(content), name_(name) {}

  MeasurementLog read() {
    read_lines();
    check_references();
    return build_log();
  }

 private:
  [[noreturn]] void fail(std::size_t line, const std::string& what) const {
    throw InputError(name_, line, what);
  }

  void read_lines() {
    for (std::size_t begin = 0; begin < content_.size();) {
      const std::size_t end = std::min(content_.find('\n', begin), content_.size());
      read_line(std::string_view(content_).substr(begin, end - begin), ++line_);
      begin = end + 1;
    }
    if (edges_.empty() && vertices_.empty()) {
      throw InputError(name_, "holds no pose graph: no vertex and no edge");
    }
  }

  void read_line(std::string_view line, std::size_t number) {
    const std::size_t comment = line.find('#');
    if (comment != std::string_view::npos) {
      read_comment(split(line.substr(comment + 1)));
      line = line.substr(0, comment);
    }
    const Fields fields = split(line);
    if (fields.empty()) return;
    const std::string_view tag = fields.front();
    if (tag == "VERTEX_SE2" || tag == "VERTEX2") {
      read_vertex(fields, number);
    } else if (tag == "EDGE_SE2" || tag == "EDGE2") {
      read_edge(fields, number, tag == "EDGE2");
    } else if (tag == "FIX") {
      for (std::size_t i = 1; i < fields.size(); ++i) {
        fixed_.push_back({integer(fields[i], number), number});
      }
      if (fields.size() == 1) fail(number, "FIX without an id");
    } else {
      fail(number, "unknown tag " + quoted(tag) +
                       "; a 2-D graph has VERTEX_SE2, EDGE_SE2, FIX, VERTEX2, EDGE2");
    }
  }

  // `# inliers N` above an edge, as to_g2o writes it; any other comment is just that.
  void read_comment(const Fields& words) {
    if (words.size() != 2 || words[0] != "inliers") return;
    const auto count = parse_integer(words[1]);
    if (count && *count >= 0 && *count < 1'000'000'000) pending_inliers_ = static_cast<int>(*count);
  }

  void read_vertex(const Fields& fields, std::size_t line) {
    expect_fields(fields, 5, line, "id x y theta");
    const std::int64_t id = integer(fields[1], line);
    const Pose pose = read_pose(fields, 2, line);
    if (!vertices_.emplace(id, FileVertex{pose, line}).second) {
      fail(line, "vertex " + std::to_string(id) + " was defined on line " +
                     std::to_string(vertices_.at(id).line) + " already");
    }
  }

  void read_edge(const Fields& fields, std::size_t line, bool toro) {
    expect_fields(fields, 12, line, "i j x y theta and six information values");
    FileEdge edge;
    edge.from = integer(fields[1], line);
    edge.to = integer(fields[2], line);
    if (edge.from == edge.to) {
      fail(line, "an edge from pose " + std::to_string(edge.from) + " to itself");
    }
    edge.motion = read_pose(fields, 3, line);
    std::array<double, 6> values{};
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = real(fields[6 + i], line);
    edge.information = toro ? toro_information(values) : g2o_information(values);
    if (!is_positive_definite(edge.information)) {
      fail(line, "the information matrix is not positive definite");
    }
    edge.inliers = std::exchange(pending_inliers_, std::nullopt);
    edge.line = line;
    edges_.push_back(edge);
  }

  void expect_fields(const Fields& fields, std::size_t count, std::size_t line,
                     const std::string& what) const {
    if (fields.size() == count) return;
    fail(line, std::string(fields.front()) + " takes " + what + " (" + std::to_string(count - 1) +
                   " values), got " + std::to_string(fields.size() - 1));
  }

  std::int64_t integer(std::string_view text, std::size_t line) const {
    const auto value = parse_integer(text);
    if (!value || *value < 0) fail(line, quoted(text) + " is not an id");
    return *value;
  }

  double real(std::string_view text, std::size_t line) const {
    const auto value = parse_real(text);
    if (!value) fail(line, quoted(text) + " is not a finite number");
    return *value;
  }

  Pose read_pose(const Fields& fields, std::size_t at, std::size_t line) const {
    return {real(fields[at], line), real(fields[at + 1], line),
            wrap_angle(real(fields[at + 2], line))};
  }

  // Ids in rising order become keyframes 0, 1, 2 …
  void check_references() {
    for (const auto& [id, vertex] : vertices_) keyframe_of_.emplace(id, 0);
    for (const FileEdge& edge : edges_) {
      for (const std::int64_t id : {edge.from, edge.to}) {
        if (!vertices_.empty() && !vertices_.contains(id)) {
          fail(edge.line, "the edge refers to vertex " + std::to_string(id) +
                              ", which the file does not define");
        }
        keyframe_of_.emplace(id, 0);
      }
    }
    std::size_t next = 0;
    for (auto& [id, keyframe] : keyframe_of_) keyframe = next++;
    const std::int64_t lowest = keyframe_of_.begin()->first;
    for (const FixedVertex& fixed : fixed_) {
      if (fixed.id != lowest) {
        fail(fixed.line, "FIX " + std::to_string(fixed.id) + ": only the lowest id (" +
                             std::to_string(lowest) + ") can be fixed, and it always is");
      }
    }
  }

  RelativePose measurement(const FileEdge& edge) const {
    RelativePose z;
    z.from = keyframe_of_.at(edge.from);
    z.to = keyframe_of_.at(edge.to);
    z.motion = edge.motion;
    z.information = edge.information;
    z.inliers = edge.inliers;
    return z;
  }

  MeasurementLog build_log() const {
    const std::size_t count = keyframe_of_.size();
    // Per keyframe, the indices of its edges in file order; its step is one of them.
    std::vector<std::vector<std::size_t>> arrivals(count);
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      arrivals[measurement(edges_[e]).newest()].push_back(e);
    }
    MeasurementLog log(vertices_.empty() ? Pose{} : vertices_.begin()->second.pose);
    for (const auto& [id, keyframe] : keyframe_of_) log.ids.push_back(id);
    for (std::size_t k = 1; k < count; ++k) {
      const std::size_t step = find_step(arrivals[k], k, log.ids);
      log.add_keyframe(measurement(edges_[step]));
      for (const std::size_t e : arrivals[k]) {
        if (e != step) log.add_registration(measurement(edges_[e]));
      }
    }
    if (!vertices_.empty()) {
      log.guess.emplace();
      for (const auto& [id, vertex] : vertices_) log.guess->push_back(vertex.pose);
    }
    return log;
  }

  std::size_t find_step(const std::vector<std::size_t>& arrivals, std::size_t k,
                        const std::vector<std::int64_t>& ids) const {
    const auto joins = [&](std::int64_t from, std::int64_t to) {
      return std::find_if(arrivals.begin(), arrivals.end(), [&](std::size_t e) {
        return edges_[e].from == from && edges_[e].to == to;
      });
    };
    auto found = joins(ids[k - 1], ids[k]);
    if (found == arrivals.end()) found = joins(ids[k], ids[k - 1]);
    if (found != arrivals.end()) return *found;
    const auto vertex = vertices_.find(ids[k]);
    const std::size_t line = vertex != vertices_.end() ? vertex->second.line
                             : arrivals.empty()        ? line_
                                                       : edges_[arrivals.front()].line;
    fail(line, "pose " + std::to_string(ids[k]) + " has no odometry edge from pose " +
                   std::to_string(ids[k - 1]) + ", the one before it");
  }

  const std::string& content_;
  const std::string& name_;
  std::size_t line_ = 0;
  std::map<std::int64_t, FileVertex> vertices_;
  std::vector<FileEdge> edges_;
  std::vector<FixedVertex> fixed_;
  std::optional<int> pending_inliers_;
  std::map<std::int64_t, std::size_t> keyframe_of_;
};

std::string vertex_line(std::int64_t id, const Pose& pose) {
  return "VERTEX_SE2 " + std::to_string(id) + ' ' + exact(pose.x) + ' ' + exact(pose.y) + ' ' +
         exact(pose.theta) + '\n';
}

std::string edge_line(const RelativePose& z, const std::vector<std::int64_t>& ids) {
  std::string line;
  if (z.inliers) line += "# inliers " + std::to_string(*z.inliers) + '\n';
  line += "EDGE_SE2 " + std::to_string(ids[z.from]) + ' ' + std::to_string(ids[z.to]) + ' ' +
          exact(z.motion.x) + ' ' + exact(z.motion.y) + ' ' + exact(z.motion.theta);
  for (int row = 0; row < 3; ++row) {
    for (int column = row; column < 3; ++column) line += ' ' + exact(z.information(row, column));
  }
  return line + '\n';
}

}  // namespace

MeasurementLog read_g2o(const std::filesystem::path& path) {
  return parse_g2o(read_file(path), path.string());
}

MeasurementLog parse_g2o(const std::string& content, const std::string& name) {
  return Reader(content, name).read();
}

std::string to_g2o(const MeasurementLog& log) {
  std::vector<std::int64_t> ids = log.ids;
  for (std::size_t k = ids.size(); k < log.size(); ++k) ids.push_back(static_cast<std::int64_t>(k));
  const std::vector<Pose> poses = log.odometry();
  std::string text = vertex_line(ids[0], poses[0]) + "FIX " + std::to_string(ids[0]) + '\n';
  for (std::size_t k = 1; k < log.size(); ++k) {
    const KeyframeMeasurements& arrival = log.arrival(k);
    text += vertex_line(ids[k], poses[k]) + edge_line(arrival.step, ids);
    for (const RelativePose& z : arrival.registrations) text += edge_line(z, ids);
  }
  return text;
}

}  // namespace fathom
