// SPDX-License-Identifier: Apache-2.0
#include "lambent/image.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <vector>

#include "core/files/atomic_file.h"
#include "core/files/file_bytes.h"
#include "core/image/codecs/formats.h"
#include "core/image/codecs/stb.h"
#include "shared/color.h"
#include "support/temporary_directory.h"

namespace lambent::image_test {
namespace {

Image ramp(int width, int height, int channels) {
  Image image(width, height, channels);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    image.pixels[i] = static_cast<float>(i * 37 % 101) / 100.0f;
  }
  return image;
}

LayeredImage layered_ramp() {
  LayeredImage image{19, 11, {}};
  for (const auto& [name, channels] :
       {std::pair{"", 3}, {"depth", 1}, {"direct", 3}, {"motion", 2}, {"painted", 4}}) {
    image.layers.push_back({name, ramp(image.width, image.height, channels)});
  }
  return image;
}

/// Every prefix of the file at `path` (in steps) must be refused with an error that names the file.
void expect_truncations_fail(const std::string& path, const std::string& cut_path) {
  const auto whole = read_file(path);
  ASSERT_TRUE(whole) << whole.error().message();
  ASSERT_TRUE(read_image(path)) << read_image(path).error().message();
  const std::size_t step = std::max<std::size_t>(1, whole->size() / 97);
  std::vector<std::size_t> lengths = {whole->size() - 1};
  for (std::size_t length = 0; length < whole->size(); length += step) lengths.push_back(length);
  for (const std::size_t length : lengths) {
    ASSERT_TRUE(write_file_atomically(cut_path, std::span(*whole).first(length)));
    const auto image = read_image(cut_path);
    ASSERT_FALSE(image) << "at " << length << " of " << whole->size();
    EXPECT_EQ(image.error().file, cut_path);
    EXPECT_FALSE(image.error().cause.empty());
  }
}

TEST(LayeredImage, RequireMakesAMissingLayerOnce) {
  LayeredImage image{4, 2, {}};
  EXPECT_EQ(image.find("direct"), nullptr);
  image.require("direct", 3).at(3, 1)[2] = 7.0f;
  EXPECT_EQ(image.require("direct", 3).at(3, 1)[2], 7.0f);
  ASSERT_EQ(image.layers.size(), 1u);
  EXPECT_EQ(image.find("direct")->pixels.size(), 24u);
}

TEST(Exr, RoundTripKeepsEveryLayerExactly) {
  const test::TemporaryDirectory directory;
  LayeredImage image = layered_ramp();
  image.find("direct")->at(2, 3)[0] = std::numeric_limits<float>::infinity();
  image.find("direct")->at(2, 3)[1] = 1e-38f;
  ASSERT_TRUE(write_exr(directory.file("a.exr"), image));
  EXPECT_EQ(directory.entries(), 1u);
  const auto read = read_image(directory.file("a.exr"));
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->layers.size(), image.layers.size());
  for (const Layer& layer : image.layers) {
    const Image* same = read->find(layer.name);
    ASSERT_NE(same, nullptr) << layer.name;
    EXPECT_EQ(same->channels, layer.image.channels);
    EXPECT_EQ(same->pixels, layer.image.pixels) << layer.name;
  }
}

TEST(Exr, ReadsHalfChannelsUnderForeignNamesAndAShiftedWindow) {
  const test::TemporaryDirectory directory;
  const std::string path = directory.file("blender.exr");
  const Imath::Box2i window({5, -3}, {8, -2});
  Imf::Header header(window, window);
  Imf::FrameBuffer frame;
  const std::vector<half> values(8, half(0.25f));
  for (const char* name : {"ViewLayer.Combined.R", "ViewLayer.Combined.G", "ViewLayer.Combined.B",
                           "ViewLayer.Depth.Z", "ViewLayer.Normal.X", "ViewLayer.Normal.Y",
                           "ViewLayer.Normal.Z", "R", "G", "B", "Z", "mask"}) {
    header.channels().insert(name, Imf::Channel(Imf::HALF));
    frame.insert(
        name, Imf::Slice::Make(Imf::HALF, values.data(), window, sizeof(half), 4 * sizeof(half)));
  }
  {
    Imf::OutputFile file(path.c_str(), header);
    file.setFrameBuffer(frame);
    file.writePixels(2);
  }
  const auto image = read_image(path);
  ASSERT_TRUE(image) << image.error().message();
  EXPECT_EQ(image->width, 4);
  EXPECT_EQ(image->height, 2);
  for (const auto& [name, channels] : {std::pair{"", 3},
                                       {"Z", 1},
                                       {"mask", 1},
                                       {"ViewLayer.Combined", 3},
                                       {"ViewLayer.Depth", 1},
                                       {"ViewLayer.Normal", 3}}) {
    ASSERT_NE(image->find(name), nullptr) << name;
    EXPECT_EQ(image->find(name)->channels, channels) << name;
    EXPECT_EQ(image->find(name)->pixels.back(), 0.25f) << name;
  }
}

TEST(Exr, TruncatedFilesAreErrors) {
  const test::TemporaryDirectory directory;
  LayeredImage image{64, 48, {{"", ramp(64, 48, 3)}}};
  ASSERT_TRUE(write_exr(directory.file("a.exr"), image));
  expect_truncations_fail(directory.file("a.exr"), directory.file("cut.exr"));
}

TEST(Exr, CorruptFilesNeverThrowOrCrash) {
  const test::TemporaryDirectory directory;
  const LayeredImage image = layered_ramp();
  ASSERT_TRUE(write_exr(directory.file("a.exr"), image));
  const auto whole = read_file(directory.file("a.exr"));
  ASSERT_TRUE(whole);
  int refused = 0;
  for (std::size_t i = 4; i < whole->size(); i += 7) {
    std::vector<std::byte> broken = *whole;
    broken[i] ^= std::byte{0xff};
    refused += decode_exr("broken.exr", broken).has_value() ? 0 : 1;
  }
  EXPECT_GT(refused, 0);
}

TEST(Exr, AbsurdSizeInATinyFileIsRefused) {
  const test::TemporaryDirectory directory;
  LayeredImage image{4, 4, {{"", ramp(4, 4, 3)}}};
  ASSERT_TRUE(write_exr(directory.file("a.exr"), image));
  auto bytes = *read_file(directory.file("a.exr"));
  const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::string attribute = std::string("dataWindow\0box2i\0", 17);
  const std::size_t window = text.find(attribute);
  ASSERT_NE(window, std::string::npos);
  const std::int32_t max_x = 60000, max_y = 2000;
  std::memcpy(bytes.data() + window + attribute.size() + 4 + 8, &max_x, 4);
  std::memcpy(bytes.data() + window + attribute.size() + 4 + 12, &max_y, 4);
  EXPECT_FALSE(decode_exr("huge.exr", bytes));
}

TEST(Exr, LayersThatDisagreeAreRefusedBeforeWriting) {
  const test::TemporaryDirectory directory;
  LayeredImage image{4, 4, {{"", ramp(4, 4, 3)}, {"direct", ramp(4, 3, 3)}}};
  const auto written = write_exr(directory.file("a.exr"), image);
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message().find("direct"), std::string::npos);
  image.layers[1] = {"", ramp(4, 4, 3)};
  EXPECT_FALSE(write_exr(directory.file("a.exr"), image));
  image.layers[1] = {"five", ramp(4, 4, 5)};
  EXPECT_FALSE(write_exr(directory.file("a.exr"), image));
  EXPECT_FALSE(write_exr(directory.file("a.exr"), LayeredImage{}));
  EXPECT_EQ(directory.entries(), 0u);
}

TEST(Png, RoundTripIsWithinHalfALevelAndDecodesToLinear) {
  const test::TemporaryDirectory directory;
  for (const int channels : {1, 3, 4}) {
    const Image encoded = ramp(13, 7, channels);
    ASSERT_TRUE(write_png(directory.file("a.png"), encoded));
    const auto read = read_image(directory.file("a.png"));
    ASSERT_TRUE(read) << read.error().message();
    const Image* image = read->find("");
    ASSERT_NE(image, nullptr);
    ASSERT_EQ(image->channels, channels);
    for (std::size_t i = 0; i < encoded.pixels.size(); ++i) {
      const bool alpha = i % channels == 3;
      const float value = alpha ? image->pixels[i] : srgb_from_linear(image->pixels[i]);
      EXPECT_NEAR(value, encoded.pixels[i], 0.5f / 255.0f + 1e-5f);
    }
  }
}

TEST(Png, ClampsAndShowsNanAsBlack) {
  const test::TemporaryDirectory directory;
  Image image(4, 1, 1);
  image.pixels = {-3.0f, 7.0f, std::nanf(""), std::numeric_limits<float>::infinity()};
  ASSERT_TRUE(write_png(directory.file("a.png"), image));
  const auto read = read_image(directory.file("a.png"));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->find("")->pixels, (std::vector<float>{0.0f, 1.0f, 0.0f, 1.0f}));
}

TEST(Png, TruncatedFilesAreErrors) {
  const test::TemporaryDirectory directory;
  ASSERT_TRUE(write_png(directory.file("a.png"), ramp(64, 48, 3)));
  expect_truncations_fail(directory.file("a.png"), directory.file("cut.png"));
}

void append(void* context, void* data, int size) {
  auto& bytes = *static_cast<std::vector<std::byte>*>(context);
  const auto* first = static_cast<const std::byte*>(data);
  bytes.insert(bytes.end(), first, first + size);
}

TEST(Jpeg, IsReadAndItsTruncationsAreErrors) {
  const test::TemporaryDirectory directory;
  const std::vector<std::uint8_t> grey(64 * 48 * 3, 128);
  std::vector<std::byte> bytes;
  ASSERT_NE(stbi_write_jpg_to_func(append, &bytes, 64, 48, 3, grey.data(), 90), 0);
  ASSERT_TRUE(write_file_atomically(directory.file("a.jpg"), bytes));
  const auto read = read_image(directory.file("a.jpg"));
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_NEAR(read->find("")->at(30, 20)[1], linear_from_srgb(128.0f / 255.0f), 0.01f);
  expect_truncations_fail(directory.file("a.jpg"), directory.file("cut.jpg"));
}

TEST(Jpeg, IsWrittenAsItIsShown) {
  const test::TemporaryDirectory directory;
  Image shown(67, 45, 3);  // no multiple of a block's 8 pixels
  for (int y = 0; y < shown.height; ++y) {
    for (int x = 0; x < shown.width; ++x) {
      float* pixel = shown.at(x, y);
      pixel[0] = static_cast<float>(x) / 66.0f;
      pixel[1] = static_cast<float>(y) / 44.0f;
      pixel[2] = x < 33 ? 0.2f : 0.8f;
    }
  }
  for (const int quality : {92, 60}) {
    ASSERT_TRUE(write_jpeg(directory.file("a.jpg"), shown, quality));
    const auto read = read_image(directory.file("a.jpg"));
    ASSERT_TRUE(read) << read.error().message();
    ASSERT_EQ(read->width, 67);
    ASSERT_EQ(read->height, 45);
    double error = 0.0;
    for (std::size_t i = 0; i < shown.pixels.size(); ++i) {
      error += std::abs(srgb_from_linear(read->layers[0].image.pixels[i]) - shown.pixels[i]);
    }
    // On average, within one and four of 256 levels
    EXPECT_LT(error / static_cast<double>(shown.pixels.size()), (quality > 90 ? 1 : 4) / 256.0);
  }
}

TEST(Jpeg, TakesGreyAndAlphaAndWhatIsNoNumber) {
  const test::TemporaryDirectory directory;
  Image grey(8, 8, 1), with_alpha(8, 8, 4);
  for (float& value : grey.pixels) value = 0.5f;
  for (float& value : with_alpha.pixels) value = std::numeric_limits<float>::quiet_NaN();
  ASSERT_TRUE(write_jpeg(directory.file("grey.jpg"), grey));
  ASSERT_TRUE(write_jpeg(directory.file("alpha.jpg"), with_alpha));
  const auto half = read_image(directory.file("grey.jpg"));
  ASSERT_TRUE(half);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(half->find("")->at(3, 3)[c], linear_from_srgb(0.5f), 0.005f);
  }
  EXPECT_NEAR(read_image(directory.file("alpha.jpg"))->find("")->at(3, 3)[0], 0.0f, 0.005f);
}

TEST(Image, PixelsThatAreMissingAreToldOf) {
  const test::TemporaryDirectory directory;
  Image image(400, 400, 3);
  image.pixels.resize(7);
  for (const bool png : {true, false}) {
    const auto written = png ? write_png(directory.file("a.png"), image)
                             : write_jpeg(directory.file("a.jpg"), image);
    ASSERT_FALSE(written);
    EXPECT_NE(written.error().message().find("7 numbers"), std::string::npos);
  }
  EXPECT_EQ(directory.entries(), 0u);
}

TEST(Jpeg, WhatNoJpegHoldsIsRefused) {
  const test::TemporaryDirectory directory;
  const std::string path = directory.file("a.jpg");
  EXPECT_FALSE(write_jpeg(path, Image(8, 8, 2)));
  EXPECT_FALSE(write_jpeg(path, Image(0, 8, 3)));
  EXPECT_FALSE(write_jpeg(path, Image(65501, 1, 3)));
  EXPECT_FALSE(write_jpeg(path, Image(8, 8, 3), 0));
  EXPECT_FALSE(write_jpeg(path, Image(8, 8, 3), 101));
  EXPECT_EQ(directory.entries(), 0u);
}

TEST(Jpeg, ImpossibleHuffmanTablesAreRefusedBeforeDecoding) {
  const std::vector<std::uint8_t> grey(16 * 16 * 3, 128);
  std::vector<std::byte> bytes;
  ASSERT_NE(stbi_write_jpg_to_func(append, &bytes, 16, 16, 3, grey.data(), 90), 0);
  ASSERT_TRUE(decode_png_or_jpeg("a.jpg", bytes));
  const std::byte marker[] = {std::byte{0xff}, std::byte{0xc4}};
  const auto table = std::search(bytes.begin(), bytes.end(), std::begin(marker), std::end(marker));
  ASSERT_NE(table, bytes.end());
  for (int length = 1; length <= 2; ++length) table[4 + length] = std::byte{0xff};
  const auto image = decode_png_or_jpeg("a.jpg", bytes);
  ASSERT_FALSE(image);
  EXPECT_EQ(image.error().cause, "cannot be decoded: impossible Huffman tables");
}

TEST(Hdr, RoundTripIsWithinTheSharedExponentAndTruncationsAreErrors) {
  const test::TemporaryDirectory directory;
  for (const int width : {5, 40}) {  // Narrow files are stored flat, wide ones run-length encoded.
    Image image = ramp(width, 9, 3);
    for (float& value : image.pixels) value *= 500.0f;
    std::vector<std::byte> bytes;
    ASSERT_NE(stbi_write_hdr_to_func(append, &bytes, width, 9, 3, image.pixels.data()), 0);
    ASSERT_TRUE(write_file_atomically(directory.file("a.hdr"), bytes));
    const auto read = read_image(directory.file("a.hdr"));
    ASSERT_TRUE(read) << read.error().message();
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        const float* expected = image.at(x, y);
        const float largest = std::max({expected[0], expected[1], expected[2]});
        for (int c = 0; c < 3; ++c) {
          EXPECT_NEAR(read->find("")->at(x, y)[c], expected[c], largest / 128.0f);
        }
      }
    }
    expect_truncations_fail(directory.file("a.hdr"), directory.file("cut.hdr"));
  }
}

TEST(ReadImage, NamesWhatIsWrongWithFilesThatAreNoImages) {
  const test::TemporaryDirectory directory;
  EXPECT_EQ(read_image(directory.file("none.exr")).error().cause, "no such file");
  ASSERT_TRUE(write_file_atomically(directory.file("text.png"), "hello"));
  EXPECT_EQ(read_image(directory.file("text.png")).error().cause,
            "not an EXR, HDR, PNG or JPEG file");
  ASSERT_TRUE(write_file_atomically(directory.file("empty.png"), ""));
  EXPECT_EQ(read_image(directory.file("empty.png")).error().cause, "the file is empty");
}

TEST(ReadImage, AbsurdSizesAreRefusedWithoutAllocating) {
  EXPECT_TRUE(check_image_size("a", 7680, 4320, 3));
  EXPECT_FALSE(check_image_size("a", 1 << 20, 1, 1));
  EXPECT_FALSE(check_image_size("a", 60000, 60000, 3));
  EXPECT_FALSE(check_image_size("a", 0, 4, 3));
  EXPECT_FALSE(check_image_size("a", -1, 4, 3));
}

TEST(ReadImage, ReadsEveryTruthImage) {
  const std::filesystem::path truth = std::filesystem::path(LAMBENT_SHARED_DIR) / "truth";
  if (!std::filesystem::exists(truth)) GTEST_SKIP() << "no truth images at " << truth;
  int count = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(truth)) {
    const auto extension = entry.path().extension();
    if (extension != ".exr" && extension != ".png") continue;
    const auto image = read_image(entry.path().string());
    ASSERT_TRUE(image) << image.error().message();
    ASSERT_NE(image->find(""), nullptr) << entry.path();
    EXPECT_GE(image->find("")->channels, 3) << entry.path();
    ++count;
  }
  EXPECT_GT(count, 0);
}

}  // namespace
}  // namespace lambent::image_test
