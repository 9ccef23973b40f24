// The design's table of modules, held against every include, every link edge and every source.

#include <regex>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "architecture/checkout.hpp"
#include "architecture/include_rules.hpp"

namespace fathom::test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<std::string> sources(const std::vector<std::string>& folders) {
  return files_below(folders, R"(.*\.(hpp|cpp)(\.in)?)");
}

TEST(Architecture, EveryIncludeIsAllowedByTheDesign) {
  const auto files =
      sources({"include", "src", "estimators", "adapters", "apps", "python", "benchmarks"});
  ASSERT_GT(files.size(), 100u);
  std::size_t seen = 0;
  for (const std::string& file : files) {
    for (const Include& include : includes_of(file, content_of(file))) {
      EXPECT_THAT(complaint_about(include), IsEmpty());
      ++seen;
    }
  }
  EXPECT_GT(seen, 500u);
}

// fathom_module(NAME … PUBLIC a b PRIVATE c), fathom_estimator(NAME … SUPPORT a PRIVATE b),
// fathom_support(NAME … PUBLIC a) and target_link_libraries.
TEST(Architecture, EveryLinkIsAllowedByTheDesign) {
  const std::regex call(
      R"((fathom_module|fathom_estimator|fathom_support|target_link_libraries)\s*\(\s*(\w+)([^)]*)\))");
  std::size_t seen = 0;
  for (const std::string& file :
       files_below({"src", "estimators", "adapters", "apps", "python"}, R"(CMakeLists\.txt)")) {
    const std::string text = content_of(file);
    for (std::sregex_iterator found(text.begin(), text.end(), call), end; found != end; ++found) {
      const bool is_support = (*found)[1] == "fathom_support";
      const std::string name = (is_support ? "support_" : "") + (*found)[2].str();
      const std::string target =
          name == "fathom" ? "fathom_apps" : (name.starts_with("fathom_") ? "" : "fathom_") + name;
      std::istringstream words((*found)[3].str());
      for (std::string word; words >> word;) {
        if (name == "fathom" && word == target) continue;  // the program is its module and main
        EXPECT_THAT(complaint_about_link(target, word), IsEmpty()) << file;
        seen += word.starts_with("fathom_") ? 1 : 0;
      }
    }
  }
  EXPECT_GT(seen, 15u);
}

// A library reports by value or InputError; its numbers come from seeds it is given.
TEST(Architecture, LibrariesNeitherPrintNorExitNorRollDice) {
  const std::regex forbidden(
      R"(std::cout|std::cerr|std::clog|\b(f|v|vf)?printf\s*\(|\bputs\s*\(|\b_?exit\s*\(|\babort\s*\()"
      R"(|\bterminate\s*\(|random_device|\bs?rand\s*\(|default_random_engine)");
  for (const std::string& file : sources({"include", "src", "estimators"})) {
    if (file == "src/core/child_side.cpp") continue;  // a process that it has made itself
    std::istringstream lines(content_of(file));
    int number = 0;
    for (std::string line; std::getline(lines, line);) {
      ++number;
      const std::string code = line.substr(0, line.find("//"));
      EXPECT_FALSE(std::regex_search(code, forbidden)) << file << ":" << number << ": " << line;
    }
  }
}

// The rules themselves: a test that lets everything pass would be worth nothing.

struct Case {
  std::string file;
  std::string include;  ///< with brackets or quotes
  std::string complaint;
};

std::string judged(const Case& c) {
  const auto includes = includes_of(c.file, "\n#include " + c.include + "\n");
  return includes.size() == 1 ? complaint_about(includes.front()) : "not read as an include";
}

TEST(IncludeRules, RefuseWhatTheTableDoesNotAllow) {
  const std::vector<Case> cases{
      {"src/geometry/pose.cpp", "\"fathom/vision/camera.hpp\"", "geometry may not include vision"},
      {"include/fathom/core/text.hpp", "\"fathom/geometry/pose.hpp\"", "core may not"},
      {"src/evaluation/a.cpp", "\"fathom/estimation/gate.hpp\"", "evaluation may not include"},
      {"src/harness/a.cpp", "\"fathom/report/table.hpp\"", "harness may not include report"},
      {"src/vision/a.cpp", "\"fathom/datasets/data_set.hpp\"", "vision may not include datasets"},
      {"src/results/a.cpp", "\"fathom/harness/replay.hpp\"", "results may not include harness"},
      {"src/configuration/a.cpp", "\"fathom/results/result_store.hpp\"",
       "configuration may not include results"},
      {"src/harness/a.cpp", "<SQLiteCpp/Database.h>", "not for this folder"},
      {"src/harness/a.cpp", "<yaml-cpp/yaml.h>", "not for this folder"},
      {"src/harness/a.cpp", "\"fathom/estimators/builtin.hpp\"",
       "harness may not include estimators"},
      {"src/harness/a.cpp", "\"apps/common.hpp\"", "harness may not include apps"},
      {"src/datasets/a.cpp", "\"fathom/vision/ransac.hpp\"", "no more of vision"},
      {"src/measurements/a.cpp", "\"estimators/support/filter/a.hpp\"", "measurements may not"},
      {"src/geometry/a.cpp", "\"estimators/support/sparse/a.hpp\"", "geometry may not"},
      {"estimators/ekf/ekf.cpp", "\"fathom/vision/camera.hpp\"", "estimators may not"},
      {"estimators/ekf/ekf.cpp", "\"fathom/evaluation/accuracy.hpp\"", "estimators may not"},
      {"estimators/ekf/ekf.cpp", "\"estimators/ceres_pose_graph/graph.hpp\"", "estimator's own"},
      {"estimators/builtin.cpp.in", "\"estimators/ekf/ekf.hpp\"", "estimator's own"},
      {"estimators/incremental_smoother/a.cpp", "\"estimators/sparse_gauss_newton/drift.hpp\"",
       "estimator's own"},
      {"estimators/support/sparse/a.cpp", "\"estimators/support/pose_graph/edge.hpp\"",
       "support sparse may not include pose_graph"},
      {"estimators/support/sparse/a.cpp", "\"fathom/geometry/pose.hpp\"",
       "support sparse may not include geometry"},
      {"estimators/support/filter/a.cpp", "\"estimators/support/sparse/index.hpp\"",
       "support filter may not include sparse"},
      {"estimators/support/pose_graph/a.cpp", "\"estimators/support/filter/scratch.hpp\"",
       "support pose_graph may not include filter"},
      {"estimators/support/pose_graph/a.cpp", "\"estimators/ekf/ekf.hpp\"",
       "support pose_graph may not include estimators"},
      {"estimators/support/odds/a.cpp", "\"fathom/geometry/pose.hpp\"", "no support"},
      {"estimators/ekf/ekf.cpp", "\"estimators/support.hpp\"", "estimator's own"},
      {"adapters/g2o/a.cpp", "\"adapters/gtsam/factors.hpp\"", "another adapter's"},
      {"adapters/g2o/a.cpp", "\"fathom/harness/replay.hpp\"", "adapters may not"},
      {"apps/main.cpp", "\"estimators/support/pose_graph/edge.hpp\"", "estimator's own"},
      {"apps/main.cpp", "\"estimators/ekf/ekf.hpp\"", "estimator's own"},
      {"apps/main.cpp", "\"src/report/canvas.hpp\"", "module's own"},
      {"apps/main.cpp", "\"python/src/arrays.hpp\"", "apps may not include python"},
      {"src/harness/a.cpp", "\"benchmarks/output.hpp\"", "harness may not include benchmarks"},
      {"python/src/a.cpp", "\"estimators/ekf/ekf.hpp\"", "estimator's own"},
      {"python/src/a.cpp", "\"apps/common.hpp\"", "python may not include apps"},
      {"src/workflow/a.cpp", "\"apps/common.hpp\"", "workflow may not include apps"},
      {"src/report/a.cpp", "\"fathom/harness/replay.hpp\"", "report may not include harness"},
      {"src/report/a.cpp", "\"fathom/workflow/run.hpp\"", "report may not include workflow"},
      {"python/src/a.cpp", "\"benchmarks/output.hpp\"", "python may not include benchmarks"},
      {"python/src/a.cpp", "<opencv2/core.hpp>", "not for this folder"},
      {"benchmarks/a.cpp", "\"apps/command.hpp\"", "benchmarks may not include apps"},
      {"benchmarks/a.cpp", "\"python/src/arrays.hpp\"", "benchmarks may not include python"},
      {"benchmarks/a.cpp", "\"support/data.hpp\"", "neither ours nor private"},
      {"benchmarks/a.cpp", "<pybind11/stl.h>", "not for this folder"},
      {"src/geometry/a.cpp", "\"fathom/odds/ends.hpp\"", "of no module"},
      {"src/odds/a.cpp", "<vector>", "lies in no module"},
      {"src/geometry/a.cpp", "\"../core/secret.hpp\"", "neither ours nor private"},
      {"include/fathom/harness/a.hpp", "\"private.hpp\"", "neither ours nor private"},
      {"src/geometry/a.cpp", "<opencv2/core.hpp>", "not for this folder"},
      {"src/harness/a.cpp", "<opencv2/core.hpp>", "not for this folder"},
      {"estimators/ekf/ekf.cpp", "<ceres/problem.h>", "not for this folder"},
      {"src/datasets/simulated/world.cpp", "<yaml-cpp/yaml.h>", "not for this folder"},
      {"include/fathom/harness/a.hpp", "<nlohmann/json.hpp>", "not for this folder"},
      {"include/fathom/report/a.hpp", "<nlohmann/json.hpp>", "not for this folder"},
      {"apps/report_command.cpp", "<cairo.h>", "not for this folder"},
      {"src/report/chart_frame.cpp", "<opencv2/imgproc.hpp>", "not for this folder"},
      {"src/core/a.cpp", "<boost/any.hpp>", "of no third party"}};
  for (const Case& c : cases) {
    EXPECT_THAT(judged(c), HasSubstr(c.file + ":2: ")) << c.include;
    EXPECT_THAT(judged(c), HasSubstr(c.complaint)) << c.file;
  }
}

TEST(IncludeRules, AllowWhatTheTableAllows) {
  const std::vector<Case> cases{
      {"src/vision/a.cpp", "\"fathom/core/random.hpp\"", ""},
      {"src/vision/a.cpp", "<opencv2/core.hpp>", ""},
      {"src/datasets/image_folder/camera_yaml.cpp", "<yaml-cpp/yaml.h>", ""},
      {"src/datasets/a.cpp", "\"fathom/vision/camera.hpp\"", ""},
      {"src/harness/a.cpp", "\"build_info.hpp\"", ""},
      {"src/report/a.cpp", "\"fathom/results/result_store.hpp\"", ""},
      {"src/report/a.cpp", "<cairo-pdf.h>", ""},
      {"include/fathom/harness/a.hpp", "\"fathom/evaluation/accuracy.hpp\"", ""},
      {"adapters/gtsam/a.cpp", "\"adapters/gtsam/factors.hpp\"", ""},
      {"adapters/gtsam/a.cpp", "\"adapters/support/graph_adapter.hpp\"", ""},
      {"estimators/ekf/a.cpp", "\"estimators/ekf/ekf.hpp\"", ""},
      {"estimators/ekf/a.cpp", "\"estimators/support/filter/scratch.hpp\"", ""},
      {"estimators/support/pose_graph/a.cpp", "\"estimators/support/sparse/index.hpp\"", ""},
      {"estimators/support/pose_graph/a.cpp", "\"fathom/measurements/relative_pose.hpp\"", ""},
      {"estimators/support/pose_graph/a.cpp", "\"fathom/core/options.hpp\"", ""},
      {"estimators/support/sparse/a.cpp", "\"estimators/support/sparse/b.hpp\"", ""},
      {"estimators/ceres_pose_graph/a.cpp", "<ceres/problem.h>", ""},
      {"python/src/a.cpp", "\"fathom/workflow/run.hpp\"", ""},
      {"python/src/a.cpp", "<pybind11/numpy.h>", ""},
      {"benchmarks/a.cpp", "\"estimators/ekf/ekf.hpp\"", ""},
      {"benchmarks/a.cpp", "\"src/report/canvas.hpp\"", ""},
      {"benchmarks/a.cpp", "\"support/pairs/pairs.hpp\"", ""},
      {"benchmarks/a.cpp", "<benchmark/benchmark.h>", ""},
      {"apps/main.cpp", "\"fathom/estimators/builtin.hpp\"", ""}};
  for (const Case& c : cases) EXPECT_THAT(judged(c), IsEmpty());
}

TEST(IncludeRules, JudgeLinks) {
  EXPECT_THAT(complaint_about_link("fathom_vision", "fathom_measurements"), IsEmpty());
  EXPECT_THAT(complaint_about_link("fathom_vision", "opencv_core"), IsEmpty());
  EXPECT_THAT(complaint_about_link("fathom_estimators", "fathom_ekf"), IsEmpty());
  EXPECT_THAT(complaint_about_link("fathom_measurements", "fathom_support_sparse"), IsEmpty());
  EXPECT_THAT(complaint_about_link("fathom_incremental_smoother", "fathom_sparse_gauss_newton"),
              HasSubstr("another"));
  EXPECT_THAT(complaint_about_link("fathom_ekf", "fathom_support_filter"), IsEmpty());
  EXPECT_THAT(complaint_about_link("fathom_support_pose_graph", "fathom_support_sparse"),
              IsEmpty());
  EXPECT_THAT(complaint_about_link("fathom_support_pose_graph", "fathom_estimation"), IsEmpty());
  EXPECT_THAT(complaint_about_link("fathom_support_sparse", "fathom_support_pose_graph"),
              HasSubstr("may not link"));
  EXPECT_THAT(complaint_about_link("fathom_support_sparse", "fathom_geometry"),
              HasSubstr("may not link"));
  EXPECT_THAT(complaint_about_link("fathom_support_pose_graph", "fathom_ekf"),
              HasSubstr("may not link"));
  EXPECT_THAT(complaint_about_link("fathom_harness", "fathom_support_sparse"),
              HasSubstr("may not link"));
  EXPECT_THAT(complaint_about_link("fathom_ekf", "fathom_estimation"), IsEmpty());
  EXPECT_THAT(complaint_about_link("fathom_apps", "fathom_harness"), IsEmpty());
  EXPECT_THAT(complaint_about_link("fathom_ekf", "fathom_vision"), HasSubstr("may not link"));
  EXPECT_THAT(complaint_about_link("fathom_ekf", "fathom_ceres_pose_graph"), HasSubstr("another"));
  EXPECT_THAT(complaint_about_link("fathom_harness", "fathom_report"), HasSubstr("may not link"));
  EXPECT_THAT(complaint_about_link("fathom_geometry", "fathom_vision"), HasSubstr("may not link"));
}

TEST(IncludeRules, ReadIncludesAndNothingElse) {
  const auto includes = includes_of("src/core/a.cpp",
                                    "// #include <no>\n  #  include <a/b.h> // why\n"
                                    "#include \"c.hpp\"\nint include;\n");
  ASSERT_EQ(includes.size(), 2u);
  EXPECT_EQ(includes[0].target, "a/b.h");
  EXPECT_EQ(includes[0].line, 2);
  EXPECT_TRUE(includes[0].angled);
  EXPECT_EQ(includes[1].target, "c.hpp");
  EXPECT_FALSE(includes[1].angled);
}

}  // namespace
}  // namespace fathom::test
