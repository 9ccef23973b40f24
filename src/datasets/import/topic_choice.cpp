#include "topic_choice.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <functional>

#include "bag_messages.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/options.hpp"
#include "fathom/core/text.hpp"
#include "topic_words.hpp"

namespace fathom {
namespace {

using Topics = std::vector<std::size_t>;

std::string parent_of(const std::string& name) {
  return name.substr(0, name.rfind('/'));
}

class Chooser {
 public:
  Chooser(const std::vector<BagTopic>& topics, const BagImportOptions& options, std::string file)
      : topics_(topics), options_(options), file_(std::move(file)) {}

  TopicChoice choose() {
    choice_.images =
        required("images", options_.images, image_types(), [this] { return image_guess(); });
    if (options_.camera_yaml.empty()) choose_camera_info();
    if (!options_.altitude_m) choose_altitude();
    choice_.odometry = chosen("odometry", options_.odometry, pose_types(), [this] {
      return without(of_types({"nav_msgs/Odometry"}), truth_words());
    });
    choice_.reference = optional("reference", options_.reference, pose_types(), [this] {
      const Topics poses = of_types(pose_types());
      const Topics named = with(poses, truth_words());
      return named.empty() ? of_types({"geometry_msgs/PoseStamped"}) : named;
    });
    choice_.heading = optional("heading", options_.heading, {"sensor_msgs/Imu"},
                               [this] { return of_types({"sensor_msgs/Imu"}); });
    // An Imu that has the heading has roll and pitch too.
    choice_.is_attitude_needed = !options_.attitude.empty() && options_.attitude != "none";
    choice_.attitude = options_.attitude.empty()
                           ? choice_.heading
                           : chosen("attitude", options_.attitude, {"sensor_msgs/Imu"}, {});
    return choice_;
  }

 private:
  using Guess = std::function<Topics()>;

  static const Words& image_types() {
    static const Words types{"sensor_msgs/Image", "sensor_msgs/CompressedImage"};
    return types;
  }
  static const Words& pose_types() {
    static const Words types{"nav_msgs/Odometry", "geometry_msgs/PoseStamped",
                             "geometry_msgs/PoseWithCovarianceStamped"};
    return types;
  }
  static const Words& altitude_types() {
    static const Words types{"sensor_msgs/Range", "geometry_msgs/PointStamped", "std_msgs/Float64",
                             "std_msgs/Float32"};
    return types;
  }

  Topics of_types(const Words& types) const {
    Topics found;
    for (std::size_t i = 0; i < topics_.size(); ++i) {
      if (topics_[i].messages > 0 && std::ranges::count(types, topics_[i].type) > 0) {
        found.push_back(i);
      }
    }
    return found;
  }
  Topics filtered(const Topics& of, const Words& words, bool keep) const {
    Topics found;
    for (const std::size_t i : of) {
      if (has_word(topics_[i].name, words) == keep) found.push_back(i);
    }
    return found;
  }
  Topics with(const Topics& of, const Words& words) const { return filtered(of, words, true); }
  Topics without(const Topics& of, const Words& words) const { return filtered(of, words, false); }

  // Pictures as they are before those compressed from them; depth is no picture.
  Topics image_guess() const {
    const Words no_pictures{"depth*", "mask*", "theora*", "disparity*"};
    const Topics raw = without(of_types({"sensor_msgs/Image"}), no_pictures);
    return raw.empty() ? without(of_types({"sensor_msgs/CompressedImage"}), no_pictures) : raw;
  }

  void choose_camera_info() {
    const Guess guess = [this] {
      const Topics all = of_types({"sensor_msgs/CameraInfo"});
      std::string camera = topics_[*choice_.images].name;
      // Of /camera/image_raw/compressed it is /camera/camera_info.
      for (int level = 0; level < 2; ++level) {
        camera = parent_of(camera);
        for (const std::size_t i : all) {
          if (topics_[i].name == camera + "/camera_info") return Topics{i};
        }
      }
      return all;
    };
    choice_.camera_info =
        chosen("camera-info", options_.camera_info, {"sensor_msgs/CameraInfo"}, guess);
    if (!choice_.camera_info) {
      throw InputError(file_,
                       "has no sensor_msgs/CameraInfo; --camera FILE takes a sensor.yaml in its "
                       "place (docs/formats.md)");
    }
  }

  void choose_altitude() {
    choice_.altitude = chosen("altitude", options_.altitude, altitude_types(), [this] {
      const Topics ranges = of_types({"sensor_msgs/Range"});
      const Topics named = with(of_types(altitude_types()), altitude_words());
      if (ranges.size() == 1) return ranges;
      const Topics altimeters = with(named, altimeter_words());
      return altimeters.size() == 1 ? altimeters : named;
    });
    if (!choice_.altitude) {
      throw InputError(file_,
                       "has no altitude that could be guessed; --altitude TOPIC names a Range, "
                       "PointStamped, Float64 or Float32, --altitude-m M is one for all pictures");
    }
  }

  std::string names_of(const Topics& some) const {
    Words names;
    for (const std::size_t i : some) names.push_back(topics_[i].name);
    return joined(names, ", ");
  }

  std::size_t named(const std::string& flag, const std::string& name, const Words& types) const {
    Words names;
    for (std::size_t i = 0; i < topics_.size(); ++i) {
      names.push_back(topics_[i].name);
      if (topics_[i].name != name) continue;
      if (std::ranges::count(types, topics_[i].type) == 0) {
        throw InputError(file_, fmt::format("topic {} is of type {}; --{} takes {}", name,
                                            topics_[i].type, flag, joined(types, ", ")));
      }
      if (topics_[i].messages == 0) throw InputError(file_, "topic " + name + " has no messages");
      return i;
    }
    throw InputError(file_, fmt::format("has no topic {}{}; it has {}", in_quotes(name),
                                        suggestion(name, names), joined(names, ", ")));
  }

  // Of another definition a message would be read wrongly.
  std::size_t checked(std::size_t topic) const {
    const auto known = known_md5(topics_[topic].type);
    if (known && !topics_[topic].md5.empty() && topics_[topic].md5 != "*" &&
        topics_[topic].md5 != *known) {
      throw InputError(file_, "topic " + topics_[topic].name + ": its " + topics_[topic].type +
                                  " has another definition (MD5 " + topics_[topic].md5 +
                                  ") than the one that is read (" + std::string(*known) + ")");
    }
    return topic;
  }

  std::optional<std::size_t> chosen(const std::string& flag, const std::string& given,
                                    const Words& types, const Guess& guess) {
    if (given == "none") return std::nullopt;
    if (!given.empty()) return checked(named(flag, given, types));
    const Topics found = guess();
    if (found.size() > 1) {
      throw InputError(file_, "several topics could be the " + flag + ": " + names_of(found) +
                                  "; say which by --" + flag + " TOPIC");
    }
    if (found.empty()) return std::nullopt;
    return checked(found.front());
  }

  std::size_t required(const std::string& flag, const std::string& given, const Words& types,
                       const Guess& guess) {
    const auto topic = chosen(flag, given, types, guess);
    if (topic) return *topic;
    throw InputError(
        file_, "has no pictures: no topic of type " + joined(types, " or ") + " with messages");
  }

  // Several of them are no error, as a survey does without.
  std::optional<std::size_t> optional(const std::string& flag, const std::string& given,
                                      const Words& types, const Guess& guess) {
    Topics found = given.empty() ? guess() : Topics{};
    std::erase_if(found, [this](std::size_t topic) { return choice_.odometry == topic; });
    if (found.size() > 1) {
      choice_.notes.push_back("no " + flag + ", as several topics could be it: " + names_of(found) +
                              "; --" + flag + " TOPIC takes one");
      return std::nullopt;
    }
    return chosen(flag, given, types, [&found] { return found; });
  }

  const std::vector<BagTopic>& topics_;
  const BagImportOptions& options_;
  std::string file_;
  TopicChoice choice_;
};

}  // namespace

std::vector<std::size_t> TopicChoice::all() const {
  std::vector<std::size_t> taken;
  for (const auto& topic :
       {images, camera_info, altitude, odometry, reference, heading, attitude}) {
    if (topic && std::ranges::count(taken, *topic) == 0) taken.push_back(*topic);
  }
  taken.insert(taken.end(), transforms.begin(), transforms.end());
  return taken;
}

std::string TopicChoice::use_of(std::size_t topic) const {
  if (images == topic) return "images";
  if (camera_info == topic) return "camera-info";
  if (altitude == topic) return "altitude";
  if (odometry == topic) return "odometry";
  if (reference == topic) return "reference";
  if (heading == topic) return attitude == topic ? "heading --attitude" : "heading";
  if (attitude == topic) return "attitude";
  return "";
}

TopicChoice choose_topics(const std::vector<BagTopic>& topics, const BagImportOptions& options,
                          const std::string& file) {
  return Chooser(topics, options, file).choose();
}

}  // namespace fathom
