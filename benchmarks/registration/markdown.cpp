#include <cmath>
#include <cstdarg>
#include <cstdio>

#include "fathom/evaluation/proportion.hpp"
#include "output.hpp"

namespace fathom::benchmarks {
namespace {

[[gnu::format(printf, 1, 2)]] std::string text(const char* format, ...) {
  char buffer[256];
  std::va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(buffer, sizeof buffer, format, arguments);
  va_end(arguments);
  return buffer;
}

std::string share_text(const Share& share) {
  const Interval interval = wilson_interval(share.successes, share.count);
  return text("%zu/%zu (%.2f–%.2f)", share.successes, share.count, interval.low, interval.high);
}

std::string nis_text(const std::optional<NisSummary>& nis) {
  if (!nis) return "– | –";
  return text("%.2f (%.2f–%.2f) | %.0f %%", nis->mean, nis->expected.low, nis->expected.high,
              100.0 * nis->share_beyond_95);
}

std::string error_text(const MedianAnd95& error, double scale, int digits) {
  if (std::isnan(error.median)) return "– | ";
  return text("%.*f, %.*f | ", digits, scale * error.median, digits, scale * error.p95);
}

std::string row_of(const std::string& condition, const char* who, const ContenderSummary& s,
                   double extraction_ms) {
  return "| " + condition + " | " + who + " | " + share_text(s.recall) +
         text(" | %zu/%zu | ", s.wrong.successes, s.wrong.count) +
         error_text(s.translation_m, 1e3, 1) + error_text(s.translation_px, 1.0, 2) +
         error_text(s.heading_rad, 1e3, 2) + nis_text(s.nis) +
         text(" | %.0f, %.1f, %.1f |\n", extraction_ms, s.match_ms, s.solve_ms);
}

std::string recall_by_bucket(const std::vector<CellSummary>& cells, const Settings& settings) {
  std::string head = "\n| recall by overlap | |";
  std::string rule = "|---|---|";
  for (const test::Bucket& bucket : buckets_of(settings)) {
    head += text(" %.1f–%.1f |", bucket.low, bucket.high);
    rule += "---|";
  }
  std::string rows;
  const auto add = [&](const CellSummary& cell, const char* who, const ContenderSummary& s) {
    rows += "| " + cell.condition + " | " + who + " |";
    for (const Share& share : s.recall_by_bucket) rows += " " + share_text(share) + " |";
    rows += "\n";
  };
  for (const CellSummary& cell : cells) {
    add(cell, "ours", cell.ours);
    if (cell.opencv) add(cell, "OpenCV", *cell.opencv);
  }
  return head + "\n" + rule + "\n" + rows;
}

}  // namespace

std::string markdown(const std::vector<CellSummary>& cells, const Settings& settings) {
  if (cells.empty()) return "";
  std::string table = "\n## " + cells.front().floor + "\n\n" +
                      "| condition | | recall (95 %) | wrong motions | translation, mm | px | "
                      "heading, mrad | mean NIS (95 %) | beyond χ² 95 % | ms |\n"
                      "|---|---|---|---|---|---|---|---|---|---|\n";
  for (const CellSummary& cell : cells) {
    table += row_of(cell.condition, "ours", cell.ours, cell.extraction_ms);
    if (cell.opencv) table += row_of("", "OpenCV", *cell.opencv, cell.extraction_ms);
  }
  return table + recall_by_bucket(cells, settings);
}

std::string markdown(const std::vector<Negatives>& negatives, const Settings& settings) {
  if (negatives.empty()) return "";
  std::string table =
      "\n## Pairs that do not overlap\n\n"
      "| floor | pairs | accepted by ours (95 % bound) | by OpenCV (95 % bound) |\n"
      "|---|---|---|---|\n";
  for (const Negatives& n : negatives) {
    const auto bounded = [&](std::size_t accepted) {
      return text("%zu (%.2g)", accepted, clopper_pearson_upper(accepted, n.pairs));
    };
    table += text("| %s | %zu | ", n.floor.c_str(), n.pairs) + bounded(n.ours) + " | " +
             (settings.opencv ? bounded(n.opencv) : "–") + " |\n";
  }
  return table;
}

std::string markdown(const std::vector<std::pair<std::string, Speed>>& speeds) {
  if (speeds.empty()) return "";
  std::string table =
      "\n## Matching and solving, one thread\n\n"
      "| floor | features | ours, ms | OpenCV, ms | ratio |\n|---|---|---|---|---|\n";
  for (const auto& [floor, speed] : speeds) {
    table +=
        text("| %s | %zu × %zu | %.1f | %.1f | %.1f |\n", floor.c_str(), speed.from_features,
             speed.to_features, speed.ours_ms, speed.opencv_ms, speed.opencv_ms / speed.ours_ms);
  }
  return table;
}

}  // namespace fathom::benchmarks
