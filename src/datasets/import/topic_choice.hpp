#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "bag.hpp"
#include "fathom/datasets/import.hpp"

namespace fathom {

/// Which topics of a bag are imported, as indices among its topics.
struct TopicChoice {
  std::optional<std::size_t> images;
  std::optional<std::size_t> camera_info;
  std::optional<std::size_t> altitude;
  std::optional<std::size_t> odometry;
  std::optional<std::size_t> reference;
  std::optional<std::size_t> heading;
  std::optional<std::size_t> attitude;
  std::vector<std::size_t> transforms;  ///< of tf: where the camera is in the body
  /// The attitude was asked for: pictures without it are left out. One that is the heading's topic
  /// for want of a word is left out itself where it does not cover all.
  bool is_attitude_needed = false;
  std::vector<std::string> notes;  ///< what was guessed or left out, and why

  std::vector<std::size_t> all() const;
  /// "images", "altitude", …; empty for a topic that is not taken.
  std::string use_of(std::size_t topic) const;
};

/// The topics that the options name; the others by their types and, where several would do, by
/// their names (docs/import.md). Throws InputError where a named topic is missing, empty or of a
/// type that is not read, and, but for the reference, the heading and the attitude, where a guess
/// would be arbitrary. `file` is for messages.
TopicChoice choose_topics(const std::vector<BagTopic>& topics, const BagImportOptions& options,
                          const std::string& file);

}  // namespace fathom
