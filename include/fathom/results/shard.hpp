#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "fathom/results/result_store.hpp"

namespace fathom {

/// A part of a study, one of so many: counted from 1.
struct Shard {
  std::size_t index = 1;
  std::size_t of = 1;

  bool is_whole() const { return of == 1; }
  bool operator==(const Shard&) const = default;
};

/// Reads `K/N`, K from 1 to N. Throws InputError, beginning with `--shard`.
Shard parse_shard(const std::string& text);

/// "3/7".
std::string text_of(const Shard& shard);

/// Which trials of a study are a shard's: so many of the order in which shards are cut, survey by
/// survey, in each the cells by their places, and trial by trial.
struct ShardRange {
  std::size_t surveys = 0;          ///< of the study that was cut
  std::size_t trials = 0;           ///< likewise, of a survey
  std::vector<std::size_t> places;  ///< by cell
  std::size_t first = 0;
  std::size_t count = 0;

  bool has(const RunKey& run) const;
};

/// What a session of a study was to do, as its manifest says: `command_line` and
/// `shard: {index, of, runs, surveys, trials, places, first, count}`; of version 0.2.0 the first
/// three alone.
struct ShardPlan {
  Shard shard;
  std::size_t runs = 0;      ///< of estimators, in the whole shard
  std::string command_line;  ///< as command_line_of
  ShardRange range = {};     ///< without places where the manifest does not say it
};

/// Nothing where the session was not one of a shard, or the manifest is not one: of no such part,
/// as parse_shard has it.
std::optional<ShardPlan> shard_plan(const std::string& manifest);

/// What was typed to begin a session, fit to be typed again: a manifest may be anybody's, so it is
/// made anew of the words of a `fathom compare …`, each quoted for a shell. Empty where the
/// manifest has none, or one of another program, with characters that are not shown as they are, or
/// with words that have code executed.
std::string command_line_of(const std::string& manifest);

/// The command of the whole study, into the same folder.
std::string undivided(const std::string& command_line);

/// The command of another shard: the same with its number, in --out, too, where that ends in it;
/// else --out has the number added.
std::string command_of(const ShardPlan& plan, std::size_t index);

}  // namespace fathom
