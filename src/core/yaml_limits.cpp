// A text of some hundred bytes can name itself as often as there is memory for: it is counted by
// the parser's events before a node of it is made.

#include "fathom/core/yaml_limits.hpp"

#include <algorithm>
#include <sstream>
#include <vector>

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include "fathom/core/input_error.hpp"

namespace fathom {
namespace {

/// What a node and all in it add up to.
struct YamlExtent {
  std::size_t nodes = 0;
  std::size_t bytes = 0;   ///< of scalars
  std::size_t height = 0;  ///< maps and lists in each other
};

class YamlCounter : public YAML::EventHandler {
 public:
  void OnDocumentStart(const YAML::Mark& mark) override {
    // Of some texts, as "&x ,", the parser makes empty documents without an end, all at one place.
    if (mark.pos == last_document_) {
      throw YamlExcess{line_of(mark),
                       "is no YAML from here on; expected a value, in quotes where it is a text"};
    }
    last_document_ = mark.pos;
    anchored_.clear();
  }
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    add(mark, {1, 0, 0}, anchor);
  }
  void OnScalar(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t anchor,
                const std::string& value) override {
    add(mark, {1, value.size(), 0}, anchor);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto& named = anchored_[anchor];
    if (!named) {
      throw YamlExcess{line_of(mark),
                       "is nested too deeply, or in itself; an alias stands inside "
                       "of what it names"};
    }
    add(mark, *named, 0);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value /*style*/) override {
    open(mark, anchor);
  }
  void OnMapStart(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value /*style*/) override {
    open(mark, anchor);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapEnd() override { close(); }

 private:
  /// A list or a map whose end has not come.
  struct Open {
    YamlExtent before;  ///< of all up to it
    std::size_t height = 1;
    YAML::anchor_t anchor = 0;
  };

  static std::size_t line_of(const YAML::Mark& mark) {
    return static_cast<std::size_t>(mark.line) + 1;
  }

  void open(const YAML::Mark& mark, YAML::anchor_t anchor) {
    open_.push_back({total_, 1, anchor});
    keep(anchor, std::nullopt);
    add(mark, {1, 0, 0}, 0);
  }

  void close() {
    const Open closed = open_.back();
    open_.pop_back();
    raise(closed.height);
    keep(closed.anchor, YamlExtent{total_.nodes - closed.before.nodes,
                                   total_.bytes - closed.before.bytes, closed.height});
  }

  void add(const YAML::Mark& mark, const YamlExtent& extent, YAML::anchor_t anchor) {
    total_.nodes += extent.nodes;
    total_.bytes += extent.bytes;
    raise(extent.height);
    const auto refuse = [&mark](const char* what, std::size_t most) {
      throw YamlExcess{line_of(mark), what + std::to_string(most)};
    };
    if (open_.size() + extent.height > kDeepestYaml) {
      refuse("is nested too deeply, or in itself; the limit of lists and maps in each other is ",
             kDeepestYaml);
    }
    if (total_.nodes > kMostYamlNodes) {
      refuse("has too many keys and values, aliases counted as what they repeat; the limit is ",
             kMostYamlNodes);
    }
    if (total_.bytes > kMostYamlBytes) {
      refuse("has too many bytes, aliases counted as what they repeat; the limit is ",
             kMostYamlBytes);
    }
    keep(anchor, extent);
  }

  void raise(std::size_t height) {
    if (!open_.empty()) open_.back().height = std::max(open_.back().height, height + 1);
  }

  // Anchors are numbered from 1 in each document; 0 is none.
  void keep(YAML::anchor_t anchor, const std::optional<YamlExtent>& extent) {
    if (anchor >= anchored_.size()) anchored_.resize(anchor + 1);
    anchored_[anchor] = extent;
  }

  int last_document_ = -1;  ///< where it began
  YamlExtent total_;
  std::vector<Open> open_;
  std::vector<std::optional<YamlExtent>> anchored_;  ///< nothing of one that is open
};

}  // namespace

std::optional<YamlExcess> yaml_excess(const std::string& text) {
  if (text.size() > kMostYamlBytes) {
    return YamlExcess{1, "has " + std::to_string(text.size()) + " bytes; the limit is " +
                             std::to_string(kMostYamlBytes)};
  }
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    YamlCounter counter;
    while (parser.HandleNextDocument(counter)) {
    }
  } catch (const YamlExcess& excess) {
    return excess;
  } catch (const YAML::Exception&) {
    return std::nullopt;
  }
  return std::nullopt;
}

void require_yaml_within_limits(const std::string& text, const std::string& file) {
  if (const auto excess = yaml_excess(text)) throw InputError(file, excess->line, excess->what);
}

}  // namespace fathom
