#include "fathom/measurements/graph_conversion.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "g2o_file.hpp"

namespace fathom {
namespace {

using Words = std::vector<std::string_view>;

constexpr std::array<std::string_view, 2> kVertex{"VERTEX_SE2", "VERTEX2"};
constexpr std::array<std::string_view, 2> kEdge{"EDGE_SE2", "EDGE2"};

// Where the information of one format stands in the other.
constexpr std::array<std::size_t, 6> kG2oFromToro{0, 1, 4, 2, 5, 3};
constexpr std::array<std::size_t, 6> kToroFromG2o{0, 1, 3, 5, 2, 4};

bool is_one_of(std::string_view tag, const std::vector<std::string_view>& tags) {
  return std::find(tags.begin(), tags.end(), tag) != tags.end();
}

// Elements of 2-D graphs that the format has no line for.
bool is_left_out(std::string_view tag, GraphFormat to) {
  static const std::vector<std::string_view> not_in_toro{
      "FIX",         "EDGE_PRIOR_SE2",      "EDGE_PRIOR_SE2_XY", "VERTEX_XY",
      "EDGE_SE2_XY", "EDGE_BEARING_SE2_XY", "EDGE_SE2_OFFSET",   "EDGE_SE2_XY_OFFSET",
      "EDGE_XY_XY",  "PARAMS_SE2OFFSET"};
  return to == GraphFormat::toro ? is_one_of(tag, not_in_toro) : tag == "EQUIV";
}

// Lines of g2o that are kept as they are, and are nothing that the reader has a check for.
bool is_kept(std::string_view tag, GraphFormat to) {
  return to == GraphFormat::g2o && is_left_out(tag, GraphFormat::toro) &&
         !tag.starts_with("EDGE_PRIOR_SE2");
}

class Converter {
 public:
  explicit Converter(GraphFormat to) : to_(to) {}

  void read(std::string_view line) {
    const std::size_t hash = std::min(line.find('#'), line.size());
    const Words words = split(line.substr(0, hash));
    const std::string_view comment = trim(line.substr(hash));
    if (!words.empty() && is_left_out(words.front(), to_)) {
      count(words.front());
      checked_ += '\n';
      if (!comment.empty()) add({}, comment);
      return;
    }
    const bool is_other = !words.empty() && is_kept(words.front(), to_);
    if (!is_other) checked_ += line;
    checked_ += '\n';
    add(converted(words), comment);
  }

  /// The lines that must be a vertex, an edge or a prior, in their place.
  const std::string& checked() const { return checked_; }
  ConvertedGraph& graph() { return graph_; }

 private:
  void count(std::string_view tag) {
    auto& left_out = graph_.left_out;
    const auto is_tag = [&](const auto& entry) { return entry.first == tag; };
    const auto found = std::find_if(left_out.begin(), left_out.end(), is_tag);
    if (found == left_out.end()) {
      left_out.emplace_back(tag, 1);
    } else {
      ++found->second;
    }
  }

  Words converted(Words words) const {
    if (words.empty()) return words;
    const auto own = static_cast<std::size_t>(to_);
    const auto other = 1 - own;
    if (words.front() == kVertex[other]) words.front() = kVertex[own];
    if (words.front() != kEdge[other] || words.size() != 12) return words;
    Words edge = words;
    edge.front() = kEdge[own];
    const auto& order = to_ == GraphFormat::g2o ? kG2oFromToro : kToroFromG2o;
    for (std::size_t i = 0; i < order.size(); ++i) edge[6 + i] = words[6 + order[i]];
    return edge;
  }

  void add(const Words& words, std::string_view comment) {
    std::string line;
    for (const std::string_view word : words) line += (line.empty() ? "" : " ") + std::string(word);
    if (!comment.empty()) line += (line.empty() ? "" : " ") + std::string(comment);
    graph_.text += line + '\n';
  }

  GraphFormat to_;
  std::string checked_;
  ConvertedGraph graph_;
};

}  // namespace

ConvertedGraph convert_graph(const std::string& content, const std::string& name, GraphFormat to) {
  Converter converter(to);
  for (std::size_t begin = 0; begin < content.size();) {
    const std::size_t end = std::min(content.find('\n', begin), content.size());
    converter.read(std::string_view(content).substr(begin, end - begin));
    begin = end + 1;
  }
  const G2oFault fault = [&name](std::size_t line, const std::string& what) {
    throw InputError(name, line, what);
  };
  const G2oFile file = scan_g2o(converter.checked(), fault);
  if (file.edges.empty() && file.vertices.empty()) {
    throw InputError(name, "holds no pose graph: no vertex and no edge");
  }
  check_references(file, fault);
  ConvertedGraph graph = std::move(converter.graph());
  graph.vertices = file.vertices.size();
  graph.edges = file.edges.size();
  return graph;
}

}  // namespace fathom
