#pragma once

#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "src/report/figure_file.hpp"

namespace fathom::test {

/// All texts that a drawing places on its page.
inline std::vector<PlacedText> texts_of(const PageSize& page,
                                        const std::function<void(Canvas&)>& draw) {
  std::vector<PlacedText> texts;
  render_figure(FigureFormat::svg, page, [&](Canvas& canvas) {
    draw(canvas);
    texts = canvas.texts();
  });
  return texts;
}

/// No text leaves the page or touches another one.
inline void expect_tidy(const std::vector<PlacedText>& texts, const PageSize& page) {
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const Box& box = texts[i].box;
    EXPECT_GE(box.left, 0.0) << texts[i].text;
    EXPECT_GE(box.top, 0.0) << texts[i].text;
    EXPECT_LE(box.right(), page.width) << texts[i].text;
    EXPECT_LE(box.bottom(), page.height) << texts[i].text;
    for (std::size_t k = i + 1; k < texts.size(); ++k) {
      EXPECT_FALSE(overlap(box, texts[k].box)) << texts[i].text << " and " << texts[k].text;
    }
  }
}

}  // namespace fathom::test
