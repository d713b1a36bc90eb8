// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "compose/gbuffer.h"
#include "lambent/renderer.h"
#include "lambent/rsm.h"
#include "support/field_scenes.h"

namespace lambent::frame_rows_test {
namespace {

// Rows of a frame are cut into pieces that neither divide its height nor are alike.
constexpr int kWidth = 37, kHeight = 29;
constexpr int kPieces[] = {1, 12, 5, 11};

class FrameRows : public ::testing::Test {
 protected:
  explicit FrameRows(const char* scene = "cornell-spot")
      : stage(scene), field(test::make_field(stage, settings(), 1)) {
    frame.width = kWidth;
    frame.height = kHeight;
    frame.samples = 2;
    sources.field = &field;
  }

  static FieldSettings settings() {
    FieldSettings settings;
    settings.probe_count = glm::ivec3(3);
    settings.rays_per_probe = 32;
    return settings;
  }

  /// The picture put together from pieces has the same bits in all layers.
  void expect_same_bits() const {
    const Camera& camera = stage.scene.cameras.at(0);
    Renderer renderer(stage.world, sources);
    const RenderedFrame whole = renderer.render(camera, frame).value();
    FrameSettings piece = frame;
    std::uint64_t rays = 0;
    for (const int rows : kPieces) {
      piece.rows = rows;
      const RenderedFrame part = renderer.render(camera, piece).value();
      rays += part.rays;
      ASSERT_EQ(part.image.height, rows);
      ASSERT_EQ(part.image.layers.size(), whole.image.layers.size());
      for (const Layer& layer : part.image.layers) {
        const Image& all = *whole.image.find(layer.name);
        const float* expected = all.at(0, piece.first_row);
        EXPECT_TRUE(std::equal(layer.image.pixels.begin(), layer.image.pixels.end(), expected))
            << "layer " << layer.name << ", row " << piece.first_row;
      }
      piece.first_row += rows;
    }
    ASSERT_EQ(piece.first_row, kHeight);
    check_rays(rays, whole.rays);
  }

  /// Pieces together trace the rays of the whole.
  virtual void check_rays(std::uint64_t of_pieces, std::uint64_t of_whole) const {
    EXPECT_EQ(of_pieces, of_whole);
  }

  test::Stage stage;
  IrradianceField field;
  IndirectSources sources;
  FrameSettings frame;
};

TEST_F(FrameRows, AreThoseOfTheWholeWhereTheFieldIsLookedUp) {
  expect_same_bits();
}

TEST_F(FrameRows, AreThoseOfTheWholeWhereLightIsGathered) {
  frame.gather_rays = 4;
  expect_same_bits();
}

/// Coats take rays of the rows above and below a piece, which are seen and traced for each anew.
class FrameRowsOfCoats : public FrameRows {
 protected:
  FrameRowsOfCoats() : FrameRows("spheres") {}
  void check_rays(std::uint64_t of_pieces, std::uint64_t of_whole) const override {
    EXPECT_GT(of_pieces, of_whole);
  }
};

TEST_F(FrameRowsOfCoats, AreThoseOfTheWholeWhereReflectionsAreTraced) {
  for (const int rows : {1, 2, 3}) {
    frame.glossy_rows = rows;
    expect_same_bits();
  }
}

TEST_F(FrameRows, AreThoseOfTheWholeWhereLightIsFiltered) {
  // Emissive surfaces light this box, and it is higher than the filter reaches
  const test::Stage lamp("cornell");
  const IrradianceField lit = test::make_field(lamp, settings(), 1);
  FrameSettings filtered = quality_settings(Quality::interactive);
  filtered.width = 16;
  filtered.height = 170;
  Renderer renderer(lamp.world, {.field = &lit});
  const Camera& camera = lamp.scene.cameras.at(0);
  const RenderedFrame whole = renderer.render(camera, filtered).value();
  for (const Band& rows : {Band{0, 40}, Band{71, 3}, Band{100, 70}}) {
    filtered.first_row = rows.first_row;
    filtered.rows = rows.rows;
    const RenderedFrame part = renderer.render(camera, filtered).value();
    for (const Layer& layer : part.image.layers) {
      const float* expected = whole.image.find(layer.name)->at(0, rows.first_row);
      EXPECT_TRUE(std::equal(layer.image.pixels.begin(), layer.image.pixels.end(), expected))
          << "layer " << layer.name << ", row " << rows.first_row;
    }
  }
}

TEST_F(FrameRows, AreThoseOfTheWholeWhereMapsLight) {
  RsmSettings maps;
  maps.resolution = 32;
  maps.texels = 64;
  sources.field = nullptr;
  sources.rsm = maps;
  expect_same_bits();
}

TEST_F(FrameRows, ThatAreLeftAreRenderedWhereNoNumberIsGiven) {
  frame.first_row = 20;
  const Camera& camera = stage.scene.cameras.at(0);
  EXPECT_EQ(Renderer(stage.world, sources).render(camera, frame).value().image.height,
            kHeight - 20);
}

}  // namespace
}  // namespace lambent::frame_rows_test
