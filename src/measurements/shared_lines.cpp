#include "shared_lines.hpp"

#include <array>
#include <cstdint>
#include <deque>
#include <fmt/format.h>
#include <map>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>

#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom {
namespace {

// The total covariance stands in the graph with 17 digits; products of the parts lose some.
constexpr double kSameTotal = 1e-6;

using Fields = std::vector<std::string_view>;

template <std::size_t Count>
using Numbers = std::array<double, Count>;

class SharedScanner {
 public:
  SharedScanner(G2oFile& graph, const std::string& graph_name, const G2oFault& fault)
      : graph_(graph), graph_name_(graph_name), fault_(fault) {
    for (std::size_t e = 0; e < graph.edges.size(); ++e) {
      const G2oFile::Edge& edge = graph.edges[e];
      edges_[key_of(edge.from, edge.to, edge.motion)].push_back(e);
    }
  }

  void read(const std::string& content) {
    for_lines(content, [&](const Fields& fields) {
      if (fields[0] == "PICTURE") {
        read_picture(fields);
      } else if (fields[0] != "REGISTRATION") {
        fail("unknown tag " + in_quotes(fields[0]) + "; expected PICTURE or REGISTRATION");
      }
    });
    for_lines(content, [&](const Fields& fields) {
      if (fields[0] == "REGISTRATION") read_registration(fields);
    });
    for (const auto& [id, picture] : pictures_) {
      if (used_.contains(id)) continue;
      line_ = picture.line;
      fail(
          fmt::format("standard deviations of picture {}, but no registration of it; expected a "
                      "REGISTRATION line with it, or none here",
                      id));
    }
  }

 private:
  struct Picture {
    Eigen::Vector3d sigma;
    std::size_t line = 0;
  };
  using EdgeKey = std::tuple<std::int64_t, std::int64_t, double, double, double>;

  static EdgeKey key_of(std::int64_t from, std::int64_t to, const Pose& motion) {
    return {from, to, motion.x, motion.y, motion.theta};
  }

  template <class Use>
  void for_lines(const std::string& content, const Use& use) {
    for (const auto& [number, text] : lines_of(content)) {
      line_ = number;
      if (text.size() > kLongestRow) fail(kTooLongRow);
      const Fields fields = split(text.substr(0, text.find('#')));
      if (!fields.empty()) use(fields);
    }
  }

  // Throws, as all faults here end the reading.
  [[noreturn]] void fail(const std::string& what) const {
    fault_(line_, what);
    throw InputError(what);
  }

  std::int64_t id_of(std::string_view text) const {
    const auto value = parse_integer(text);
    if (!value || *value < 0) fail(in_quotes(text) + " is not an id");
    return *value;
  }

  template <std::size_t Count>
  Numbers<Count> numbers(const Fields& fields, std::size_t at) const {
    Numbers<Count> values{};
    for (std::size_t i = 0; i < Count; ++i) {
      const auto value = parse_real(fields[at + i]);
      if (!value) fail(in_quotes(fields[at + i]) + " is not a finite number");
      values[i] = *value;
    }
    return values;
  }

  void expect(const Fields& fields, std::size_t count, const char* what) const {
    if (fields.size() == count) return;
    fail(fmt::format("{} takes {} ({} values), got {}", fields[0], what, count - 1,
                     fields.size() - 1));
  }

  void read_picture(const Fields& fields) {
    expect(fields, 5, "an id and three standard deviations");
    const std::int64_t id = id_of(fields[1]);
    const Numbers<3> sigma = numbers<3>(fields, 2);
    for (const double value : sigma) {
      if (value < 0.0) fail(fmt::format("a standard deviation of {}; expected 0 or more", value));
    }
    if (!pictures_.emplace(id, Picture{Eigen::Vector3d(sigma.data()), line_}).second) {
      fail(fmt::format("picture {} stands on line {} already", id, pictures_.at(id).line));
    }
  }

  void read_registration(const Fields& fields) {
    expect(fields, 30, "two ids, x y theta, two 3 × 3 responses and six values of a covariance");
    const std::int64_t from = id_of(fields[1]);
    const std::int64_t to = id_of(fields[2]);
    const Numbers<3> z = numbers<3>(fields, 3);
    SharedErrors shared;
    shared.from = {matrix(numbers<9>(fields, 6)), sigma_of(from)};
    shared.to = {matrix(numbers<9>(fields, 15)), sigma_of(to)};
    const Numbers<6> own = numbers<6>(fields, 24);
    shared.own << own[0], own[1], own[2], own[1], own[3], own[4], own[2], own[4], own[5];
    if (!is_positive_definite(shared.own)) {
      fail("the registration's own covariance is not positive definite");
    }
    G2oFile::Edge& edge = edge_of(from, to, {z[0], z[1], wrap_angle(z[2])});
    check_total(shared, edge);
    edge.shared = std::make_shared<const SharedErrors>(shared);
  }

  static Eigen::Matrix3d matrix(const Numbers<9>& by_rows) {
    return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(by_rows.data());
  }

  Eigen::Vector3d sigma_of(std::int64_t id) {
    const auto picture = pictures_.find(id);
    if (picture == pictures_.end()) {
      fail(
          fmt::format("responses to errors of picture {} without their standard deviations; "
                      "expected a line PICTURE {} and three values",
                      id, id));
    }
    used_.insert(id);
    return picture->second.sigma;
  }

  G2oFile::Edge& edge_of(std::int64_t from, std::int64_t to, const Pose& motion) {
    const auto entry = edges_.find(key_of(from, to, motion));
    if (entry != edges_.end() && !entry->second.empty()) {
      G2oFile::Edge& edge = graph_.edges[entry->second.front()];
      entry->second.pop_front();
      return edge;
    }
    fail(
        fmt::format("no edge {} {} with this motion in {}: a file of another log; expected the one "
                    "that was written with it, or none",
                    from, to, graph_name_));
  }

  void check_total(const SharedErrors& shared, const G2oFile::Edge& edge) const {
    const Eigen::Matrix3d R = planar_rotation(edge.motion.theta);
    const Eigen::Matrix3d root = edge.information.llt().matrixL();
    const Eigen::Matrix3d unit = root.transpose() * (R.transpose() * shared.total() * R) * root;
    if ((unit - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() <= kSameTotal) return;
    fail(
        fmt::format("the parts do not add up to the covariance of edge {} {} in {}: a file of "
                    "another log; expected the one that was written with it, or none",
                    edge.from, edge.to, graph_name_));
  }

  G2oFile& graph_;
  const std::string& graph_name_;
  const G2oFault& fault_;
  /// Those that no line has named, in file order.
  std::map<EdgeKey, std::deque<std::size_t>> edges_;
  std::map<std::int64_t, Picture> pictures_;
  std::set<std::int64_t> used_;
  std::size_t line_ = 0;
};

}  // namespace

void read_shared(const std::string& content, G2oFile& graph, const std::string& graph_name,
                 const G2oFault& fault) {
  SharedScanner(graph, graph_name, fault).read(content);
}

}  // namespace fathom
