#include "fathom/front_end/options.hpp"

namespace fathom {

void FrontEndOptions::describe(OptionTable& table) {
  table.integer("keyframes.separation_frames", separation_frames, Range::at_least(1), "frames",
                "a keyframe every so many frames");
  table.group("candidates", candidates);
  table.group("features", features);
  registration.describe(table);
  table.real("visual_odometry.fallback_sigma_m", visual_odometry.sigma_m, Range::positive(), "m",
             "uncertainty of a motion repeated because consecutive pictures do not register");
  table.real("visual_odometry.fallback_sigma_rad", visual_odometry.sigma_rad, Range::positive(),
             "rad", "likewise, of its heading");
}

}  // namespace fathom
