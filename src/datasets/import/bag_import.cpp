#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <system_error>

#include "bag.hpp"
#include "bag_messages.hpp"
#include "bag_survey.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/datasets/import.hpp"
#include "frame_tree.hpp"
#include "survey_coverage.hpp"
#include "survey_writer.hpp"
#include "topic_choice.hpp"

namespace fathom {

namespace fs = std::filesystem;

namespace {

std::unique_ptr<Bag> open_bag(const fs::path& path) {
  return import_kind(path) == ImportKind::ros1_bag ? open_ros1_bag(path) : open_ros2_bag(path);
}

std::vector<std::string> topic_lines(const std::vector<BagTopic>& topics,
                                     const TopicChoice& choice) {
  std::size_t name_width = 0;
  std::size_t type_width = 0;
  for (const BagTopic& topic : topics) {
    name_width = std::max(name_width, topic.name.size());
    type_width = std::max(type_width, topic.type.size());
  }
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < topics.size(); ++i) {
    std::string name = topics[i].name;
    std::string type = topics[i].type;
    name.resize(name_width, ' ');
    type.resize(type_width, ' ');
    const std::string use = choice.use_of(i);
    lines.push_back(fmt::format("{}  {}  {}{}", name, type, topics[i].messages,
                                use.empty() ? "" : "  --" + use));
  }
  return lines;
}

}  // namespace

std::vector<std::string> bag_topic_list(const fs::path& path, const BagImportOptions& options) {
  const auto bag = open_bag(path);
  TopicChoice choice;
  std::string why;
  try {
    choice = choose_topics(bag->topics(), options, path.string());
  } catch (const InputError& error) {
    // The list is there to find what is to be said.
    why = error.what();
  }
  std::vector<std::string> lines = topic_lines(bag->topics(), choice);
  std::ranges::copy(choice.notes, std::back_inserter(lines));
  std::ranges::copy(bag->notes(), std::back_inserter(lines));
  if (!why.empty()) lines.push_back("not yet to be imported: " + why);
  return lines;
}

ImportReport import_bag(const fs::path& path, const BagImportOptions& options,
                        const fs::path& folder,
                        const std::function<void(std::size_t, std::size_t)>& progress) {
  const auto bag = open_bag(path);
  const std::vector<BagTopic>& topics = bag->topics();
  TopicChoice choice = choose_topics(topics, options, path.string());
  choice.transforms = transform_topics(topics, options);
  const fs::path mav0 = folder / "mav0";
  const fs::path pictures = mav0 / "cam0" / "data";
  std::error_code error;
  fs::create_directories(pictures, error);
  if (error) throw InputError(pictures.string(), "cannot be made: " + error.message());
  std::size_t messages = 0;
  for (const std::size_t topic : choice.all()) messages += topics[topic].messages;
  BagSurvey survey(topics, choice, options, pictures);
  std::size_t done = 0;
  bag->read(choice.all(), [&](const BagMessage& message) {
    survey.take(message);
    if (progress) progress(++done, messages);
  });
  survey.finish();
  const std::vector<NeededTimes> needed = needed_times(survey, choice, topics);
  check_spans(survey.pictures, topics[*choice.images].name, needed);
  const std::size_t left_out = leave_out_uncovered(survey.pictures, pictures, needed);
  ImportReport report = write_survey(survey, topics, choice, options, mav0);
  const std::vector<std::string> lines = topic_lines(topics, choice);
  report.facts.insert(report.facts.begin(), lines.begin(), lines.end());
  std::ranges::copy(choice.notes, std::back_inserter(report.notes));
  std::ranges::copy(bag->notes(), std::back_inserter(report.notes));
  if (left_out > 0) {
    report.notes.push_back(
        fmt::format("{} of the pictures left out: not between two {} at most 2 s apart", left_out,
                    choice.odometry ? "altitudes and two poses of odometry" : "altitudes"));
  }
  return report;
}

}  // namespace fathom
