// What a long survey costs as it grows: `fathom compare` on a simulated sweep of more and more
// legs, first the registrations alone, then the rest from their cache, each a process of its own.
//
//     survey_growth configs/studies/long_survey.yaml --out DIR [--svg FILE.svg]
//                   [--legs 10 32 100 316 995]
//
// Prints a table in Markdown and draws it. What has been measured lies in DIR and is not measured
// again: a program that was stopped goes on where it was, as `fathom compare` does, but costs of
// the command that was stopped are those of its end alone.

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "benchmarks/back_ends/curves.hpp"
#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "src/report/chart_legend.hpp"
#include "src/report/figure_file.hpp"

namespace fathom::benchmarks {
namespace {

namespace fs = std::filesystem;

constexpr PageSize kPage{520.0, 272.0};

struct Settings {
  std::string study;
  std::string program;
  fs::path out;
  std::string svg;
  std::vector<int> legs{10, 32, 100, 316, 995};
  int jobs = 1;
};

struct Cost {
  double cpu_s = 0.0;
  double peak_mib = 0.0;
};

struct Survey {
  double pictures = 0.0;
  double registrations = 0.0;
  Cost registering;
  Cost comparing;
  double smoother_s = 0.0;
  double smoother_mib = 0.0;
  double page_mb = 0.0;
};

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

Cost run(const std::vector<std::string>& command) {
  std::vector<char*> arguments;
  arguments.reserve(command.size() + 1);
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    execvp(arguments[0], arguments.data());
    _exit(127);
  }
  int status = 0;
  rusage used{};
  if (child < 0 || wait4(child, &status, 0, &used) != child || status != 0) {
    std::string text;
    for (const std::string& word : command) text += word + ' ';
    throw InputError(text + "failed");
  }
  return {seconds(used.ru_utime) + seconds(used.ru_stime),
          static_cast<double>(used.ru_maxrss) / 1024.0};
}

// As it was measured before, or now.
Cost cost_of(const fs::path& file, const std::vector<std::string>& command) {
  Cost cost;
  if (std::ifstream in(file); in >> cost.cpu_s >> cost.peak_mib) return cost;
  cost = run(command);
  char text[64];
  std::snprintf(text, sizeof text, "%.2f %.1f\n", cost.cpu_s, cost.peak_mib);
  write_file(file, text);
  return cost;
}

Survey measured(const Settings& settings, int legs) {
  const fs::path folder = settings.out / std::to_string(legs);
  fs::create_directories(folder);
  const auto command = [&](const std::vector<std::string>& rest) {
    std::vector<std::string> words{
        settings.program, "compare",
        settings.study,   "--quiet",
        "--jobs",         std::to_string(settings.jobs),
        "--cache",        (folder / "cache").string(),
        "--set",          "dataset.mission.legs=" + std::to_string(legs)};
    words.insert(words.end(), rest.begin(), rest.end());
    return words;
  };
  Survey survey;
  survey.registering = cost_of(folder / "registering.txt", command({"--only-registrations"}));
  const fs::path study = folder / "study";
  survey.comparing = cost_of(folder / "comparing.txt", command({"--out", study.string()}));
  const nlohmann::json run = nlohmann::json::parse(read_file(study / "metrics.json")).at(0);
  survey.pictures = run.at("keyframes").get<double>();
  survey.registrations = run.at("registrations").get<double>();
  survey.smoother_s = 1e-3 * run.at("cpu_ms").get<double>();
  survey.smoother_mib = run.at("memory_bytes").get<double>() / (1 << 20);
  survey.page_mb = 1e-6 * static_cast<double>(fs::file_size(study / "report.html"));
  return survey;
}

std::string table_of(const std::vector<Survey>& surveys) {
  std::string text =
      "| pictures | registrations | registering, s | peak, MiB | comparing, s | of it the "
      "smoother | ms a keyframe | peak, MiB | of it the smoother | page, MB |\n"
      "|---|---|---|---|---|---|---|---|---|---|\n";
  for (const Survey& s : surveys) {
    char row[256];
    std::snprintf(row, sizeof row,
                  "| %.0f | %.0f | %.0f | %.0f | %.1f | %.1f | %.2g | %.0f | %.0f | %.1f |\n",
                  s.pictures, s.registrations, s.registering.cpu_s, s.registering.peak_mib,
                  s.comparing.cpu_s, s.smoother_s, 1e3 * s.smoother_s / s.pictures,
                  s.comparing.peak_mib, s.smoother_mib, s.page_mb);
    text += row;
  }
  return text;
}

template <class Value>
Curve curve_of(const std::vector<Survey>& surveys, std::size_t place, Value value) {
  Curve curve{{}, pen_of(place)};
  for (const Survey& survey : surveys) curve.points.emplace_back(survey.pictures, value(survey));
  return curve;
}

std::string chart_of(const std::vector<Survey>& surveys) {
  const std::vector<Curve> times{
      curve_of(surveys, 0, [](const Survey& s) { return s.registering.cpu_s; }),
      curve_of(surveys, 1, [](const Survey& s) { return s.comparing.cpu_s; }),
      curve_of(surveys, 2, [](const Survey& s) { return s.smoother_s; })};
  const std::vector<Curve> peaks{
      curve_of(surveys, 0, [](const Survey& s) { return s.registering.peak_mib; }),
      curve_of(surveys, 1, [](const Survey& s) { return s.comparing.peak_mib; }),
      curve_of(surveys, 2, [](const Survey& s) { return s.smoother_mib; })};
  return render_figure(FigureFormat::svg, kPage, [&](Canvas& canvas) {
    draw_curves(canvas, times, {"pictures", ""}, {"processor time", "s"},
                {12.0, 12.0, 240.0, 216.0});
    draw_curves(canvas, peaks, {"pictures", ""}, {"peak memory", "MiB"},
                {268.0, 12.0, 240.0, 216.0});
    std::vector<LegendEntry> entries{line_entry("registering", pen_of(0)),
                                     line_entry("comparing, from the cache", pen_of(1)),
                                     line_entry("of it the smoother", pen_of(2))};
    ChartLegend(std::move(entries), kPage.width - 24.0).draw(canvas, {12.0, 238.0});
  });
}

void measure(const Settings& settings) {
  std::vector<Survey> surveys;
  for (const int legs : settings.legs) surveys.push_back(measured(settings, legs));
  std::fputs(table_of(surveys).c_str(), stdout);
  if (!settings.svg.empty()) write_file(settings.svg, chart_of(surveys));
}

}  // namespace
}  // namespace fathom::benchmarks

int main(int argc, char** argv) try {
  fathom::benchmarks::Settings settings;
  settings.program = std::filesystem::path(argv[0]).replace_filename("fathom").string();
  CLI::App app{"What `fathom compare` costs as a simulated survey grows"};
  app.add_option("study", settings.study, "its configuration")
      ->required()
      ->check(CLI::ExistingFile);
  app.add_option("--fathom", settings.program, "the program; default: that beside this one");
  app.add_option("--out", settings.out, "folder of caches, studies and costs")->required();
  app.add_option("--svg", settings.svg, "picture to draw");
  app.add_option("--legs", settings.legs, "of the surveys")->check(CLI::PositiveNumber);
  app.add_option("--jobs", settings.jobs, "of each command")->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);
  fathom::benchmarks::measure(settings);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "survey_growth: error: %s\n", error.what());
  return 1;
}
