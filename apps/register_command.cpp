// fathom register: two pictures.

#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <limits>
#include <memory>
#include <utility>

#include "apps/command.hpp"
#include "apps/common.hpp"
#include "apps/output.hpp"
#include "apps/registration_text.hpp"
#include "fathom/configuration/study.hpp"
#include "fathom/core/files.hpp"
#include "fathom/datasets/frame_source.hpp"
#include "fathom/datasets/picture_file.hpp"
#include "fathom/front_end/pair_seed.hpp"
#include "fathom/harness/survey.hpp"
#include "fathom/report/match_picture.hpp"
#include "fathom/report/picture.hpp"
#include "fathom/vision/registration.hpp"
#include "fathom/workflow/inputs.hpp"

namespace fathom {
namespace {

struct RegisterFlags {
  CommonFlags common;
  std::string a;
  std::string b;
  std::string config;
  double altitude_a_m = 0.0;
  double altitude_b_m = 0.0;
};

cv::Mat picture_for(const Camera& camera, const std::string& path, const std::string& config) {
  cv::Mat picture = read_grey_picture(path);
  const CameraModel& model = camera.model();
  if (picture.cols != model.width || picture.rows != model.height) {
    throw InputError(
        path, fmt::format("is {} x {} pixels, the camera {} {} x {}", picture.cols, picture.rows,
                          config.empty() ? "by default, without --config," : "of --config",
                          model.width, model.height));
  }
  return picture;
}

// What the altimeter of the survey states: that of the frame whose altitude is nearest.
double stated_sigma_m(const FrameSource& survey, double altitude_m) {
  double nearest_m = std::numeric_limits<double>::infinity();
  double sigma_m = 0.0;
  for (std::size_t i = 0; i < survey.size(); ++i) {
    const FrameInfo& frame = survey.info(i);
    const double apart_m = std::abs(frame.altitude_m - altitude_m);
    if (apart_m >= nearest_m) continue;
    nearest_m = apart_m;
    sigma_m = frame.altitude_sigma_m;
  }
  return sigma_m;
}

FloorFeatures on_floor_of(const FrameSource& survey, Features features, double altitude_m) {
  FloorFeatures seen = on_floor(std::move(features), survey.camera(), altitude_m);
  seen.viewpoint.altitude_sigma_m = stated_sigma_m(survey, altitude_m);
  return seen;
}

std::vector<PixelPair> in_pixels(const std::vector<Match>& matches, const FloorFeatures& a,
                                 const FloorFeatures& b) {
  std::vector<PixelPair> pairs;
  pairs.reserve(matches.size());
  for (const Match& match : matches) {
    pairs.push_back({a.features.pixels[static_cast<std::size_t>(match.from)],
                     b.features.pixels[static_cast<std::size_t>(match.to)]});
  }
  return pairs;
}

void write_pictures(const std::filesystem::path& folder, const MatchPicture& matches,
                    const FloorPicture& a, const FloorPicture& b,
                    const Registration& registration) {
  write_file(folder / "matches_raw.png", encode_png(render_raw_matches(matches)));
  write_file(folder / "matches_accepted.png", encode_png(render_accepted_matches(matches)));
  if (!registration.found) return;
  write_file(folder / "overlay.png", encode_png(render_overlay(a, b, registration.motion)));
}

// Of a study its first cell.
Configuration configuration_of(const Settings& settings, const EstimatorRegistry& registry) {
  const ConfigurationKind kind = kind_of(settings);
  return kind == ConfigurationKind::comparison ? configure_study(settings, registry).cells.front()
                                               : configure(settings, kind, registry);
}

void register_pictures(const RegisterFlags& flags, Context& context) {
  const Settings settings = flags.common.settings(flags.config);
  const Configuration configuration = configuration_of(settings, flags.common.estimators());
  Pictures pictures(configuration);
  const Camera camera = pictures.source().camera();
  const cv::Mat a = picture_for(camera, flags.a, flags.config);
  const cv::Mat b = picture_for(camera, flags.b, flags.config);
  std::vector<std::filesystem::path> inputs = workflow::inputs_of(flags.config, settings);
  inputs.insert(inputs.end(), {flags.a, flags.b});
  StagedFolder folder(flags.common.folder_or("register"), inputs);
  const RegistrationOptions& options = configuration.front_end.registration;
  const FeatureExtractor extractor(configuration.front_end.features, options.tuning.features);
  const cv::Mat mask = pictures.mask();
  const FloorFeatures features_a =
      on_floor_of(pictures.source(), extractor.extract(a, mask), flags.altitude_a_m);
  const FloorFeatures features_b =
      on_floor_of(pictures.source(), extractor.extract(b, mask), flags.altitude_b_m);
  const Registration registration =
      register_pair(features_a, features_b, options,
                    pair_seed(static_cast<std::uint64_t>(configuration.seed), 0, 1));
  write_pictures(folder.path(),
                 {a, b, flags.a, flags.b, in_pixels(registration.putative, features_a, features_b),
                  in_pixels(registration.inliers, features_a, features_b), registration.reason},
                 {a, camera, flags.altitude_a_m}, {b, camera, flags.altitude_b_m}, registration);
  folder.commit({"overlay.png"});
  context.status = registration.found ? kDone : kFailed;
  if (flags.common.quiet) return;
  print("%s", registration_text(features_a, features_b, options, registration).c_str());
  print("\nwrote %s\n      %s\n", (folder.target() / "matches_raw.png").c_str(),
        (folder.target() / "matches_accepted.png").c_str());
  if (registration.found) print("      %s\n", (folder.target() / "overlay.png").c_str());
}

}  // namespace

void add_register(CLI::App& program, Context& context) {
  auto flags = std::make_shared<RegisterFlags>();
  Command command(
      program, "register", "Register two pictures of the floor",
      "Example: fathom register a.png b.png --config configs/quickstart.yaml --altitude-a 2 "
      "--altitude-b 2.1\nExit status 1 where the pictures do not match.");
  command.argument("a", flags->a, "Picture A");
  command.argument("b", flags->b, "Picture B");
  command.text("--config", flags->config, "FILE", "Configuration: its camera and front end");
  command
      .real("--altitude-a", flags->altitude_a_m, Range::positive(), "M",
            "Height of A over the floor (m)")
      .required();
  command
      .real("--altitude-b", flags->altitude_b_m, Range::positive(), "M",
            "Height of B over the floor (m)")
      .required();
  flags->common.add_settings_to(command, context);
  flags->common.add_out_to(command, "Output folder (default: runs/register)");
  command.on_run([flags, &context] { register_pictures(*flags, context); });
}

}  // namespace fathom
