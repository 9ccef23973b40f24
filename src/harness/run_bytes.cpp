#include "run_bytes.hpp"

#include <algorithm>
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
  template <class T>
  void field(const std::optional<T>& value) {
    field(value.has_value());
    if (value) field(*value);
  }
  void field(const LoopDecision& loop) {
    field(loop.from);
    field(loop.to);
    field(loop.fate);
    field(loop.nis);
  }
  void field(const AbsoluteDecision& absolute) {
    field(absolute.keyframe);
    field(absolute.fate);
    field(absolute.nis);
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
  void field(bool& value) {
    const char byte = take(1).front();
    if (byte != 0 && byte != 1) throw std::runtime_error("a flag that is none");
    value = byte == 1;
  }
  void field(LoopFate& fate) { one_of(kLoopFates, fate); }
  void field(Outcome& outcome) { one_of(kOutcomes, outcome); }
  void field(RegistrationErrors& errors) {
    one_of(std::array{RegistrationErrors::independent, RegistrationErrors::shared}, errors);
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
  template <class T>
  void field(std::optional<T>& value) {
    bool is_there = false;
    field(is_there);
    if (is_there) field(value.emplace());
  }
  void field(LoopDecision& loop) {
    field(loop.from);
    field(loop.to);
    field(loop.fate);
    field(loop.nis);
  }
  void field(AbsoluteDecision& absolute) {
    field(absolute.keyframe);
    field(absolute.fate);
    field(absolute.nis);
  }
  void field(std::vector<JudgedMotions>& all) {
    for (JudgedMotions& one : all) field(one.covariances);
  }
  void field(Costs& costs) {
    Costs::each([&](auto, auto, auto, auto, auto member) { field(costs.*member); });
  }

  bool is_at_end() const { return bytes_.empty(); }

 private:
  template <class T, std::size_t N>
  void one_of(const std::array<T, N>& all, T& value) {
    std::underlying_type_t<T> number{};
    field(number);
    value = static_cast<T>(number);
    if (std::ranges::find(all, value) == all.end()) throw std::runtime_error("a word that is none");
  }

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

// What is said of a registration or an absolute measurement belongs to that of the log.
bool are_of(const std::vector<LoopDecision>& loops, const std::vector<AbsoluteDecision>& absolute,
            const MeasurementLog& log) {
  std::size_t loop = 0;
  std::size_t fix = 0;
  for (std::size_t k = 0; k < log.size(); ++k) {
    for (const RelativePose& z : log.arrival(k).registrations) {
      const auto [from, to] = std::minmax(loops[loop].from, loops[loop].to);
      if (from != std::min(z.from, z.to) || to != z.newest()) return false;
      ++loop;
    }
    for (const AbsolutePose& z : log.arrival(k).absolute) {
      if (absolute[fix++].keyframe != z.keyframe) return false;
    }
  }
  return true;
}

bool is_of(const Run& run, const MeasurementLog& log) {
  const std::size_t loops = log.registration_count();
  const std::size_t absolute = log.absolute_count();
  return run.trajectory.size() == log.size() && run.loops.size() == loops &&
         run.loop_weights.size() == loops && run.absolute.size() == absolute &&
         run.absolute_weights.size() == absolute &&
         (!run.covariances || run.covariances->size() == log.size()) &&
         run.outcome <= (run.fault.empty() ? Outcome::numerical_failure : Outcome::crashed) &&
         are_of(run.loops, run.absolute, log) &&
         std::ranges::all_of(run.motions, [](const JudgedMotions& motions) {
           return motions.covariances.empty() || motions.covariances.size() == motions.pairs.size();
         });
}

}  // namespace

std::string bytes_of(const Run& run) {
  Writer writer;
  members(writer, run);
  return writer.take();
}

Run run_of(std::string_view bytes, const MeasurementLog& log, const ReplayOptions& asked) {
  Run run;
  run.motions = asked.motions;
  Reader reader(bytes);
  members(reader, run);
  if (!reader.is_at_end()) throw std::runtime_error("more bytes than expected");
  if (!is_of(run, log)) throw std::runtime_error("it is not of this log");
  return run;
}

}  // namespace fathom
