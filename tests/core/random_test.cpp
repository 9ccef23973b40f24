#include "fathom/core/random.hpp"

#include <cmath>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace fathom {
namespace {

// Numbers of a second implementation (Python 3.11: SplitMix64's finaliser over the name's bytes,
// the 64-bit Mersenne Twister from its paper, Box and Muller). They must never change: results of
// published studies hang on them.
TEST(RandomStream, RecordedNumbers) {
  EXPECT_EQ(stream_seed(42, "odometry", 0), 10054146392955061916ULL);
  EXPECT_EQ(stream_seed(42, "odometry", 1), 10644619974036264127ULL);
  RandomStream random(42, "odometry", 0);
  EXPECT_EQ(random.uniform(), 0.56685418295034051);
  EXPECT_EQ(random.uniform(), 0.073018718936302296);
  EXPECT_EQ(random.uniform(), 0.51403993733667785);
  EXPECT_NEAR(random.normal(), 0.22032774261298024, 1e-15);
  EXPECT_NEAR(random.normal(), 0.86133140823550181, 1e-15);
  EXPECT_NEAR(random.normal(), 0.2126639557266734, 1e-15);
  EXPECT_EQ(random.index(1000), 376U);
  EXPECT_EQ(random.index(1000), 253U);
  EXPECT_EQ(random.index(1000), 955U);
}

TEST(RandomStream, SeedsDifferInEveryPart) {
  std::set<std::uint64_t> seeds;
  for (std::uint64_t base = 0; base < 20; ++base) {
    for (const char* stream : {"a", "b", "ab", "ba", "odometry", "altimeter"}) {
      for (std::uint64_t trial = 0; trial < 50; ++trial) {
        seeds.insert(stream_seed(base, stream, trial));
      }
    }
  }
  EXPECT_EQ(seeds.size(), 20U * 6U * 50U);
}

struct Moments {
  double mean = 0.0;
  double variance = 0.0;
  double skewness = 0.0;
  double kurtosis = 0.0;
};

Moments moments_of(const std::vector<double>& values) {
  const double n = static_cast<double>(values.size());
  Moments m;
  for (const double v : values) m.mean += v / n;
  for (const double v : values) m.variance += std::pow(v - m.mean, 2) / n;
  const double sigma = std::sqrt(m.variance);
  for (const double v : values) m.skewness += std::pow((v - m.mean) / sigma, 3) / n;
  for (const double v : values) m.kurtosis += std::pow((v - m.mean) / sigma, 4) / n;
  return m;
}

constexpr int kDraws = 200'000;
const double kFiveSigma = 5 / std::sqrt(double{kDraws});

TEST(RandomStream, NormalHasTheMomentsOfANormal) {
  RandomStream random(1, "normal");
  std::vector<double> values;
  for (int i = 0; i < kDraws; ++i) values.push_back(random.normal());
  const Moments m = moments_of(values);
  EXPECT_NEAR(m.mean, 0, kFiveSigma);
  EXPECT_NEAR(m.variance, 1, kFiveSigma * std::sqrt(2.0));
  EXPECT_NEAR(m.skewness, 0, kFiveSigma * std::sqrt(6.0));
  EXPECT_NEAR(m.kurtosis, 3, kFiveSigma * std::sqrt(24.0));
  // Box and Muller's pairs are independent of each other.
  double product = 0.0;
  for (std::size_t i = 1; i < values.size(); ++i) product += values[i] * values[i - 1] / kDraws;
  EXPECT_NEAR(product, 0, kFiveSigma);
}

TEST(RandomStream, UniformIsUniformAndBelowItsEnd) {
  RandomStream random(2, "uniform");
  std::vector<double> values;
  for (int i = 0; i < kDraws; ++i) {
    values.push_back(random.uniform(-2.0, 4.0));
    ASSERT_GE(values.back(), -2.0);
    ASSERT_LT(values.back(), 4.0);
  }
  const Moments m = moments_of(values);
  EXPECT_NEAR(m.mean, 1, kFiveSigma * std::sqrt(3.0));
  EXPECT_NEAR(m.variance, 3, kFiveSigma * 3);
  EXPECT_NEAR(m.kurtosis, 1.8, kFiveSigma * 5);
}

TEST(RandomStream, IndexIsUniform) {
  RandomStream random(3, "index");
  std::vector<double> counts(7, 0.0);
  for (int i = 0; i < kDraws; ++i) counts.at(random.index(7)) += 1;
  double chi2 = 0.0;
  for (const double count : counts) chi2 += std::pow(count - kDraws / 7.0, 2) / (kDraws / 7.0);
  EXPECT_LT(chi2, 22.46);  // 99.9 % of χ² with 6 degrees of freedom
  for (int i = 0; i < 100; ++i) EXPECT_EQ(random.index(1), 0U);
}

TEST(RandomStream, StreamsAndTrialsAreIndependent) {
  RandomStream streams[] = {RandomStream(4, "odometry"), RandomStream(4, "altimeter"),
                            RandomStream(4, "odometry", 1), RandomStream(5, "odometry")};
  double products[6] = {};
  for (int i = 0; i < kDraws; ++i) {
    double v[4];
    for (int s = 0; s < 4; ++s) v[s] = streams[s].normal();
    int pair = 0;
    for (int a = 0; a < 4; ++a) {
      for (int b = a + 1; b < 4; ++b) products[pair++] += v[a] * v[b] / kDraws;
    }
  }
  for (const double product : products) EXPECT_NEAR(product, 0, kFiveSigma);
}

TEST(RandomStream, SameSeedSameNumbers) {
  RandomStream a(6, "same", 3);
  RandomStream b(stream_seed(6, "same", 3));
  for (int i = 0; i < 100; ++i) EXPECT_EQ(a.normal(), b.normal());
}

}  // namespace
}  // namespace fathom
