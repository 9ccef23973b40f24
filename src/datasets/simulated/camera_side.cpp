#include "camera_side.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Core>
#include <opencv2/imgproc.hpp>

#include "fathom/core/random.hpp"

namespace fathom {
namespace {

// A Gaussian about the optical axis that has fallen to `corner` in the farthest corner.
void light_cone(cv::Mat_<float>& light, const CameraModel& camera, double corner) {
  const double across = std::max(camera.cx, camera.width - 1 - camera.cx);
  const double down = std::max(camera.cy, camera.height - 1 - camera.cy);
  const double exponent = std::log(corner) / (across * across + down * down);
  const auto fall = [exponent](double px) { return std::exp(exponent * px * px); };
  std::vector<float> columns;
  columns.reserve(static_cast<std::size_t>(light.cols));
  for (int u = 0; u < light.cols; ++u) columns.push_back(static_cast<float>(fall(u - camera.cx)));
  for (int v = 0; v < light.rows; ++v) {
    const auto row = static_cast<float>(fall(v - camera.cy));
    for (int u = 0; u < light.cols; ++u) light(v, u) *= row * columns[static_cast<std::size_t>(u)];
  }
}

struct Particle {
  double u_px;
  double v_px;
  double radius_px;
  float opacity;
};

// A soft disc: full to half of its radius, nothing beyond it.
void paint(cv::Mat_<float>& light, const Particle& particle) {
  constexpr float kGrey = 240.0F;
  const double r = particle.radius_px;
  const int bottom = std::min(light.rows - 1, static_cast<int>(particle.v_px + r));
  const int right = std::min(light.cols - 1, static_cast<int>(particle.u_px + r));
  for (int v = std::max(0, static_cast<int>(particle.v_px - r)); v <= bottom; ++v) {
    for (int u = std::max(0, static_cast<int>(particle.u_px - r)); u <= right; ++u) {
      const double reach = std::hypot(u - particle.u_px, v - particle.v_px) / r;
      const double t = std::clamp(2.0 * (1.0 - reach), 0.0, 1.0);
      const auto share = static_cast<float>(t * t * (3.0 - 2.0 * t)) * particle.opacity;
      light(v, u) += share * std::max(0.0F, kGrey - light(v, u));
    }
  }
}

void strew_particles(cv::Mat_<float>& light, int count, RandomStream stream) {
  constexpr double kSmallestPx = 1.5;
  constexpr double kLargestPx = 8.0;
  for (int i = 0; i < count; ++i) {
    Particle particle{};
    particle.u_px = stream.uniform(0.0, light.cols);
    particle.v_px = stream.uniform(0.0, light.rows);
    particle.radius_px = kSmallestPx * std::pow(kLargestPx / kSmallestPx, stream.uniform());
    particle.opacity = static_cast<float>(stream.uniform(0.2, 0.8));
    paint(light, particle);
  }
}

// The kernel of a linear motion blur: even weight along a line of `length_px` about the middle,
// each point of it split bilinearly among the four pixels around it.
cv::Mat_<float> line_kernel(double length_px, double along_u, double along_v) {
  const int reach = static_cast<int>(std::ceil(length_px / 2.0)) + 1;
  const int points = 64 * (reach + 1);
  cv::Mat_<float> kernel = cv::Mat_<float>::zeros(2 * reach + 1, 2 * reach + 1);
  for (int i = 0; i < points; ++i) {
    const double at = length_px * ((i + 0.5) / points - 0.5);
    const double u = reach + at * along_u;
    const double v = reach + at * along_v;
    const int left = static_cast<int>(u);
    const int top = static_cast<int>(v);
    const double fu = u - left;
    const double fv = v - top;
    kernel(top, left) += static_cast<float>((1 - fu) * (1 - fv) / points);
    kernel(top, left + 1) += static_cast<float>(fu * (1 - fv) / points);
    kernel(top + 1, left) += static_cast<float>((1 - fu) * fv / points);
    kernel(top + 1, left + 1) += static_cast<float>(fu * fv / points);
  }
  return kernel;
}

// The direction in which the floor passes through the middle of the picture; of unit length.
Eigen::Vector2d way_in_picture(const Camera& camera, const View& view) {
  const Stance stance{view.altitude_m, view.tilt};
  const Eigen::Vector2d middle = camera.floor_point({camera.model().cx, camera.model().cy}, stance);
  // So little that neither lens nor tilt bends it, and far more than rounding.
  const double step_m = 1e-4 * view.altitude_m;
  const Eigen::Vector2d ahead(std::cos(view.motion_rad), std::sin(view.motion_rad));
  return (camera.pixel(middle + step_m * ahead, stance) - camera.pixel(middle, stance))
      .normalized();
}

void motion_blur(cv::Mat_<float>& light, const Eigen::Vector2d& way, double length_px) {
  cv::Mat_<float> blurred;
  cv::filter2D(light, blurred, CV_32F, line_kernel(length_px, way.x(), way.y()), {-1, -1}, 0.0,
               cv::BORDER_REPLICATE);
  light = blurred;
}

// Each channel is a picture of 8 bits before they are weighed (ITU-R BT.601) and added.
void colour_cast(cv::Mat_<float>& light, const std::vector<double>& gains) {
  constexpr std::array<float, 3> kWeights{0.299F, 0.587F, 0.114F};
  for (float& grey : light) {
    float sum = 0.0F;
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const auto gain = static_cast<float>(gains[channel]);
      sum += kWeights[channel] * static_cast<float>(cv::saturate_cast<uchar>(gain * grey));
    }
    grey = sum;
  }
}

}  // namespace

cv::Mat_<float> seen_by_camera(cv::Mat_<float> light, const Camera& camera, const View& view,
                               const PictureEffects& effects) {
  const CameraEffects& own = effects.camera;
  if (own.corner_light < 1.0) light_cone(light, camera.model(), own.corner_light);
  if (effects.water.particles > 0) {
    strew_particles(light, effects.water.particles, RandomStream(view.seed, "particles"));
  }
  if (own.contrast < 1.0) {
    const double mean = cv::mean(light)[0];
    light = own.contrast * light + (1.0 - own.contrast) * mean;
  }
  if (own.motion_blur_px > 0.0) {
    motion_blur(light, way_in_picture(camera, view), own.motion_blur_px);
  }
  if (!own.colour_cast.empty()) colour_cast(light, own.colour_cast);
  if (own.noise_sigma > 0.0) {
    RandomStream stream(view.seed, "sensor_noise");
    for (float& grey : light) grey += static_cast<float>(own.noise_sigma * stream.normal());
  }
  return light;
}

}  // namespace fathom
