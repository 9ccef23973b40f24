#include "fathom/results/shard.hpp"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <vector>

#include <nlohmann/json.hpp>

#include "fathom/core/input_error.hpp"
#include "fathom/core/program.hpp"
#include "fathom/core/text.hpp"
#include "fathom/core/utf8.hpp"

namespace fathom {
namespace {

// "runs/shard-3" for "runs/shard-5"; a folder without the number gets the other's behind it.
std::string folder_of(const std::string& folder, const Shard& shard, std::size_t index) {
  std::size_t end = folder.size();
  while (end > 0 && folder[end - 1] == '/') --end;
  std::size_t begin = end;
  while (begin > 0 && std::isdigit(static_cast<unsigned char>(folder[begin - 1])) != 0) --begin;
  const std::string digits = folder.substr(begin, end - begin);
  if (parse_integer(digits) != static_cast<std::int64_t>(shard.index)) {
    return folder.substr(0, end) + "-" + std::to_string(index);
  }
  std::string number = std::to_string(index);
  // 003: as many digits as before.
  if (digits.front() == '0' && number.size() < digits.size()) {
    number.insert(0, digits.size() - number.size(), '0');
  }
  return folder.substr(0, begin) + number;
}

// Whether a line that somebody else may have written does what it says and no more. What --plugin
// and --set name is executed as the word of who types it.
bool is_harmless(const std::vector<std::string>& words) {
  if (words.size() < 2 || words[0] != "fathom" || words[1] != "compare") return false;
  return std::ranges::none_of(words, [](const std::string& word) {
    return word.find("plugin") != std::string::npos || word.find("command") != std::string::npos ||
           word.find('\n') != std::string::npos || printable(word) != word;
  });
}

std::string line_of(const std::vector<std::string>& words) {
  std::vector<std::string> quoted;
  quoted.reserve(words.size());
  for (const std::string& word : words) quoted.push_back(shell_word(word));
  return joined(quoted, " ");
}

constexpr std::int64_t kMostShards = 1'000'000;

// Throws where it is not a whole number: the conversion of what is none is undefined.
std::size_t count_of(const nlohmann::json& number) {
  return number.get_ref<const nlohmann::json::number_unsigned_t&>();
}

}  // namespace

bool ShardRange::has(const RunKey& run) const {
  if (run.cell >= places.size() || run.survey >= surveys || run.trial >= trials) return false;
  const std::size_t at = (run.survey * places.size() + places[run.cell]) * trials + run.trial;
  return at >= first && at - first < count;
}

Shard parse_shard(const std::string& text) {
  const std::size_t slash = text.find('/');
  const auto index = parse_integer(text.substr(0, slash));
  const auto of = slash == std::string::npos ? std::nullopt : parse_integer(text.substr(slash + 1));
  if (!index || !of || *index < 1 || *of < 1 || *index > *of || *of > kMostShards) {
    throw InputError("--shard: " + in_quotes(text) +
                     " is no part of a study; expected K/N with K from 1 to "
                     "N, for example 3/7");
  }
  return {static_cast<std::size_t>(*index), static_cast<std::size_t>(*of)};
}

std::string text_of(const Shard& shard) {
  return std::to_string(shard.index) + "/" + std::to_string(shard.of);
}

std::optional<ShardPlan> shard_plan(const std::string& manifest) {
  const auto json = nlohmann::json::parse(manifest, nullptr, false);
  if (!json.is_object() || !json.contains("shard")) return std::nullopt;
  try {
    const auto& shard = json.at("shard");
    ShardPlan plan{{count_of(shard.at("index")), count_of(shard.at("of"))},
                   count_of(shard.at("runs")),
                   command_line_of(manifest)};
    if (plan.shard.index < 1 || plan.shard.index > plan.shard.of || plan.shard.of > kMostShards) {
      return std::nullopt;
    }
    if (!shard.contains("places")) return plan;
    plan.range.surveys = count_of(shard.at("surveys"));
    plan.range.trials = count_of(shard.at("trials"));
    plan.range.first = count_of(shard.at("first"));
    plan.range.count = count_of(shard.at("count"));
    for (const auto& place : shard.at("places")) plan.range.places.push_back(count_of(place));
    return plan;
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
}

std::string command_line_of(const std::string& manifest) {
  const auto json = nlohmann::json::parse(manifest, nullptr, false);
  const auto line = json.is_object() ? json.find("command_line") : json.end();
  if (!json.is_object() || line == json.end() || !line->is_string()) return "";
  try {
    const std::vector<std::string> words = words_of_command(line->get<std::string>());
    return is_harmless(words) ? line_of(words) : "";
  } catch (const InputError&) {
    return "";  // a quote that is not closed
  }
}

std::string undivided(const std::string& command_line) {
  if (command_line.empty()) return "";
  std::vector<std::string> words = words_of_command(command_line);
  if (const auto flag = std::ranges::find(words, "--shard");
      flag != words.end() && flag + 1 != words.end()) {
    words.erase(flag, flag + 2);
  }
  std::erase_if(words, [](const std::string& word) { return word.starts_with("--shard="); });
  return line_of(words);
}

std::string command_of(const ShardPlan& plan, std::size_t index) {
  if (index == plan.shard.index || plan.command_line.empty()) return plan.command_line;
  std::vector<std::string> words = words_of_command(plan.command_line);
  const std::string number = text_of(Shard{index, plan.shard.of});
  for (std::size_t i = 0; i < words.size(); ++i) {
    const bool has_next = i + 1 < words.size();
    if (words[i] == "--shard" && has_next) words[i + 1] = number;
    if (words[i].starts_with("--shard=")) words[i] = "--shard=" + number;
    if (words[i] == "--out" && has_next) words[i + 1] = folder_of(words[i + 1], plan.shard, index);
    if (words[i].starts_with("--out=")) {
      words[i] = "--out=" + folder_of(words[i].substr(6), plan.shard, index);
    }
  }
  return line_of(words);
}

}  // namespace fathom
