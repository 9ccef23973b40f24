#include "fathom/datasets/camera_options.hpp"
#include "fathom/datasets/picture_folder.hpp"

namespace fathom {

void PictureFolderOptions::describe(OptionTable& table) {
  table.text("path", path, "the folder of the pictures; relative to the working folder");
  table.real_or_off("altitude_m", altitude_m, Range::positive(), "m",
                    "height over the floor of all pictures");
  table.text("altitudes", altitudes, "or a CSV file with the height of each: filename, metres");
  table.text("odometry", odometry,
             "a CSV file: filename, p_x, p_y, theta, step_var_x, step_var_y, step_var_theta; none: "
             "visual odometry");
  table.text("mask", mask,
             "a picture of the size of the others, 0 where they are never of the floor");
  table.real("interval_s", interval_s, Range::positive(), "s",
             "between pictures that do not say when they were taken");
  table.real_or_off("camera.focal_px", focal_px, Range::positive(), "pixels", "focal length");
  table.real_or_off("camera.field_of_view_rad", field_of_view_rad, Range{0.0, 3.0, true}, "rad",
                    "or the angle that the picture's width covers");
  table.real_or_off("camera.focal_y_px", focal_y_px, Range::positive(), "pixels",
                    "focal length along v; off: that along u");
  table.real_or_off("camera.cx", cx, Range::any(), "pixels", "off: the middle of the picture");
  table.real_or_off("camera.cy", cy, Range::any(), "pixels", "off: the middle of the picture");
  describe_distortion(table, "camera.", distortion_model, distortion);
  table.real("camera.mount_x_m", mount_x_m, Range::any(), "m", "camera ahead of the body's origin");
  table.real("camera.mount_y_m", mount_y_m, Range::any(), "m", "and to port of it");
  table.real("camera.mount_yaw_rad", mount_yaw_rad, Range::any(), "rad",
             "counter-clockwise from above; 0: the top of the picture looks forward");
  table.boolean("camera.mirrored", is_mirrored, "left and right are exchanged in the pictures");
}

}  // namespace fathom
