#include <algorithm>
#include <limits>
#include <map>

#include "mcap_records.hpp"
#include "ros2_file.hpp"

namespace fathom {
namespace {

class McapFile : public Ros2File {
 public:
  explicit McapFile(std::filesystem::path path) : path_(std::move(path)) {
    std::map<std::uint16_t, std::string> types;
    read_mcap_records(path_, true, [&](McapKind kind, McapFields fields) {
      const auto id = fields.number<std::uint16_t>();
      if (kind == McapKind::schema) {
        const std::string type = fields.text();
        require_same(types.emplace(id, type).first->second == type, fields.place());
      } else if (kind == McapKind::channel) {
        take_channel(id, fields, types);
      } else {
        const auto channel = channels_.find(id);
        if (channel == channels_.end()) fields.place().refuse("message", "it is of no channel");
        ++channel->second.messages;
      }
    });
  }

  std::vector<Ros2Topic> topics() const override {
    std::vector<Ros2Topic> found;
    for (const auto& [id, topic] : channels_) found.push_back(topic);
    return found;
  }

  void read(const std::set<std::string>& topics, const Take& take) const override {
    read_mcap_records(path_, false, [&](McapKind kind, McapFields fields) {
      if (kind != McapKind::message) return;
      const auto channel = channels_.find(fields.number<std::uint16_t>());
      if (channel == channels_.end() || !topics.contains(channel->second.name)) return;
      fields.number<std::uint32_t>();  // its number in the channel
      // What no clock says is beyond the limit of what is imported.
      const std::uint64_t most = std::numeric_limits<std::int64_t>::max();
      const std::uint64_t recorded_ns = std::min(fields.number<std::uint64_t>(), most);
      fields.number<std::uint64_t>();  // when it was published
      take(channel->second.name, static_cast<std::int64_t>(recorded_ns), fields.rest());
    });
  }

 private:
  void take_channel(std::uint16_t id, McapFields& fields,
                    const std::map<std::uint16_t, std::string>& types) {
    // 0 is no schema.
    const auto schema = fields.number<std::uint16_t>();
    const auto type = types.find(schema);
    if (schema != 0 && type == types.end()) fields.place().refuse("channel", "it is of no schema");
    Ros2Topic topic;
    topic.name = fields.text();
    topic.type = schema == 0 ? "" : type->second;
    topic.format = fields.text();
    const Ros2Topic& known = channels_.emplace(id, topic).first->second;
    require_same(
        known.name == topic.name && known.type == topic.type && known.format == topic.format,
        fields.place());
  }

  // Every chunk repeats what its messages are of.
  static void require_same(bool is_same, const McapPlace& place) {
    if (!is_same) place.refuse("record", "it says otherwise than one before it of the same number");
  }

  std::filesystem::path path_;
  std::map<std::uint16_t, Ros2Topic> channels_;
};

}  // namespace

std::unique_ptr<Ros2File> open_mcap_file(const std::filesystem::path& path) {
  return std::make_unique<McapFile>(path);
}

}  // namespace fathom
