#include "report_page.hpp"

#include <array>
#include <utility>

#include "page_data.hpp"
#include "page_parts.hpp"

namespace fathom {
namespace {

// A script element ends at "</" whatever the JSON means by it; an escaped "<" means the same.
std::string within_script(std::string_view json) {
  std::string text;
  text.reserve(json.size());
  for (const char letter : json) {
    if (letter == '<') {
      text += "\\u003c";
    } else {
      text += letter;
    }
  }
  return text;
}

}  // namespace

std::string html_text(std::string_view text) {
  std::string result;
  for (const char letter : text) {
    switch (letter) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\'':
        result += "&#39;";
        break;
      default:
        result += letter;
    }
  }
  return result;
}

std::string report_page(const ResultStore& store, const ChartInput& input,
                        const nlohmann::ordered_json& mosaics, const std::string& name) {
  // Bytes that are not UTF-8 become the replacement character: a name may hold any.
  const auto text_of = [](const nlohmann::ordered_json& json) {
    return within_script(
        json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  };
  const std::string& title = input.results.study.title;
  const std::array<std::pair<std::string_view, std::string>, 6> parts{
      {{"@title@", html_text(title.empty() ? name : title)},
       {"@style@", std::string(kPageStyle)},
       {"@data@", text_of(page_data(store, input))},
       {"@mosaics@", text_of(mosaics)},
       {"@specs@", std::string(kPageSpecs)},
       {"@scripts@", std::string(kPageScripts)}}};
  std::string page;
  std::string_view rest = kPageTemplate;
  for (const auto& [place, content] : parts) {
    const std::size_t found = rest.find(place);
    page += rest.substr(0, found);
    page += content;
    rest.remove_prefix(found + place.size());
  }
  return page + std::string(rest);
}

}  // namespace fathom
