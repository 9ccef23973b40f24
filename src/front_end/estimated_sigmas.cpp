#include "fathom/front_end/estimated_sigmas.hpp"

namespace fathom {

PairRegistration EstimatedSigmas::told(PairRegistration found, const MeasuredFrame& from,
                                       const MeasuredFrame& to) const {
  if (is_empty() || !found.found) return found;
  const auto tell = [this](const MeasuredFrame& frame, Eigen::Vector3d& sigma) {
    if (altitude_m && !(frame.altitude_sigma_m > 0.0)) sigma[0] = *altitude_m;
    if (tilt_rad && !frame.tilt) sigma.tail<2>().setConstant(*tilt_rad);
  };
  tell(from, found.shared.from.sigma);
  tell(to, found.shared.to.sigma);
  found.shared.own = found.own.beside(found.shared.from, found.shared.to);
  if (own_factor) found.shared.own *= *own_factor * *own_factor;
  found.covariance = found.shared.total();
  return found;
}

}  // namespace fathom
