#include "fathom/datasets/earth_origin.hpp"

#include "fathom/core/input_error.hpp"

namespace fathom {

void EarthOriginOptions::describe(OptionTable& table) {
  table.real_or_off("latitude", latitude, Range::between(-90, 90), "deg",
                    "of keyframe 0 on Earth (WGS 84), north positive; all three keys or none");
  table.real_or_off("longitude", longitude, Range::between(-180, 180), "deg",
                    "of keyframe 0 (WGS 84), east positive");
  table.real_or_off("heading", heading, Range::between(-180, 360), "deg",
                    "of the body's x axis at keyframe 0, clockwise from true north");
}

std::optional<EarthOrigin> EarthOriginOptions::origin() const {
  if (!is_given()) return std::nullopt;
  const auto required = [](const std::optional<double>& value, const char* name) {
    if (!value) {
      throw InputError(std::string("origin.") + name +
                       ": is missing; latitude, longitude and heading of an origin go together");
    }
    return *value;
  };
  return EarthOrigin{required(latitude, "latitude"), required(longitude, "longitude"),
                     required(heading, "heading")};
}

}  // namespace fathom
