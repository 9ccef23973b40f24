// A file with a pose graph, faults included, and what `fathom check` says of it; what follows a
// line `====` is the file of shared errors beside it.
#include "fathom/measurements/graph_check.hpp"
#include "fathom/measurements/shared_file.hpp"
#include "support/fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fathom;
  static const fuzz::Folder folder("graph");
  constexpr std::string_view kBorder = "\n====\n";
  const std::string_view text = fuzz::text_of(data, size);
  const std::size_t border = text.find(kBorder);
  const std::filesystem::path graph = folder.write("graph.g2o", text.substr(0, border));
  const std::filesystem::path shared = shared_file_of(graph);
  std::filesystem::remove(shared);
  if (border != std::string_view::npos) {
    folder.write(shared.filename(), text.substr(border + kBorder.size()));
  }
  fuzz::is_taken([&] { summarise_graph(graph); });
  fuzz::is_taken([&] { read_g2o(graph); });
  return 0;
}
