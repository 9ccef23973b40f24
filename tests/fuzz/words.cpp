// Words of a command, what is shown of others' text, and the command line of a manifest.
#include "fathom/core/program.hpp"
#include "fathom/core/text.hpp"
#include "fathom/core/utf8.hpp"
#include "fathom/results/shard.hpp"
#include "support/fuzz.hpp"

namespace {

using namespace fathom;

void look_at_plan(const std::string& text) {
  const std::optional<ShardPlan> plan = shard_plan(text);
  const std::string line = command_line_of(text);
  if (plan) command_of(*plan, 2);
  if (line.empty()) return;
  std::string again;
  for (const std::string& word : words_of_command(line)) {
    again += (again.empty() ? "" : " ") + shell_word(word);
  }
  fuzz::require(again == line, "a command line has the words that it was made of");
  fuzz::require(printable(line) == line, "a command line is shown as it is");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(fuzz::text_of(data, size));
  const std::string shown = printable(text);
  fuzz::require(printable(shown, 1'000'000) == shown, "what is printable stays as it is");
  drawable_text(text);
  in_quotes(text);
  fuzz::is_taken([&] { words_of_command(text); });
  fuzz::is_taken([&] { parse_shard(text); });
  const std::vector<std::string> words = words_of_command(shell_word(text));
  fuzz::require(words.size() == 1 && words[0] == text, "a quoted word is one word");
  look_at_plan(text);
  return 0;
}
