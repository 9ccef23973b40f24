#include "python/src/python_estimator.hpp"

#include <memory>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "fathom/core/input_error.hpp"
#include "python/src/arrays.hpp"
#include "python/src/given_measurements.hpp"
#include "python/src/python_options.hpp"
#include "python/src/python_report.hpp"

namespace fathom {
namespace {

namespace py = pybind11;

// A call with the interpreter's lock; an exception of Python becomes a text.
template <class Call>
auto locked(Call call) {
  const py::gil_scoped_acquire lock;
  try {
    return call();
  } catch (const py::error_already_set& error) {
    throw std::runtime_error(text_of(error));
  } catch (const py::cast_error&) {
    throw std::runtime_error("returned a value of another type than its docstring says");
  }
}

// An object of Python behind the interface. Every call takes the interpreter's lock.
class PythonEstimator : public Estimator {
 public:
  PythonEstimator(const py::handle& estimator_class, const EstimatorSetup& setup,
                  const py::dict& options)
      : self_(estimator_class(setup, **options)), pose_(self_.attr("pose")) {
    const py::object base = py::module_::import("fathom").attr("Estimator");
    const auto overridden = [&](const char* name) -> py::object {
      if (estimator_class.attr(name).is(base.attr(name))) return {};
      return self_.attr(name);
    };
    add_ = self_.attr("add_keyframe");
    update_ = self_.attr("update");
    own_size_ = overridden("size");
    finish_ = overridden("finish");
    joint_ = overridden("joint_covariance");
    loss_ = overridden("loss");
    loop_weights_ = overridden("loop_weights");
    absolute_weights_ = overridden("absolute_weights");
    estimates_shared_ = overridden("estimates_shared_errors");
  }

  // Only taking the lock could throw, if the interpreter had no memory for the thread's state.
  // NOLINTNEXTLINE(bugprone-exception-escape): there is nobody to tell then
  ~PythonEstimator() override {
    if (!Py_IsInitialized()) return;
    const py::gil_scoped_acquire lock;
    for (py::object* one : {&self_, &pose_, &add_, &update_, &own_size_, &finish_, &joint_, &loss_,
                            &loop_weights_, &absolute_weights_, &estimates_shared_}) {
      one->release().dec_ref();
    }
  }

  std::size_t size() const override {
    return own_size_ ? locked([&] { return own_size_().cast<std::size_t>(); }) : size_;
  }

  Pose pose(std::size_t k) const override {
    return locked([&] { return pose_of(pose_(k), "pose"); });
  }

  void add_keyframe(const RelativePose& step) override {
    locked([&] { add_(step); });
    ++size_;
  }

  UpdateReport update(const Measurements& measurements) override {
    return locked(
        [&] { return report_of(update_(GivenMeasurements(measurements)), measurements); });
  }

  UpdateReport finish(std::span<const Pose> start) override {
    if (!finish_) return {};
    return locked([&] {
      py::object poses = py::none();
      if (!start.empty()) poses = array_of(std::vector<Pose>(start.begin(), start.end()));
      return report_of_solve(finish_(poses));
    });
  }

  std::optional<Eigen::MatrixXd> joint_covariance(
      std::span<const std::size_t> keyframes) const override {
    if (!joint_) return std::nullopt;
    return locked([&]() -> std::optional<Eigen::MatrixXd> {
      py::list list;
      for (const std::size_t k : keyframes) list.append(k);
      const py::object given = joint_(list);
      if (given.is_none()) return std::nullopt;
      const auto size = static_cast<std::ptrdiff_t>(3 * keyframes.size());
      const Array array = checked_array(given, {size, size}, "joint_covariance");
      using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
      return Eigen::Map<const RowMajor>(array.data(), size, size);
    });
  }

  double loss(double chi2, int rank) const override {
    return loss_ ? locked([&] { return loss_(chi2, rank).cast<double>(); }) : chi2;
  }

  std::vector<double> loop_weights() const override {
    return weights(loop_weights_, "loop_weights");
  }

  std::vector<double> absolute_weights() const override {
    return weights(absolute_weights_, "absolute_weights");
  }

  bool estimates_shared_errors() const override {
    return estimates_shared_ && locked([&] { return estimates_shared_().cast<bool>(); });
  }

 private:
  static std::vector<double> weights(const py::object& ask, const char* what) {
    if (!ask) return {};
    return locked([&] { return values_of(ask(), what); });
  }

  py::object self_;
  py::object pose_;
  py::object add_;
  py::object update_;
  py::object own_size_;
  py::object finish_;
  py::object joint_;
  py::object loss_;
  py::object loop_weights_;
  py::object absolute_weights_;
  py::object estimates_shared_;
  std::size_t size_ = 1;
};

// Of a class, for whoever holds it without the lock.
std::shared_ptr<py::object> shared(const py::handle& value) {
  return {new py::object(py::reinterpret_borrow<py::object>(value)), [](py::object* object) {
            if (!Py_IsInitialized()) return;  // it ends with the process
            const py::gil_scoped_acquire lock;
            delete object;
          }};
}

}  // namespace

EstimatorEntry entry_of(const py::handle& estimator_class) {
  EstimatorEntry entry;
  const py::dict about =
      py::module_::import("fathom._estimator").attr("described")(estimator_class);
  entry.name = about["name"].cast<std::string>();
  entry.help = about["help"].cast<std::string>();
  entry.can_batch = about["can_batch"].cast<bool>();
  entry.plugin = about["place"].cast<std::string>();
  for (const py::handle item : about["code"]) {
    const auto both = py::reinterpret_borrow<py::tuple>(item);
    entry.code.emplace_back(both[0].cast<std::string>(), both[1].cast<std::string>());
  }
  const PythonOptions defaults = options_of(about["options"]);
  entry.options = descriptions_of(defaults);
  entry.check = [defaults](const EstimatorSetup&, const EstimatorValues& values) {
    with_values(defaults, values);
  };
  entry.create = [defaults, held = shared(estimator_class)](
                     const EstimatorSetup& setup,
                     const EstimatorValues& values) -> std::unique_ptr<Estimator> {
    const PythonOptions options = with_values(defaults, values);
    const py::gil_scoped_acquire lock;
    try {
      return std::make_unique<PythonEstimator>(*held, setup, keywords_of(options));
    } catch (const py::error_already_set& error) {
      throw std::runtime_error(text_of(error));
    }
  };
  return entry;
}

}  // namespace fathom
