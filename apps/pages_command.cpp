// fathom pages: man pages and completion, from the descriptions that --help prints.

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <memory>

#include "apps/command.hpp"
#include "apps/completion.hpp"
#include "apps/man_pages.hpp"
#include "fathom/core/files.hpp"
#include "fathom/evaluation/metrics.hpp"
#include "fathom/evaluation/spatial_alignment.hpp"
#include "fathom/geometry/plane.hpp"
#include "fathom/geometry/trajectory_file.hpp"

namespace fathom {
namespace {

template <typename Value>
std::vector<std::string> names_in(const std::vector<std::pair<std::string, Value>>& named) {
  std::vector<std::string> names;
  names.reserve(named.size());
  for (const auto& [name, value] : named) names.push_back(name);
  return names;
}

WordsOfValues known_words(const EstimatorRegistry& registry) {
  WordsOfValues words;
  for (const EstimatorEntry& entry : registry.entries()) {
    words["ESTIMATOR"].push_back(entry.name);
    words["estimator"].push_back(entry.name);
  }
  // rpe_D_m_m stands for many: a metric for each distance.
  const auto is_pattern = [](const std::string& name) {
    return std::ranges::any_of(name,
                               [](unsigned char letter) { return std::isupper(letter) != 0; });
  };
  for (const Metric& metric : metric_catalogue()) {
    if (!is_pattern(metric.name)) words["METRIC"].push_back(metric.name);
  }
  words["PLANE"] = names_in(plane_names());
  words["FORMAT"] = names_in(trajectory_format_names());
  words["ALIGNMENT"] = names_in(spatial_alignment_names());
  return words;
}

void write_pages(const CLI::App& program, const EstimatorRegistry& registry,
                 const std::filesystem::path& out) {
  const DescribedCommand whole = described(program);
  const std::vector<DescribedCommand> commands = described_commands(program);
  std::filesystem::create_directories(out / "man1");
  write_file(out / "man1/fathom.1", program_page(whole, commands));
  for (const DescribedCommand& command : commands) {
    write_file(out / "man1" / ("fathom-" + command.name + ".1"), command_page(command));
  }
  write_file(out / "fathom.bash", bash_completion(whole, commands, known_words(registry)));
}

}  // namespace

void add_pages(CLI::App& program, Context& context) {
  auto out = std::make_shared<std::string>();
  Command command(program, "pages", "Write the man pages and the completion for bash",
                  "Example: fathom pages --out pages\n"
                  "Writes man1/fathom.1, man1/fathom-COMMAND.1 and fathom.bash.");
  command.hidden();
  command.text("--out", *out, "DIR", "Output folder").required();
  command.on_run([&program, out, &context] {
    write_pages(program, context.estimators().registry(), *out);
    context.status = kDone;
  });
}

}  // namespace fathom
