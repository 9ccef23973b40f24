// fathom conformance: which clauses of the contract an estimator breaks, and how.

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "apps/command.hpp"
#include "apps/common.hpp"
#include "apps/output.hpp"
#include "fathom/configuration/isolation.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "fathom/harness/conformance.hpp"
#include "fathom/report/table.hpp"

namespace fathom {
namespace {

struct ConformanceFlags {
  std::vector<std::string> names;
  std::vector<std::string> plugins;
  bool list = false;
};

// Without names: all, or what plug-ins that are named bring.
bool is_asked_for(const EstimatorEntry& entry, const std::vector<std::string>& plugins) {
  if (plugins.empty()) return !entry.runs_program;
  return std::ranges::any_of(plugins, [&](const std::string& file) {
    return !entry.is_built_in() && std::filesystem::equivalent(entry.plugin, file);
  });
}

// An unknown name is refused before any of the others takes its time.
std::vector<EstimatorEntry> chosen(const ConformanceFlags& flags,
                                   const EstimatorRegistry& registry) {
  std::vector<EstimatorEntry> entries;
  if (flags.names.empty()) {
    std::ranges::copy_if(
        registry.entries(), std::back_inserter(entries),
        [&](const EstimatorEntry& entry) { return is_asked_for(entry, flags.plugins); });
  }
  for (const std::string& name : flags.names) {
    entries.push_back(registry.find(name));
    if (!entries.back().runs_program) continue;
    throw InputError("'" + name + "': what it does is another program's, which its options name");
  }
  return entries;
}

void print_clauses() {
  Table table({"clause", "rule"});
  for (const ConformanceClause& clause : conformance_clauses()) {
    table.add_row({clause.name, clause.rule});
  }
  print("%s", table.text().c_str());
}

// "2 do not apply: no batch mode"; empty where all do.
std::string without_application(std::size_t count, const std::vector<std::string>& reasons) {
  if (count == 0) return "";
  return fmt::format(", {} {} not apply: {}", count, count == 1 ? "does" : "do",
                     joined(reasons, ", "));
}

// What others wrote may take its process with it.
ConformanceVerdict verdict_on(const EstimatorEntry& entry, const std::string& clause) {
  constexpr double kTimeLimit_s = 60.0;
  const IsolationOptions isolation;
  if (!isolation.is_isolated(entry)) return conformance_of(entry, clause);
  return isolated_conformance_of(entry, clause,
                                 {kTimeLimit_s, std::int64_t{isolation.memory_limit_mib} << 20});
}

/// Whether every clause is kept.
bool conforms(const EstimatorEntry& entry) {
  std::size_t kept = 0;
  std::size_t applicable = 0;
  std::vector<std::string> reasons;
  for (const ConformanceClause& clause : conformance_clauses()) {
    const ConformanceVerdict verdict = verdict_on(entry, clause.name);
    if (verdict.conformity == Conformity::not_applicable) {
      const bool is_new = std::find(reasons.begin(), reasons.end(), verdict.how) == reasons.end();
      if (is_new) reasons.push_back(verdict.how);
      continue;
    }
    ++applicable;
    if (verdict.conformity == Conformity::kept) {
      ++kept;
      continue;
    }
    print("%s: breaks %s: %s\n    rule: %s\n", entry.name.c_str(), clause.name.c_str(),
          verdict.how.c_str(), clause.rule.c_str());
    std::fflush(stdout);
  }
  const std::size_t not_applicable = conformance_clauses().size() - applicable;
  print("%s: keeps %zu of %zu clauses%s\n", entry.name.c_str(), kept, applicable,
        without_application(not_applicable, reasons).c_str());
  std::fflush(stdout);
  return kept == applicable;
}

void judge(const ConformanceFlags& flags, Context& context) {
  context.status = kDone;
  if (flags.list) {
    print_clauses();
    return;
  }
  for (const std::string& file : flags.plugins) context.estimators().load(file);
  for (const EstimatorEntry& entry : chosen(flags, context.estimators().registry())) {
    if (!conforms(entry)) context.status = kFailed;
  }
}

}  // namespace

void add_conformance(CLI::App& program, Context& context) {
  auto flags = std::make_shared<ConformanceFlags>();
  Command command(program, "conformance",
                  "Hold estimators against the contract that all of them must keep",
                  "Exit status: 0 every clause that applies is kept, 1 one is broken.\n"
                  "Example: fathom conformance ekf\n"
                  "         fathom conformance --plugin mine.so my_filter");
  const Flag names = command.optional_arguments("estimator", flags->names,
                                                "Estimators; none: those of --plugin, or all");
  add_plugins_to(command, flags->plugins);
  command.boolean("--list", flags->list, "The clauses and their rules").excludes(names);
  command.quiet();
  command.on_run([flags, &context] { judge(*flags, context); });
}

}  // namespace fathom
