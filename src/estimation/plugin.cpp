#include "fathom/estimation/plugin.hpp"

#include <array>
#include <cstdint>
#include <cstring>
#include <dlfcn.h>
#include <exception>
#include <fmt/format.h>
#include <fstream>
#include <link.h>
#include <string>
#include <utility>

#include "fathom/core/forked_child.hpp"
#include "fathom/core/input_error.hpp"
#include "python_plugins.hpp"

namespace fathom {
namespace {

constexpr const char* kExported = "fathom_plugin";

std::string linker_error() {
  const char* const text = ::dlerror();
  return text == nullptr ? "unknown error" : text;
}

// The table of sections lies behind all that is loaded. Of a file that ends before it pages are
// missing, and who touches one of them is killed, be it long after loading.
void require_whole(const std::filesystem::path& file) {
  ElfW(Ehdr) head{};
  std::ifstream stream(file, std::ios::binary);
  if (!stream.read(reinterpret_cast<char*>(&head), sizeof head)) return;
  if (std::memcmp(head.e_ident, ELFMAG, SELFMAG) != 0) return;
  const std::uintmax_t end = head.e_shoff + std::uintmax_t{head.e_shnum} * head.e_shentsize;
  const std::uintmax_t size = std::filesystem::file_size(file);
  if (size >= end) return;
  throw InputError(file.string(), fmt::format("is cut short: it has {} bytes, expected {}; copy or "
                                              "build it again",
                                              size, end));
}

// A file that is damaged, or half written, crashes whoever loads it.
void require_loadable(const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file)) {
    throw InputError("'" + file.string() +
                     "': there is no such plug-in; expected a shared object or a .py file");
  }
  require_whole(file);
  constexpr ChildLimits kLimits{60.0, std::int64_t{4} << 30};
  const auto load = [&](const MessagePipe&) {
    ::dlopen(std::filesystem::absolute(file).c_str(), RTLD_NOW | RTLD_LOCAL);
  };
  const ChildEnd end = run_child(load, kLimits, [](char, const std::string&) {});
  if (end.signal == 0 && end.exit_status == 0 && !end.is_late) return;
  throw InputError(file.string(), "crashes whoever loads it, by signal " +
                                      std::to_string(end.signal) + "; build it again");
}

const PluginInterface& interface_of(const std::filesystem::path& file) {
  require_loadable(file);
  // A name without a folder would be looked for among the system's libraries.
  void* const library = ::dlopen(std::filesystem::absolute(file).c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) throw InputError("the plug-in cannot be loaded: " + linker_error());
  void* const symbol = ::dlsym(library, kExported);
  if (symbol == nullptr) {
    throw InputError(file.string(),
                     "is no plug-in: it does not export fathom_plugin; see FATHOM_PLUGIN in "
                     "fathom/estimation/plugin.hpp");
  }
  const auto function = reinterpret_cast<const PluginInterface* (*)()>(symbol);
  const PluginInterface* const found = function();
  if (found == nullptr) throw InputError(file.string(), "its fathom_plugin returns nothing");
  return *found;
}

void require_version(const std::filesystem::path& file, const PluginInterface& plugin) {
  if (plugin.version == kPluginVersion) return;
  throw InputError(file.string(),
                   fmt::format("was made for version {} of the plug-in interface, this program has "
                               "version {}; build it against the installed Fathom",
                               plugin.version, kPluginVersion));
}

void require_build(const std::filesystem::path& file, const PluginBuild& plugin) {
  const PluginBuild own;
  const std::array<std::pair<const char*, std::uint32_t PluginBuild::*>, 6> all{
      {{"the version of Eigen", &PluginBuild::eigen},
       {"the alignment of Eigen (-march?)", &PluginBuild::eigen_alignment},
       {"the size of a relative measurement", &PluginBuild::relative_bytes},
       {"the size of an absolute measurement", &PluginBuild::absolute_bytes},
       {"the size of a report", &PluginBuild::report_bytes},
       {"the size of a described estimator", &PluginBuild::entry_bytes}}};
  for (const auto& [what, field] : all) {
    if (plugin.*field == own.*field) continue;
    throw InputError(file.string(),
                     fmt::format("was compiled otherwise than this program: {} is {}, expected {}; "
                                 "build it with the same flags against the same packages",
                                 what, plugin.*field, own.*field));
  }
}

// In a registry of their own first: among themselves their names differ, too.
EstimatorRegistry estimators_of(const std::filesystem::path& file, const PluginInterface& plugin) {
  EstimatorRegistry brought;
  if (plugin.add_estimators == nullptr) throw InputError(file.string(), "brings no estimators");
  try {
    plugin.add_estimators(brought);
  } catch (const InputError& error) {
    throw InputError(file.string(), error.what());
  } catch (const std::exception& error) {
    throw InputError(file.string(), std::string("adding its estimators threw: ") + error.what());
  } catch (...) {
    throw InputError(file.string(), "adding its estimators threw what is no std::exception");
  }
  if (brought.entries().empty()) throw InputError(file.string(), "brings no estimators");
  return brought;
}

}  // namespace

void load_plugin(const std::filesystem::path& file, EstimatorRegistry& registry) {
  const PluginInterface& plugin =
      file.extension() == ".py" ? python_interface_of(file) : interface_of(file);
  require_version(file, plugin);
  require_build(file, plugin.build);
  EstimatorRegistry both = registry;
  const EstimatorRegistry brought = estimators_of(file, plugin);
  for (EstimatorEntry entry : brought.entries()) {
    entry.plugin = std::filesystem::absolute(file).lexically_normal();
    try {
      both.add(std::move(entry));
    } catch (const InputError& error) {
      throw InputError(file.string(), error.what());
    }
  }
  registry = std::move(both);
}

}  // namespace fathom
