// fathom list: what there is to choose from, with every option.

#include <memory>

#include "apps/command.hpp"
#include "apps/output.hpp"
#include "fathom/configuration/configuration.hpp"
#include "fathom/core/features.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/evaluation/metrics.hpp"
#include "fathom/report/table.hpp"

namespace fathom {
namespace {

void print_options(const std::string& prefix, const std::vector<OptionDescription>& options) {
  if (options.empty()) return;
  Table table({"  key", "default", "unit", "allowed", "meaning"});
  for (const OptionDescription& option : options) {
    const std::string allowed = option.range.empty() ? option.type : option.range;
    table.add_row(
        {"  " + prefix + option.key, option.default_value, option.unit, allowed, option.help});
  }
  print("%s\n", table.text().c_str());
}

void print_heading(const std::string& name, const std::string& help) {
  print("%s: %s\n", name.c_str(), help.c_str());
}

void print_metrics() {
  Table table({"metric", "unit", "better", "cost", "meaning"});
  for (const Metric& metric : metric_catalogue()) {
    const char* better = metric.better == Better::lower    ? "lower"
                         : metric.better == Better::higher ? "higher"
                                                           : "";
    table.add_row(
        {metric.name, metric.unit, better, metric.is_cost ? "yes" : "", metric.description});
  }
  print("%s", table.text().c_str());
}

void print_features() {
  Table table({"feature", "built", "gives", "packages", "installed and built by"});
  for (const Feature& feature : features()) {
    table.add_row({std::string(feature.name), feature.is_built ? "yes" : "no",
                   std::string(feature.gives), std::string(feature.packages),
                   feature.is_built ? "" : remedy_for(feature)});
  }
  print("%s", table.text().c_str());
}

void list(const std::string& what, Context& context) {
  context.status = kDone;
  if (what == "estimators") {
    for (const EstimatorEntry& entry : context.estimators().registry().entries()) {
      const std::string by =
          entry.is_built_in() ? "" : " (plug-in " + entry.plugin.filename().string() + ")";
      print_heading(entry.name, entry.help + by);
      print_options("estimator.", entry.options);
    }
  } else if (what == "detectors") {
    for (const DetectorEntry& entry : detectors()) print_heading(entry.name, entry.help);
    print("\n");
    FrontEndOptions front_end;
    OptionTable table;
    front_end.describe(table);
    print_options("front_end.", table.descriptions());
  } else if (what == "metrics") {
    print_metrics();
  } else if (what == "features") {
    print_features();
  } else {
    for (const DataSetEntry& entry : data_sets()) {
      print_heading(entry.name, entry.help);
      print_options("dataset.", entry.options);
    }
    EarthOriginOptions origin;
    OptionTable table;
    table.group("origin", origin);
    print_heading("origin", "where a survey of pictures starts on Earth, of whatever type");
    print_options("dataset.", table.descriptions());
  }
}

}  // namespace

void add_list(CLI::App& program, Context& context) {
  auto what = std::make_shared<std::string>();
  auto plugins = std::make_shared<std::vector<std::string>>();
  Command command(program, "list",
                  "List estimators, detectors or datasets with their options, metrics, or features",
                  "Example: fathom list estimators\n"
                  "         fathom list estimators --plugin mine.so");
  command.argument("what", *what, {"estimators", "detectors", "datasets", "metrics", "features"},
                   "what of this build");
  add_plugins_to(command, *plugins);
  command.quiet();
  command.on_run([what, plugins, &context] {
    for (const std::string& file : *plugins) context.estimators().load(file);
    list(*what, context);
  });
}

}  // namespace fathom
