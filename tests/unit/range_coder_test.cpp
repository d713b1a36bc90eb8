// SPDX-License-Identifier: Apache-2.0
#include "stream/coding/range_coder.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "stream/coding/bit_models.h"

namespace lambent::stream::range_coder_test {
namespace {

/// A decision and the probability of a 1 that it is coded with.
struct Decision {
  std::uint32_t probability;
  bool bit;
};

std::vector<std::byte> encode(const std::vector<Decision>& decisions) {
  RangeEncoder coder;
  for (const Decision& decision : decisions) coder.bit(decision.probability, decision.bit);
  return coder.finish();
}

void expect_round_trip(const std::vector<Decision>& decisions) {
  const std::vector<std::byte> bytes = encode(decisions);
  RangeDecoder coder(bytes);
  for (std::size_t i = 0; i < decisions.size(); ++i) {
    ASSERT_EQ(coder.bit(decisions[i].probability), decisions[i].bit) << i;
  }
  EXPECT_FALSE(coder.overrun());
  EXPECT_EQ(coder.left(), 0u);
}

TEST(RangeCoder, GivesBackDecisionsOfAllProbabilities) {
  std::mt19937 random(1);
  for (int run = 0; run < 300; ++run) {
    std::vector<Decision> decisions;
    const int count = static_cast<int>(random() % 400);
    decisions.reserve(count);
    for (int i = 0; i < count; ++i) {
      decisions.push_back({1 + static_cast<std::uint32_t>(random() % 65535), random() % 2 == 0});
    }
    expect_round_trip(decisions);
  }
}

// Zeros of a probability that leaves the range's upper end to them drive `low` up against its upper
// end, where carries run through bytes that were already set aside.
TEST(RangeCoder, CarriesThroughLongRowsOfFullBytes) {
  for (const std::uint32_t probability : {1u, 2u, 255u, 256u, 32768u, 65279u, 65535u}) {
    for (const int before : {0, 1, 2, 3, 7, 31, 100, 1000}) {
      std::vector<Decision> decisions(before, {probability, false});
      for (int i = 0; i < 40; ++i) decisions.push_back({65535u - i, i % 3 == 0});
      expect_round_trip(decisions);
    }
  }
}

TEST(RangeCoder, TakesNoBytesForNothing) {
  EXPECT_LE(encode({}).size(), 1u);
  expect_round_trip({});
}

TEST(RangeCoder, TakesAsManyBitsAsDecisionsAreWorth) {
  std::mt19937 random(2);
  std::vector<Decision> decisions;
  double bits = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const std::uint32_t probability = i % 2 == 0 ? 600 : 50000;
    const bool bit = random() % kProbabilityOne < probability;
    decisions.push_back({probability, bit});
    bits -= std::log2((bit ? probability : kProbabilityOne - probability) / 65536.0);
  }
  EXPECT_NEAR(8.0 * static_cast<double>(encode(decisions).size()), bits, 0.001 * bits + 16.0);
}

TEST(RangeCoder, KnowsBytesThatAreCutShortOrTooMany) {
  std::mt19937 random(3);
  std::vector<Decision> decisions;
  decisions.reserve(1000);
  for (int i = 0; i < 1000; ++i) decisions.push_back({20000, random() % 2 == 0});
  std::vector<std::byte> bytes = encode(decisions);
  const auto read = [&](std::span<const std::byte> from) {
    RangeDecoder coder(from);
    for (const Decision& decision : decisions) coder.bit(decision.probability);
    return std::pair(coder.overrun(), coder.left());
  };
  EXPECT_TRUE(read(std::span(bytes).first(bytes.size() / 2)).first);
  bytes.insert(bytes.end(), 5, std::byte{7});
  EXPECT_GT(read(bytes).second, 0u);
}

TEST(BitModels, LearnWhatToExpect) {
  BitModel model;
  RangeEncoder coder;
  std::mt19937 random(4);
  for (int i = 0; i < 4000; ++i) code_bit(coder, model, random() % 10 == 0);
  EXPECT_NEAR(model.slow / 65536.0, 0.1, 0.06);
  // 0.469 bits each, by entropy
  EXPECT_LT(8.0 * static_cast<double>(coder.finish().size()) / 4000.0, 0.50);
}

TEST(BitModels, MixWhatTwoExpectAndTrustTheBetterOne) {
  BitModel blind, seeing[2];
  MixWeights<2> mix;
  RangeEncoder coder;
  std::mt19937 random(5);
  for (int i = 0; i < 8000; ++i) {
    const bool bit = random() % 2 == 0;
    const bool hint = random() % 20 == 0 ? !bit : bit;
    code_mixed<RangeEncoder, 2>(coder, mix, {&blind, &seeing[hint ? 1 : 0]}, bit);
  }
  // 0.286 bits each, by entropy, where the hint is trusted, and 1 where it is not
  EXPECT_LT(8.0 * static_cast<double>(coder.finish().size()) / 8000.0, 0.32);
}

TEST(BitModels, AreReadAsTheyWereWritten) {
  std::mt19937 random(6);
  std::vector<std::uint32_t> numbers = {0, 1, 2, 3, 0x7FFFFFFEu - 1, 1u << 30u, 65535, 0};
  for (int i = 0; i < 500; ++i)
    numbers.push_back(static_cast<std::uint32_t>(random() >> (i % 31) >> 2));
  const auto code = [&](auto& coder, std::array<BitModel, 5>& models, std::array<BitModel, 3>& some,
                        MixWeights<2>& mix, bool reads) {
    for (const std::uint32_t number : numbers) {
      EXPECT_EQ(code_exp_golomb(coder, models, reads ? 0 : number), number);
      const bool bit = number % 3 == 1;
      using Coder = std::remove_reference_t<decltype(coder)>;
      EXPECT_EQ(
          (code_mixed<Coder, 2>(coder, mix, {&some[0], &some[1 + number % 2]}, !reads && bit)),
          bit);
      EXPECT_EQ(coder.bits(13, reads ? 0 : number & 0x1FFFu), number & 0x1FFFu);
    }
  };
  std::array<BitModel, 5> models, models_read;
  std::array<BitModel, 3> some, some_read;
  MixWeights<2> mix, mix_read;
  RangeEncoder writer;
  code(writer, models, some, mix, false);
  const std::vector<std::byte> bytes = writer.finish();
  RangeDecoder reader(bytes);
  code(reader, models_read, some_read, mix_read, true);
  EXPECT_EQ(models, models_read);
  EXPECT_EQ(some, some_read);
  EXPECT_EQ(mix, mix_read);
  EXPECT_FALSE(reader.overrun());
  EXPECT_EQ(reader.left(), 0u);
}

TEST(BitModels, TurnProbabilitiesIntoLogOddsAndBack) {
  for (std::uint32_t p = 64; p < kProbabilityOne - 64; p += 37) {
    const double exact = p / 65536.0;
    const double back = probability_of(log_odds_of(p)) / 65536.0;
    EXPECT_NEAR(back, exact, 0.02 * exact * (1.0 - exact) + 3e-4) << p;
  }
  for (int x = -kMaxLogOdds; x < kMaxLogOdds; ++x) {
    ASSERT_LE(probability_of(x), probability_of(x + 1)) << x;
  }
}

}  // namespace
}  // namespace lambent::stream::range_coder_test
