// SPDX-License-Identifier: Apache-2.0
// Pictures through the video codec.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <utility>
#include <vector>

#include "stream/picture/h264.h"

namespace lambent::stream::picture_test {
namespace {

constexpr int kWidth = 160, kHeight = 96;
// Of 8-bit pictures at a bitrate that is generous for smooth ones [dB].
constexpr double kLeastPsnr = 36.0;

/// Smooth colours that move with time, and an edge.
Image moving_picture(int time) {
  Image image(kWidth, kHeight, 3);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      float* pixel = image.at(x, y);
      const float phase = 0.05f * static_cast<float>(x + 2 * time);
      pixel[0] = 0.5f + 0.4f * std::sin(phase);
      pixel[1] = static_cast<float>(y) / kHeight;
      pixel[2] = x >= 40 + 2 * time ? 0.8f : 0.2f;
    }
  }
  return image;
}

double psnr(const Image& a, const Image& b) {
  double squares = 0.0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const double difference = a.pixels[i] - b.pixels[i];
    squares += difference * difference;
  }
  return -10.0 * std::log10(squares / static_cast<double>(a.pixels.size()));
}

/// Each encoder that this build has and that works on this machine.
class PictureCodecs : public ::testing::TestWithParam<std::string> {
 protected:
  static PictureEncoder make_encoder(std::uint32_t bitrate) {
    return std::move(*PictureEncoder::make({kWidth, kHeight, 30.0f, bitrate, GetParam()}));
  }
};

std::vector<std::string> encoders_that_work() {
  std::vector<std::string> names = picture_encoders();
  std::erase_if(names, [](const std::string& name) { return !check_encoder(name); });
  return names;
}

INSTANTIATE_TEST_SUITE_P(Encoders, PictureCodecs, ::testing::ValuesIn(encoders_that_work()),
                         [](const auto& of) { return of.param; });

TEST(Yuv, KeepsColoursToTheirRounding) {
  for (const glm::vec3 color : {glm::vec3(0.0f), glm::vec3(1.0f), glm::vec3(1.0f, 0.0f, 0.0f),
                                glm::vec3(0.0f, 1.0f, 0.0f), glm::vec3(0.2f, 0.5f, 0.7f)}) {
    Image flat(4, 2, 3);
    for (int x = 0; x < 8; ++x) std::copy_n(&color.x, 3, flat.at(x % 4, x / 4));
    YuvPicture yuv;
    to_yuv(flat, yuv);
    const Image back = to_display(yuv);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(back.at(2, 1)[c], color[c], 0.012f) << c;
  }
}

TEST(Yuv, IsBt709InLimitedRange) {
  Image green(2, 2, 3);
  for (int i = 0; i < 4; ++i) green.at(i % 2, i / 2)[1] = 1.0f;
  YuvPicture yuv;
  to_yuv(green, yuv);
  // ITU-R BT.709-6, items 3.2 to 3.5, of pure green in 8 bits
  EXPECT_EQ(yuv.y[0], 173);
  EXPECT_EQ(yuv.cb[0], 42);
  EXPECT_EQ(yuv.cr[0], 26);
}

TEST_P(PictureCodecs, EachPictureThatGoesInComesOutAtOnce) {
  PictureEncoder encoder = make_encoder(2'000'000);
  auto decoder = PictureDecoder::make();
  ASSERT_TRUE(decoder);
  YuvPicture yuv;
  for (int time = 0; time < 20; ++time) {
    const Image image = moving_picture(time);
    to_yuv(image, yuv);
    const auto encoded = encoder.encode(yuv);
    ASSERT_TRUE(encoded);
    EXPECT_EQ(encoded->key, time == 0);
    const auto decoded = decoder->decode(encoded->bytes);
    ASSERT_TRUE(decoded) << "picture " << time << " did not come out";
    EXPECT_GT(psnr(to_display(*decoded), image), kLeastPsnr) << time;
  }
}

TEST_P(PictureCodecs, KeyPicturesCanBeAskedForAndDecodedAlone) {
  PictureEncoder encoder = make_encoder(2'000'000);
  YuvPicture yuv;
  std::vector<EncodedPicture> pictures;
  for (int time = 0; time < 5; ++time) {
    to_yuv(moving_picture(time), yuv);
    pictures.push_back(*encoder.encode(yuv, time == 3));
  }
  EXPECT_TRUE(pictures[3].key);
  auto late = PictureDecoder::make();
  ASSERT_TRUE(late);
  EXPECT_FALSE(late->decode(pictures[2].bytes)) << "it refers to pictures before";
  ASSERT_TRUE(late->decode(pictures[3].bytes));
  const auto last = late->decode(pictures[4].bytes);
  ASSERT_TRUE(last);
  EXPECT_GT(psnr(to_display(*last), moving_picture(4)), kLeastPsnr);
}

TEST_P(PictureCodecs, FollowsTheBitrateThatIsAimedAt) {
  PictureEncoder encoder = make_encoder(1'500'000);
  YuvPicture yuv;
  const auto bytes_of = [&](int first) {
    std::size_t bytes = 0;
    for (int time = first; time < first + 30; ++time) {
      Image image = moving_picture(time);
      // Noise, which takes whatever bits there are
      std::uint32_t noise = static_cast<std::uint32_t>(time);
      for (float& value : image.pixels) {
        noise = noise * 1664525u + 1013904223u;
        value += 0.2f * (static_cast<float>(noise >> 8u) / 16777216.0f - 0.5f);
      }
      to_yuv(image, yuv);
      bytes += encoder.encode(yuv)->bytes.size();
    }
    return bytes;
  };
  const std::size_t much = bytes_of(0);
  encoder.aim(30.0f, 300'000);
  bytes_of(30);  // until it has followed
  const std::size_t little = bytes_of(60);
  EXPECT_LT(little, much / 2);
}

TEST_P(PictureCodecs, RefusesSizesThatItCannotEncode) {
  EXPECT_FALSE(PictureEncoder::make({16384, 16384, 30.0f, 1'000'000, GetParam()}));
}

TEST(PictureCodecs, OneThatIsNotHereIsRefusedWithTheReason) {
  for (const std::string& name : {std::string("h264_nvenc"), std::string("no_such_codec")}) {
    const auto works = check_encoder(name);
    if (works) continue;  // somebody's machine has one
    EXPECT_NE(works.error().message().find(name), std::string::npos);
    EXPECT_GT(works.error().cause.size(), 15u) << works.error().cause;
  }
  EXPECT_FALSE(check_encoder("no_such_codec"));
  EXPECT_TRUE(check_encoder(std::string(kDefaultEncoder)));
}

TEST(PictureDecoder, RefusesWhatIsNoPicture) {
  auto decoder = PictureDecoder::make();
  ASSERT_TRUE(decoder);
  EXPECT_FALSE(decoder->decode({}));
  const std::vector<std::byte> garbage(1000, std::byte{0x5a});
  EXPECT_FALSE(decoder->decode(garbage));
}

}  // namespace
}  // namespace lambent::stream::picture_test
