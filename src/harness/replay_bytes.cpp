#include "replay_bytes.hpp"

#include <cstring>
#include <stdexcept>
#include <type_traits>

namespace fathom {
namespace {

// Writer and Reader do the same with every field, so that one list of them serves both.
class Writer {
 public:
  template <class T>
  void field(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void field(const Eigen::Matrix3d& matrix) {
    for (Eigen::Index i = 0; i < matrix.size(); ++i) field(matrix.data()[i]);
  }
  void field(const std::string& text) {
    field(text.size());
    bytes_ += text;
  }
  template <class T>
  void field(const std::vector<T>& all) {
    field(all.size());
    for (const T& one : all) field(one);
  }
  void field(const std::optional<std::vector<Eigen::Matrix3d>>& all) {
    field(all.has_value());
    if (all) field(*all);
  }

  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}

  template <class T>
  void field(T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
  }
  void field(Eigen::Matrix3d& matrix) {
    for (Eigen::Index i = 0; i < matrix.size(); ++i) field(matrix.data()[i]);
  }
  void field(std::string& text) {
    std::size_t size = 0;
    field(size);
    text = take(size);
  }
  template <class T>
  void field(std::vector<T>& all) {
    std::size_t size = 0;
    field(size);
    if (size > bytes_.size()) throw std::runtime_error("more elements than bytes");
    all.resize(size);
    for (T& one : all) field(one);
  }
  void field(std::optional<std::vector<Eigen::Matrix3d>>& all) {
    bool is_there = false;
    field(is_there);
    if (is_there) field(all.emplace());
  }

  bool is_at_end() const { return bytes_.empty(); }

 private:
  std::string_view take(std::size_t count) {
    if (count > bytes_.size()) throw std::runtime_error("fewer bytes than expected");
    const std::string_view taken = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return taken;
  }

  std::string_view bytes_;
};

// Every member of Replay, in order.
template <class Archive, class AnyReplay>
void fields(Archive& archive, AnyReplay& replay) {
  archive.field(replay.trajectory);
  archive.field(replay.covariances);
  archive.field(replay.outcome);
  archive.field(replay.fault);
  archive.field(replay.outcome_counts);
  archive.field(replay.loops);
  archive.field(replay.loop_weights);
  archive.field(replay.absolute);
  archive.field(replay.absolute_weights);
  archive.field(replay.iterations);
  archive.field(replay.gradient_norm);
  archive.field(replay.is_local_minimum);
  archive.field(replay.update_ms);
  archive.field(replay.add_ms);
  archive.field(replay.newest_covariance_ms);
  archive.field(replay.candidate_covariance_ms);
  archive.field(replay.total_ms);
  archive.field(replay.cpu_ms);
  archive.field(replay.covariance_ms);
  archive.field(replay.start_up_ms);
  archive.field(replay.memory_bytes);
  for (auto& motions : replay.motions) archive.field(motions.covariances);
  archive.field(replay.chi2_initial);
  archive.field(replay.cost_used);
  archive.field(replay.absolute_cost_used);
}

}  // namespace

std::string bytes_of(const Replay& replay) {
  Writer writer;
  fields(writer, replay);
  return writer.take();
}

Replay replay_of(std::string_view bytes, const ReplayOptions& asked) {
  Replay replay;
  replay.motions = asked.motions;
  Reader reader(bytes);
  fields(reader, replay);
  if (!reader.is_at_end()) throw std::runtime_error("more bytes than expected");
  return replay;
}

}  // namespace fathom
