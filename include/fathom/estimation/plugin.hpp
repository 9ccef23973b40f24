#pragma once

#include <cstdint>
#include <filesystem>

#include <Eigen/Core>

#include "fathom/estimation/registry.hpp"

namespace fathom {

/// Version of what a plug-in and a program say to one another. It rises with every change to a
/// public type of `estimation` or of what that includes.
inline constexpr std::uint32_t kPluginVersion = 4;

/// What the compiler made of those types. It depends on flags too: with `-march=native` Eigen
/// aligns its matrices otherwise, and an object that passes between two such builds is read
/// wrongly.
struct PluginBuild {
  std::uint32_t eigen = EIGEN_WORLD_VERSION * 10000U + EIGEN_MAJOR_VERSION * 100U +
                        EIGEN_MINOR_VERSION;              ///< 30400 for 3.4.0
  std::uint32_t eigen_alignment = EIGEN_MAX_ALIGN_BYTES;  ///< bytes
  std::uint32_t relative_bytes = sizeof(RelativePose);
  std::uint32_t absolute_bytes = sizeof(AbsolutePose);
  std::uint32_t report_bytes = sizeof(UpdateReport);
  std::uint32_t entry_bytes = sizeof(EstimatorEntry);  ///< strings, vectors, functions
};

/// What the exported function of a plug-in returns. `version` stays where it is for ever: it is
/// read first, and nothing else of one that is not the program's own.
struct PluginInterface {
  std::uint32_t version = kPluginVersion;
  PluginBuild build;
  void (*add_estimators)(EstimatorRegistry& registry) = nullptr;
};

/// Adds the estimators of a plug-in: a shared object that exports FATHOM_PLUGIN, or a `.py` file
/// with subclasses of the Python class fathom.Estimator. It stays loaded to the end of the program.
/// Throws InputError, one line with the file, where it cannot be loaded (a shared object is tried
/// in a child process first), exports no such function, was made for another version or build, or
/// brings an estimator whose name is taken; the registry is as it was then.
void load_plugin(const std::filesystem::path& file, EstimatorRegistry& registry);

/// What reads a `.py` file: its interface is valid until the next call. Throws InputError.
using PythonPlugins = const PluginInterface*(const char* file);

/// Of a process that is a Python interpreter already. Without it the first `.py` file has an
/// interpreter started.
void set_python_plugins(PythonPlugins* plugins);

}  // namespace fathom

/// Exports `add_estimators`, a function void(fathom::EstimatorRegistry&). Once in a plug-in,
/// outside of all namespaces.
#define FATHOM_PLUGIN(add_estimators)                                                              \
  extern "C" __attribute__((visibility("default"))) const fathom::PluginInterface*                 \
  fathom_plugin() {                                                                                \
    static const fathom::PluginInterface interface { fathom::kPluginVersion, {}, add_estimators }; \
    return &interface;                                                                             \
  }
