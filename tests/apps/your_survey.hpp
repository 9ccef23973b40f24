#pragma once

#include <cstdio>
#include <string>

#include <opencv2/imgproc.hpp>

#include "apps/commands.hpp"
#include "support/pictures.hpp"

namespace fathom::test {

// A loop of some metres, from `scale` times 2 m: all lengths as long, nothing else.
inline std::string survey(double scale) {
  char text[1024];
  std::snprintf(text, sizeof text,
                "dataset:\n  type: simulated\n"
                "  world: {metres_per_pixel: %.17g}\n"
                "  mission: {type: single_loop, loop_length_m: %.17g, loop_width_m: %.17g, "
                "loop_overrun_m: %.17g, turn_radius_m: %.17g, speed_m_s: %.17g}\n"
                "  altitude: {base_m: %.17g, amplitude_m: %.17g, altimeter_sigma_m: %.17g}\n"
                "  camera: {width: 160, height: 120, fx: 130, fy: 130}\n"
                "  odometry: {sigma_x_m: %.17g, sigma_y_m: %.17g, sigma_theta_rad: 0.01}\n",
                0.01 * scale, 2.4 * scale, 1.6 * scale, 0.8 * scale, 0.4 * scale, 0.5 * scale,
                2.0 * scale, 0.1 * scale, 0.005 * scale, 0.01 * scale, 0.01 * scale);
  return text;
}

/// A survey of one's own.
class YourSurvey : public Commands {
 protected:
  void simulate(const std::string& folder) const {
    write("survey.yaml", survey(1.0));
    fathom_done({"simulate", "survey.yaml", "--out", folder});
  }

  /// Spots of many sizes, 12 m x 12 m at 1 cm a pixel.
  void write_floor(const std::string& name) const {
    cv::RNG random(7);
    cv::Mat floor(1200, 1200, CV_32F, cv::Scalar(128));
    for (const int side_px : {2, 5, 12, 30}) {
      cv::Mat noise(1200 / side_px, 1200 / side_px, CV_32F);
      random.fill(noise, cv::RNG::NORMAL, 0.0, 25.0);
      cv::Mat wide;
      cv::resize(noise, wide, floor.size(), 0.0, 0.0, cv::INTER_CUBIC);
      floor += wide;
    }
    cv::Mat grey;
    floor.convertTo(grey, CV_8U);
    write_picture(path(name), grey);
  }

  double number(const std::string& run, const std::string& metric) const {
    return json_of(run + "/metrics.json").at(metric).get<double>();
  }
};

}  // namespace fathom::test
