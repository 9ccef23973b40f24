#include "fathom/measurements/graph_conversion.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "g2o_file.hpp"
#include "graph_landmarks.hpp"

namespace fathom {
namespace {

using Words = std::vector<std::string_view>;

constexpr std::array<std::string_view, 2> kVertex{"VERTEX_SE2", "VERTEX2"};
constexpr std::array<std::string_view, 2> kEdge{"EDGE_SE2", "EDGE2"};

// Where the information of one format stands in the other.
constexpr std::array<std::size_t, 6> kG2oFromToro{0, 1, 4, 2, 5, 3};
constexpr std::array<std::size_t, 6> kToroFromG2o{0, 1, 3, 5, 2, 4};

// Elements of g2o that TORO has no line for and that no measurement between poses goes with.
bool is_left_out(std::string_view tag, GraphFormat to) {
  return to == GraphFormat::toro && (tag == "FIX" || tag == "EDGE_PRIOR_SE2" ||
                                     tag == "EDGE_PRIOR_SE2_XY" || tag == "PARAMS_SE2OFFSET");
}

// Lines of g2o that are kept as they are, and are nothing that the reader has a check for.
bool is_kept(std::string_view tag, GraphFormat to) {
  return to == GraphFormat::g2o && (is_of_landmarks(tag) || tag == "EDGE_SE2_OFFSET");
}

bool is_self_edge(const Words& words) {
  const bool is_edge = std::find(kEdge.begin(), kEdge.end(), words.front()) != kEdge.end();
  return is_edge && words.size() == 12 && words[1] == words[2];
}

class Converter {
 public:
  Converter(GraphFormat to, const ConversionOptions& options) : to_(to), options_(options) {}

  void read(std::string_view line) {
    const std::size_t hash = std::min(line.find('#'), line.size());
    const Words words = split(line.substr(0, hash));
    const std::string_view comment = trim(line.substr(hash));
    if (!words.empty() && is_dropped(words)) {
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
  ConvertedGraph graph() && {
    graph_.left_out = left_out_.counts();
    graph_.landmarks = landmarks_.counts();
    return std::move(graph_);
  }

 private:
  // Counts what it says of.
  bool is_dropped(const Words& words) {
    const std::string_view tag = words.front();
    if (is_left_out(tag, to_)) {
      left_out_.add(tag);
    } else if (options_.drop_landmarks && is_of_landmarks(tag)) {
      landmarks_.add(tag);
    } else if (options_.drop_self_edges && is_self_edge(words)) {
      ++graph_.self_edges;
    } else {
      return false;
    }
    return true;
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
  ConversionOptions options_;
  TagCounts left_out_;
  TagCounts landmarks_;
  std::string checked_;
  ConvertedGraph graph_;
};

}  // namespace

bool is_graph(const std::string& content) {
  for (const TextLine& line : lines_of(content)) {
    const std::string_view text = trim(line.text.substr(0, line.text.find('#')));
    if (text.empty()) continue;
    const auto opens_with = [&](std::string_view tag) { return text.starts_with(tag); };
    return opens_with("VERTEX") || opens_with("EDGE") || opens_with("FIX") || opens_with("EQUIV") ||
           opens_with("PARAMS");
  }
  return false;
}

ConvertedGraph convert_graph(const std::string& content, const std::string& name, GraphFormat to,
                             const ConversionOptions& options) {
  Converter converter(to, options);
  for (const TextLine& line : all_lines_of(content)) {
    if (line.text.size() > kLongestRow) throw InputError(name, line.number, kTooLongRow);
    converter.read(line.text);
  }
  const G2oFault fault = [&name](std::size_t line, const std::string& what) {
    throw InputError(name, line, what);
  };
  const G2oFile file = scan_g2o(converter.checked(), fault);
  if (file.edges.empty() && file.vertices.empty()) {
    throw InputError(name, "holds no pose graph: no vertex and no edge");
  }
  check_references(file, fault);
  ConvertedGraph graph = std::move(converter).graph();
  graph.vertices = file.vertices.size();
  graph.edges = file.edges.size();
  return graph;
}

}  // namespace fathom
