#include "run_bytes.hpp"

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
  // Of motions their covariances: the rest is what was asked for.
  void field(const std::vector<JudgedMotions>& all) {
    for (const JudgedMotions& one : all) field(one.covariances);
  }
  void field(const Costs& costs) {
    Costs::each([&](auto, auto, auto, auto, auto member) { field(costs.*member); });
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
  void field(std::vector<JudgedMotions>& all) {
    for (JudgedMotions& one : all) field(one.covariances);
  }
  void field(Costs& costs) {
    Costs::each([&](auto, auto, auto, auto, auto member) { field(costs.*member); });
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

template <class Archive, class AnyRun>
void members(Archive& archive, AnyRun& run) {
  Run::each([&](auto member) { archive.field(run.*member); });
}

}  // namespace

std::string bytes_of(const Run& run) {
  Writer writer;
  members(writer, run);
  return writer.take();
}

Run run_of(std::string_view bytes, const ReplayOptions& asked) {
  Run run;
  run.motions = asked.motions;
  Reader reader(bytes);
  members(reader, run);
  if (!reader.is_at_end()) throw std::runtime_error("more bytes than expected");
  return run;
}

}  // namespace fathom
