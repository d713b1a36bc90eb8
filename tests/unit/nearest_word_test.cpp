// SPDX-License-Identifier: Apache-2.0
#include "core/nearest_word.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace lambent::nearest_word_test {
namespace {

const std::vector<std::string> kWords = {"render", "field",     "rsm+field",
                                         "info",   "two-rooms", "two-rooms-sealed"};

TEST(EditDistance, CountsInsertionsDeletionsReplacementsAndSwaps) {
  EXPECT_EQ(edit_distance("field", "field"), 0u);
  EXPECT_EQ(edit_distance("fild", "field"), 1u);
  EXPECT_EQ(edit_distance("fieeld", "field"), 1u);
  EXPECT_EQ(edit_distance("fiend", "field"), 1u);
  EXPECT_EQ(edit_distance("feild", "field"), 1u);  // a swap is one edit, not two
  EXPECT_EQ(edit_distance("ab", "ba"), 1u);
  EXPECT_EQ(edit_distance("ca", "abc"), 3u);  // nothing is edited twice
  EXPECT_EQ(edit_distance("", "field"), 5u);
  EXPECT_EQ(edit_distance("field", ""), 5u);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
}

TEST(EditDistance, IsBlindToCapitals) {
  EXPECT_EQ(edit_distance("CORNELL.GLB", "cornell.glb"), 0u);
}

TEST(NearestWord, IsTheOneWithTheFewestEdits) {
  EXPECT_EQ(nearest_word("rendr", kWords), "render");
  EXPECT_EQ(nearest_word("feild", kWords), "field");
  EXPECT_EQ(nearest_word("Info", kWords), "info");
  EXPECT_EQ(nearest_word("two-room", kWords), "two-rooms");
}

TEST(NearestWord, IsNothingWhereAllAreFar) {
  EXPECT_EQ(nearest_word("frobnicate", kWords), std::nullopt);
  EXPECT_EQ(nearest_word("fog", kWords), std::nullopt);
  EXPECT_EQ(nearest_word("", kWords), std::nullopt);
  // Every word of one character is one edit away from every other
  EXPECT_EQ(nearest_word("x", std::vector<std::string>{"y"}), std::nullopt);
  EXPECT_EQ(nearest_word(std::string(100'000, 'x'), kWords), std::nullopt);
}

TEST(NearestWord, CompletesABeginning) {
  EXPECT_EQ(nearest_word("two", kWords), "two-rooms");
  EXPECT_EQ(nearest_word("re", kWords), std::nullopt);
}

TEST(DidYouMean, IsAQuestionOrNothing) {
  EXPECT_EQ(did_you_mean("rendr", kWords), "; did you mean 'render'?");
  EXPECT_EQ(did_you_mean("frobnicate", kWords), "");
}

}  // namespace
}  // namespace lambent::nearest_word_test
