// SPDX-License-Identifier: Apache-2.0
#include "core/image/codecs/row_writers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "core/files/file_bytes.h"
#include "support/temporary_directory.h"

namespace lambent::row_writers_test {
namespace {

// Neither divides the other, nor the blocks of 16 lines that OpenEXR compresses.
constexpr int kWidth = 31, kHeight = 53;
constexpr int kRowsAtOnce[] = {1, 7, 16, kHeight};

Image pattern(int channels) {
  Image image(kWidth, kHeight, channels);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    image.pixels[i] = static_cast<float>(i * 2654435761u % 1000) / 1000.0f;
  }
  return image;
}

Image rows_of(const Image& image, int first, int rows) {
  Image some(image.width, rows, image.channels);
  std::copy_n(image.at(0, first), some.pixels.size(), some.pixels.begin());
  return some;
}

std::vector<std::byte> content(const std::string& path) {
  const auto bytes = read_file(path);
  EXPECT_TRUE(bytes) << path;
  return bytes.value_or(std::vector<std::byte>());
}

TEST(ExrWriter, MakesTheSameBytesOfAnyRowsAtATime) {
  const test::TemporaryDirectory directory;
  const LayeredImage image{kWidth, kHeight, {{"", pattern(3)}, {"depth", pattern(1)}}};
  ASSERT_TRUE(write_exr(directory.file("whole.exr"), image));
  for (const int at_once : kRowsAtOnce) {
    auto writer = ExrWriter::open(directory.file("rows.exr"), image, kHeight);
    ASSERT_TRUE(writer) << writer.error().message();
    for (int y = 0; y < kHeight; y += at_once) {
      const int rows = std::min(at_once, kHeight - y);
      LayeredImage some{kWidth, rows, {}};
      for (const Layer& layer : image.layers) {
        some.layers.push_back({layer.name, rows_of(layer.image, y, rows)});
      }
      ASSERT_TRUE(writer->write(some));
    }
    ASSERT_TRUE(writer->finish());
    EXPECT_EQ(content(directory.file("rows.exr")), content(directory.file("whole.exr"))) << at_once;
  }
}

TEST(PngWriter, MakesTheSameBytesOfAnyRowsAtATime) {
  const test::TemporaryDirectory directory;
  for (const int channels : {1, 3, 4}) {
    const Image image = pattern(channels);
    ASSERT_TRUE(write_png(directory.file("whole.png"), image));
    for (const int at_once : kRowsAtOnce) {
      auto writer = PngWriter::open(directory.file("rows.png"), kWidth, kHeight, channels);
      ASSERT_TRUE(writer) << writer.error().message();
      for (int y = 0; y < kHeight; y += at_once) {
        ASSERT_TRUE(writer->write(rows_of(image, y, std::min(at_once, kHeight - y))));
      }
      ASSERT_TRUE(writer->finish());
      EXPECT_EQ(content(directory.file("rows.png")), content(directory.file("whole.png")));
    }
  }
}

TEST(RowWriters, LeaveNothingOfAPictureThatWasNotFinished) {
  const test::TemporaryDirectory directory;
  const LayeredImage image{kWidth, kHeight, {{"", pattern(3)}}};
  {
    auto exr = ExrWriter::open(directory.file("a.exr"), image, 2 * kHeight);
    ASSERT_TRUE(exr);
    ASSERT_TRUE(exr->write(image));
    auto png = PngWriter::open(directory.file("a.png"), kWidth, 2 * kHeight, 3);
    ASSERT_TRUE(png);
    ASSERT_TRUE(png->write(image.layers[0].image));
  }
  EXPECT_EQ(directory.entries(), 0u);
}

TEST(RowWriters, TellOfAFullDisk) {
  const LayeredImage image{kWidth, kHeight, {{"", pattern(3)}}};
  for (const auto& written :
       {write_exr("/dev/full", image), write_png("/dev/full", image.layers[0].image)}) {
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().kind, Error::Kind::failed);
    EXPECT_EQ(written.error().message(), "/dev/full: cannot write: No space left on device");
  }
}

}  // namespace
}  // namespace lambent::row_writers_test
