// The entry `g2o`: a pose graph, straight to the estimators.

#include <memory>

#include "fathom/datasets/data_set.hpp"
#include "fathom/measurements/g2o.hpp"
#include "fathom/measurements/graph_numbers.hpp"

namespace fathom {
namespace {

struct G2oOptions {
  std::string path;
  GraphOptions graph;

  void describe(OptionTable& table) {
    table.text("path", path, "the g2o file; relative to the working folder");
    graph.describe(table);
  }
};

class G2oDataSet : public DataSet {
 public:
  explicit G2oDataSet(const G2oOptions& options)
      : path_(options.path), log_(read_g2o(path_, options.graph)) {}

  const MeasurementLog* graph() const override { return &log_; }
  std::vector<std::filesystem::path> files() const override { return {path_}; }
  std::vector<std::string> remarks() const override { return graph_remarks(log_); }

 private:
  std::filesystem::path path_;
  MeasurementLog log_;
};

}  // namespace

DataSetEntry g2o_data_set() {
  DataSetEntry entry =
      make_data_set<G2oOptions>("g2o", "a pose graph, straight to the estimators",
                                [](const G2oOptions& options, std::uint64_t /*seed*/) {
                                  if (options.path.empty())
                                    throw InputError("dataset.path: say where the g2o file is");
                                  return std::make_unique<G2oDataSet>(options);
                                });
  entry.is_graph = true;
  return entry;
}

}  // namespace fathom
