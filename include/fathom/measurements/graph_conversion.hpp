#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace fathom {

/// How a 2-D pose graph is written. Both give the pose of j in i; the information is in the order
/// xx xy xt yy yt tt in g2o, xx xy yy tt xt yt in TORO.
enum class GraphFormat {
  g2o,   ///< VERTEX_SE2, EDGE_SE2, FIX
  toro,  ///< VERTEX2, EDGE2
};

struct ConvertedGraph {
  std::string text;
  std::size_t vertices = 0;
  std::size_t edges = 0;
  /// Elements that the other format has no line for, each tag with its number of lines.
  std::vector<std::pair<std::string, std::size_t>> left_out;
  std::vector<std::pair<std::string, std::size_t>> landmarks;  ///< left out, likewise
  std::size_t self_edges = 0;                                  ///< left out
};

/// Whether a text is a pose graph and no trajectory: a line of the former opens with its tag, one
/// of the latter with a number.
bool is_graph(const std::string& content);

/// What is left out of a graph, where it would be refused.
struct ConversionOptions {
  bool drop_landmarks = false;
  bool drop_self_edges = false;
};

/// Writes a graph of either format, or of both mixed as some collections have it, in one. Numbers
/// keep their characters, lines and comments their order, so that what is converted there and back
/// is the same text but for blanks, and but for what is left out: FIX and priors in TORO. g2o keeps
/// landmarks and edges with sensor offsets as they are, TORO has no lines for them, and they are
/// refused. `name` stands for the file in messages.
/// Throws InputError with file and line on anything that read_g2o refuses in a vertex, an edge or a
/// prior that is written, on an unknown tag and on a text without vertex and edge.
ConvertedGraph convert_graph(const std::string& content, const std::string& name, GraphFormat to,
                             const ConversionOptions& options = {});

}  // namespace fathom
