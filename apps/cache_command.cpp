// fathom cache: the registrations that are kept.

#include <fmt/format.h>
#include <memory>

#include "apps/command.hpp"
#include "apps/output.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "fathom/front_end/registration_store.hpp"

namespace fathom {
namespace {

struct CacheCommandFlags {
  std::string folder;
  bool clear = false;
};

// A name that is misspelt is no empty cache.
void require_cache(const std::filesystem::path& folder) {
  if (has_registrations(folder)) return;
  std::error_code error;
  if (std::filesystem::is_directory(folder) && std::filesystem::is_empty(folder, error)) return;
  throw InputError(folder.string(), "is no cache; expected the folder of --cache or FATHOM_CACHE");
}

void show_or_clear(const CacheCommandFlags& flags, Context& context) {
  const bool is_usual = flags.folder.empty();
  const std::filesystem::path folder =
      is_usual ? default_cache_folder() : std::filesystem::path(flags.folder);
  if (folder.empty())
    throw InputError("no folder for the cache of registrations; set FATHOM_CACHE");
  if (!is_usual) require_cache(folder);
  if (flags.clear) clear_cache(folder);
  const CacheContent content = cache_content(folder);
  const std::string bound = is_usual
                                ? fmt::format(" of at most {:.0f} MB ($FATHOM_CACHE_MB)",
                                              1e-6 * static_cast<double>(default_cache_bytes()))
                                : "";
  print("%s\n  %s, %s or their features, %.1f MB%s\n", folder.c_str(),
        counted(content.registrations, "registration").c_str(),
        counted(content.pictures, "picture").c_str(), 1e-6 * static_cast<double>(content.bytes),
        bound.c_str());
  context.status = kDone;
}

}  // namespace

void add_cache(CLI::App& program, Context& context) {
  auto flags = std::make_shared<CacheCommandFlags>();
  Command command(program, "cache",
                  "Show or clear the registrations, pictures and features that are kept",
                  "Example: fathom cache --clear\n"
                  "It may be cleared at any time, also while other commands run: they make "
                  "anew what they need.");
  command.text("--cache", flags->folder, "DIR",
               "Its folder (default: $FATHOM_CACHE, or ~/.cache/fathom)");
  command.boolean("--clear", flags->clear, "Remove all of them");
  command.quiet();
  command.on_run([flags, &context] { show_or_clear(*flags, context); });
}

}  // namespace fathom
