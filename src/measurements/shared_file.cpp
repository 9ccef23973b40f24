#include "fathom/measurements/shared_file.hpp"

#include <cstdint>
#include <map>

#include "fathom/core/files.hpp"
#include "fathom/core/text.hpp"
#include "fathom/measurements/g2o.hpp"

namespace fathom {
namespace {

constexpr const char* kHeader = "# fathom shared errors 1\n";
std::string numbers_text(const Eigen::Matrix3d& matrix, bool is_symmetric) {
  std::string text;
  for (int row = 0; row < 3; ++row) {
    for (int column = is_symmetric ? row : 0; column < 3; ++column) {
      text += ' ' + exact(matrix(row, column));
    }
  }
  return text;
}

}  // namespace

std::filesystem::path shared_file_of(const std::filesystem::path& graph) {
  return std::filesystem::path(graph).replace_extension(".shared");
}

std::optional<SharedText> shared_beside(const std::filesystem::path& graph) {
  const std::filesystem::path shared = shared_file_of(graph);
  std::error_code error;
  if (shared == graph || !std::filesystem::exists(shared, error)) return std::nullopt;
  return SharedText{read_text(shared), shared.string()};
}

std::string to_shared(const MeasurementLog& log) {
  const auto id = [&log](std::size_t k) {
    return std::to_string(k < log.ids.size() ? log.ids[k] : static_cast<std::int64_t>(k));
  };
  std::map<std::size_t, Eigen::Vector3d> pictures;
  std::string registrations;
  const auto add = [&](const RelativePose& z) {
    if (!z.shared) return;
    pictures.emplace(z.from, z.shared->from.sigma);
    pictures.emplace(z.to, z.shared->to.sigma);
    registrations += "REGISTRATION " + id(z.from) + ' ' + id(z.to) + ' ' + exact(z.motion.x) + ' ' +
                     exact(z.motion.y) + ' ' + exact(z.motion.theta) +
                     numbers_text(z.shared->from.G, false) + numbers_text(z.shared->to.G, false) +
                     numbers_text(z.shared->own, true) + '\n';
  };
  for (std::size_t k = 0; k < log.size(); ++k) {
    for (const RelativePose& z : log.arrival(k).registrations) add(z);
  }
  if (pictures.empty()) return {};
  std::string text = kHeader;
  for (const auto& [k, sigma] : pictures) {
    text += "PICTURE " + id(k) + ' ' + exact(sigma[0]) + ' ' + exact(sigma[1]) + ' ' +
            exact(sigma[2]) + '\n';
  }
  return text + registrations;
}

void write_graph(const std::filesystem::path& graph, const MeasurementLog& log,
                 const std::optional<std::vector<Pose>>& vertices) {
  write_file(graph, vertices ? to_g2o(log, *vertices) : to_g2o(log));
  const std::filesystem::path shared = shared_file_of(graph);
  if (const std::string text = to_shared(log); !text.empty()) {
    write_file(shared, text);
  } else {
    std::error_code error;
    std::filesystem::remove(shared, error);
  }
}

std::string text_of(const MeasurementLog& log) {
  return to_g2o(log) + to_shared(log);
}

}  // namespace fathom
