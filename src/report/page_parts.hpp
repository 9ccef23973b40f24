#pragma once

#include <string_view>

namespace fathom {

// The parts of the page, embedded at build time from page/ and Vega (cmake/EmbedPage.cmake).
extern const std::string_view
    kPageTemplate;  ///< with @title@, @style@, @data@, @mosaics@ and so on
extern const std::string_view kPageStyle;
extern const std::string_view kPageSpecs;    ///< JSON: chart specifications of Vega by name
extern const std::string_view kPageScripts;  ///< script elements, Vega's first

}  // namespace fathom
