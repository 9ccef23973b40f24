#pragma once

#include <string>
#include <vector>

namespace fathom::test {

/// A third party by the way its headers begin, and the folders or files that may use it.
struct ThirdParty {
  std::string header;
  std::vector<std::string> users;
};

// NOLINTNEXTLINE(readability-function-size): a table
inline const std::vector<ThirdParty>& third_parties() {
  static const std::vector<ThirdParty> list{
      {"Eigen/", {""}},
      {"opencv2/",
       {"vision/", "datasets/", "front_end/", "src/report/pictures/", "src/report/earth/",
        "include/fathom/report/geo_tiff.hpp", "include/fathom/report/match_picture.hpp",
        "include/fathom/report/mosaic.hpp", "include/fathom/report/world_file.hpp",
        "include/fathom/report/picture.hpp", "src/workflow/", "apps/", "benchmarks/"}},
      {"pybind11/", {"python/"}},
      {"Python.h", {"python/bridge/"}},
      {"benchmark/", {"benchmarks/"}},
      {"boost/crc.hpp",
       {"src/datasets/import/mcap_records.cpp", "src/datasets/picture_header.cpp"}},
      {"boost/math/", {"src/core/chi_squared.cpp", "src/evaluation/distributions.cpp"}},
      {"ceres/", {"estimators/ceres_pose_graph/"}},
      {"scotch.h", {"estimators/support/sparse/nested_dissection.cpp"}},
      {"SESync/", {"adapters/se_sync/"}},
      {"g2o/", {"adapters/g2o/"}},
      {"gtsam/", {"adapters/gtsam/"}},
      {"mrpt/", {"adapters/mrpt/"}},
      {"tbb/", {"adapters/gtsam/"}},
      {"yaml-cpp/",
       {"src/configuration/", "src/core/yaml_limits.cpp",
        "src/datasets/image_folder/camera_yaml.cpp", "src/datasets/image_folder/sensor_yaml.cpp",
        "src/datasets/image_folder/yaml_root.", "src/datasets/import/ros2_metadata.cpp"}},
      {"immintrin.h", {"include/fathom/core/cpu.hpp"}},
      {"geo_normalize.h", {"src/report/earth/geo_tiff.cpp"}},
      {"geodesic.h",
       {"src/datasets/image_folder/earth_fixes.cpp", "src/report/earth/earth_frame.cpp"}},
      {"geotiffio.h", {"src/report/earth/geo_tiff.cpp"}},
      {"proj.h", {"src/report/earth/earth_frame.cpp"}},
      {"xtiffio.h", {"src/report/earth/geo_tiff.cpp"}},
      {"libexif/", {"src/datasets/pictures/exif.cpp"}},
      {"console_bridge/", {"src/datasets/import/ros1_module.cpp"}},
      {"rosbag/", {"src/datasets/import/ros1_module.cpp"}},
      {"dlfcn.h", {"src/core/module.cpp", "src/estimation/plugin.cpp"}},
      {"lz4frame.h", {"src/datasets/import/mcap_chunk.cpp"}},
      {"zstd.h", {"src/datasets/import/mcap_chunk.cpp"}},
      {"fastcdr/", {"src/datasets/import/cdr_message.cpp"}},
      {"SQLiteCpp/",
       {"src/results/", "src/front_end/registration_", "src/front_end/picture_store.cpp",
        "src/datasets/import/sqlite_file.cpp"}},
      {"sqlite3.h",
       {"src/results/", "src/front_end/registration_", "src/front_end/picture_store.cpp"}},
      {"nlohmann/", {"src/results/", "src/harness/", "src/report/", "benchmarks/"}},
      {"cairo", {"src/report/"}},
      {"cblas.h",
       {"src/core/blas_memory.cpp", "src/vision/", "src/core/pin_threads.cpp",
        "python/src/one_thread.cpp", "benchmarks/"}},
      {"CLI/", {"apps/", "benchmarks/"}},
      {"fmt/", {""}},
      {"glog/", {"apps/main.cpp"}},
      {"omp.h", {"src/core/pin_threads.cpp", "python/src/one_thread.cpp"}},
      {"pthread.h", {"python/src/python_forks.cpp"}},
      {"malloc.h", {"src/core/system.cpp", "src/memory_meter/"}},
      {"link.h", {"src/estimation/plugin.cpp"}},
      {"signal.h", {"src/core/system.cpp"}},
      {"fcntl.h",
       {"src/core/child_side.cpp", "src/core/file_lock.cpp", "src/core/files.cpp",
        "src/core/forked_child.cpp", "src/core/program.cpp", "src/core/program_start.cpp",
        "src/core/system.cpp"}},
      {"sys/mman.h",
       {"src/memory_meter/", "estimators/support/filter/growing_memory.cpp",
        "estimators/support/sparse/panel_memory.cpp", "src/core/blas_memory.cpp",
        "src/core/child_side.cpp", "src/report/pictures/zeroed_pixels.cpp"}},
      {"sys/time.h", {"src/core/time_value.hpp"}},
      {"sys/prctl.h", {"src/core/child_side.cpp"}},
      {"poll.h", {"src/core/forked_child.cpp", "src/core/program.cpp"}},
      {"spawn.h", {"src/core/program_start.cpp"}},
      {"sys/file.h", {"src/core/file_lock.cpp"}},
      {"sys/stat.h", {"src/core/file_lock.cpp"}},
      {"sys/wait.h",
       {"apps/child_process.cpp", "benchmarks/", "src/core/forked_child.cpp",
        "src/core/program.cpp"}},
      {"sys/resource.h",
       {"benchmarks/", "src/core/child_side.cpp", "src/core/forked_child.cpp",
        "src/core/processor_limit.hpp", "src/core/program.cpp", "src/core/system.cpp"}},
      {"unistd.h",
       {"benchmarks/", "src/core/child_side.cpp", "src/core/files.cpp", "src/core/file_lock.cpp",
        "src/core/forked_child.cpp", "src/core/program.cpp", "src/core/program_start.cpp",
        "src/core/system.cpp", "apps/child_process.cpp", "apps/progress.cpp",
        "apps/out_of_memory.cpp", "apps/stop_signal.cpp"}}};
  return list;
}

}  // namespace fathom::test
