#include "fathom/core/hash.hpp"

#include <bit>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace fathom {
namespace {

// The first numbers of SplitMix64 seeded with 0, by Vigna's reference program splitmix64.c.
TEST(Hash, MixesAsSplitMix64) {
  EXPECT_EQ(mix_bits(0), 0xe220a8397b1dcdafULL);
  EXPECT_EQ(mix_bits(0x9e3779b97f4a7c15ULL), 0x6e789e6aa1b965f4ULL);
}

TEST(Hash, TellsContentsApart) {
  const std::set<std::uint64_t> different{
      Hash().value(),
      Hash(1).value(),
      Hash().add("").value(),
      Hash().add("").add("").value(),
      Hash().add("a").value(),
      Hash().add(std::string_view("a\0", 2)).value(),
      Hash().add("ab").add("c").value(),
      Hash().add("a").add("bc").value(),
      Hash().add("abcdefgh").value(),
      Hash().add("abcdefghi").value(),
      Hash().add(0.0).value(),
      Hash().add(-0.0).value(),
      Hash().add(1.0).add(2.0).value(),
      Hash().add(2.0).add(1.0).value(),
      Hash().add(1).value(),
      Hash().add(-1).value(),
  };
  // Of a word of zeros and the number of no bytes the content is the same.
  EXPECT_EQ(different.size(), 15u);
  EXPECT_EQ(Hash().add(0.0).value(), Hash().add("").value());
}

TEST(Hash, OneBitOfALongContentChangesHalfOfItsBits) {
  std::string content(1000, 'x');
  const std::uint64_t before = Hash().add(content).value();
  int changed = 0;
  for (std::size_t i = 0; i < content.size(); ++i) {
    content[i] = 'y';
    changed += std::popcount(before ^ Hash().add(content).value());
    content[i] = 'x';
  }
  // 1000 times 64 fair coins: five standard deviations.
  EXPECT_NEAR(changed, 32'000, 5 * 126.5);
}

}  // namespace
}  // namespace fathom
