// SPDX-License-Identifier: Apache-2.0
#include "lambent/words.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace lambent::cli::words_test {
namespace {

TEST(Words, BytesHaveTheUnitThatKeepsThemShort) {
  EXPECT_EQ(bytes_text(0), "0 bytes");
  EXPECT_EQ(bytes_text(999), "999 bytes");
  EXPECT_EQ(bytes_text(1000), "1.0 kB");
  EXPECT_EQ(bytes_text(1'340'000), "1.3 MB");
  EXPECT_EQ(bytes_text(999'960), "1.0 MB");  // not 1000.0 kB
  EXPECT_EQ(bytes_text(5e9), "5.0 GB");
  EXPECT_EQ(bytes_text(5e15), "5000.0 TB");
}

TEST(Words, ObjectsAreFoundByNameByIndexAndWhateverTheCase) {
  const std::vector<std::string> names = {"Kitchen", "hall", "Hall", "1", "Attic"};
  EXPECT_EQ(index_of("Hall", names), 2u);
  EXPECT_EQ(index_of("1", names), 3u);  // a name before an index
  EXPECT_EQ(index_of("0", names), 0u);
  EXPECT_EQ(index_of("kitchen", names), 0u);
  EXPECT_EQ(index_of("HALL", names), std::nullopt);  // two may be meant
  EXPECT_EQ(index_of("5", names), std::nullopt);
  EXPECT_EQ(index_of("0x", names), std::nullopt);
  EXPECT_EQ(index_of("", names), std::nullopt);
}

TEST(Words, SecondsHaveDigitsThatMatter) {
  EXPECT_EQ(seconds_text(0.4249), "0.42 s");
  EXPECT_EQ(seconds_text(12.34), "12.3 s");
  EXPECT_EQ(seconds_text(59.96), "1 min 00 s");  // not 60.0 s
  EXPECT_EQ(seconds_text(185.2), "3 min 05 s");
  EXPECT_EQ(whole_seconds_text(45.4), "45 s");
  EXPECT_EQ(whole_seconds_text(7800), "2 h 10 min");
  EXPECT_EQ(whole_seconds_text(3599.6), "1 h 00 min");
  EXPECT_EQ(whole_seconds_text(-1), "0 s");
}

TEST(Words, CountsAndLists) {
  EXPECT_EQ(count_text(1, "camera"), "1 camera");
  EXPECT_EQ(count_text(0, "camera"), "0 cameras");
  EXPECT_EQ(list_text({}), "");
  EXPECT_EQ(list_text({"a"}), "a");
  EXPECT_EQ(list_text({"a", "b"}), "a or b");
  EXPECT_EQ(list_text({"a", "b", "c"}, "and"), "a, b and c");
}

TEST(Words, ExposureHasItsSign) {
  EXPECT_EQ(exposure_text(1.5f), "exposure +1.50 stops");
  EXPECT_EQ(exposure_text(-0.25f), "exposure -0.25 stops");
}

TEST(Words, WhatIsNotThereIsAnsweredWithWhatIs) {
  EXPECT_EQ(no_such("camera", "9", {}), "no camera '9'; the scene has none");
  EXPECT_EQ(no_such("camera", "9", {"front"}), "no camera '9'; the scene has 1 camera: 0 'front'");
  EXPECT_EQ(no_such("camera", "hal", {"door", "hall"}),
            "no camera 'hal'; the scene has 2 cameras: 0 'door', 1 'hall'; did you mean 'hall'?");
  const std::string many = no_such("light", "x", std::vector<std::string>(1000, "lamp"));
  EXPECT_LT(many.size(), 300u);
  EXPECT_EQ(no_such("camera", "a", {"\x1b[31m"}).find('\x1b'), std::string::npos);
}

}  // namespace
}  // namespace lambent::cli::words_test
