// SPDX-License-Identifier: Apache-2.0
#include "lambent/renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "support/field_scenes.h"

namespace lambent::renderer_test {
namespace {

FrameSettings size_of(int width, int height) {
  FrameSettings settings;
  settings.width = width;
  settings.height = height;
  return settings;
}

FieldSettings few_probes(int along_each_axis) {
  FieldSettings settings;
  settings.probe_count = glm::ivec3(along_each_axis);
  settings.rays_per_probe = 32;
  return settings;
}

RsmSettings small_maps() {
  RsmSettings maps;
  maps.resolution = 32;
  maps.texels = 64;
  return maps;
}

void expect_same_bits(const LayeredImage& a, const LayeredImage& b) {
  ASSERT_EQ(a.width, b.width);
  ASSERT_EQ(a.height, b.height);
  ASSERT_EQ(a.layers.size(), b.layers.size());
  for (std::size_t i = 0; i < a.layers.size(); ++i) {
    EXPECT_EQ(a.layers[i].name, b.layers[i].name);
    EXPECT_EQ(a.layers[i].image.pixels, b.layers[i].image.pixels) << a.layers[i].name;
  }
}

/// Whether maps were made for a frame.
bool made_maps(const RenderedFrame& frame) {
  return std::any_of(frame.passes.begin(), frame.passes.end(),
                     [](const PassTime& pass) { return pass.name == "rsm.gather"; });
}

class RendererTest : public ::testing::Test {
 protected:
  const Camera& camera() const { return stage.scene.cameras.at(0); }

  static Camera moved(Camera camera) {
    camera.world_from_view[3].x += 0.1f;
    return camera;
  }

  /// The part of a frame that is refused; empty: none is.
  static std::string refusal(Renderer& renderer, const Camera& camera,
                             const FrameSettings& settings) {
    const Expected<RenderedFrame> frame = renderer.render(camera, settings);
    if (frame) return "";
    EXPECT_EQ(frame.error().kind, Error::Kind::bad_input);
    EXPECT_FALSE(frame.error().cause.empty());
    return frame.error().place;
  }

  test::Stage stage{"cornell-spot"};
};

TEST_F(RendererTest, RefusesSettingsOutOfRangeByName) {
  Renderer renderer(stage.world);
  const auto refused = [&](auto edit) {
    FrameSettings settings = size_of(8, 6);
    edit(settings);
    return refusal(renderer, camera(), settings);
  };
  EXPECT_EQ(refused([](FrameSettings&) {}), "");
  EXPECT_EQ(refused([](FrameSettings& s) { s.width = 0; }), "width");
  EXPECT_EQ(refused([](FrameSettings& s) { s.width = 16385; }), "width");
  EXPECT_EQ(refused([](FrameSettings& s) { s.height = -1; }), "height");
  EXPECT_EQ(refused([](FrameSettings& s) { s.height = 16385; }), "height");
  EXPECT_EQ(refused([](FrameSettings& s) { s.first_row = -1; }), "first row");
  EXPECT_EQ(refused([](FrameSettings& s) { s.first_row = 6; }), "rows");
  EXPECT_EQ(refused([](FrameSettings& s) { s.rows = -1; }), "rows");
  EXPECT_EQ(refused([](FrameSettings& s) { s.rows = 7; }), "rows");
  EXPECT_EQ(refused([](FrameSettings& s) { s.first_row = 1, s.rows = 6; }), "rows");
  EXPECT_EQ(refused([](FrameSettings& s) { s.samples = 0; }), "samples");
  EXPECT_EQ(refused([](FrameSettings& s) { s.most_samples = -1; }), "most samples");
  EXPECT_EQ(refused([](FrameSettings& s) { s.emissive_samples = 0; }), "emissive samples");
  EXPECT_EQ(refused([](FrameSettings& s) { s.reflected_emissive_samples = 0; }),
            "reflected emissive samples");
  EXPECT_EQ(refused([](FrameSettings& s) { s.gather_rays = -1; }), "gather rays");
  EXPECT_EQ(refused([](FrameSettings& s) { s.glossy_rows = -1; }), "glossy rows");
  EXPECT_EQ(refused([](FrameSettings& s) { s.glossy_rows = 9; }), "glossy rows");
  EXPECT_EQ(renderer.frames(), 1u);
}

TEST_F(RendererTest, GuidesAreThoseOfTheirPictures) {
  const IrradianceField field = test::make_field(stage, few_probes(4));
  const auto render = [&](Renderer& renderer, const Camera& from, const FrameSettings& settings) {
    return renderer.render(from, settings).value().image;
  };
  FrameSettings guided = size_of(24, 18), unguided;
  guided.gather_rays = 8;
  unguided = guided;
  unguided.guides_gathers = false;
  FrameSettings lower = guided;
  lower.first_row = 9, lower.rows = 9;
  Renderer reused(stage.world, {.field = &field});
  const Camera other = moved(camera());
  render(reused, other, guided);
  const auto expect_as_alone = [&](const FrameSettings& settings) {
    Renderer alone(stage.world, {.field = &field});
    expect_same_bits(render(reused, camera(), settings), render(alone, camera(), settings));
  };
  expect_as_alone(unguided);  // no guide, although there is one of the picture before
  expect_as_alone(lower);     // rows of the same view, for which no guide was made
  lower.seed = 2;
  expect_as_alone(lower);
}

TEST_F(RendererTest, RefusesSourcesThatDoNotGoTogetherOrAreOutOfRange) {
  const IrradianceField field = test::make_field(stage, few_probes(2));
  const auto refused = [&](const IndirectSources& sources, const FrameSettings& settings) {
    Renderer renderer(stage.world, sources);
    return refusal(renderer, camera(), settings);
  };
  const FrameSettings whole = size_of(8, 6);
  FrameSettings gathered = whole, part = whole;
  gathered.gather_rays = 1;
  part.rows = 3;
  RsmSettings no_texels = small_maps();
  no_texels.resolution = 0;
  EXPECT_EQ(refused({.field = &field, .subtracted_field = &field}, whole), "subtracted field");
  EXPECT_EQ(refused({.subtracted_field = &field, .rsm = small_maps()}, whole), "subtracted field");
  EXPECT_EQ(refused({.rsm_stages = true}, whole), "rsm stages");
  EXPECT_EQ(refused({.rsm = small_maps(), .rsm_stages = true}, part), "rsm stages");
  EXPECT_EQ(refused({.field = &field, .rsm = small_maps()}, gathered), "gather rays");
  EXPECT_EQ(refused({.rsm = no_texels}, whole), "resolution");
  const IndirectSources all = {&field, &field, small_maps(), true};
  EXPECT_EQ(refused(all, whole), "");
}

TEST_F(RendererTest, RefusesACameraThatNoSceneMayHoldAndLeavesTheFrame) {
  Renderer renderer(stage.world);
  RenderedFrame frame;
  ASSERT_TRUE(renderer.render(camera(), size_of(8, 6), frame));
  const LayeredImage before = frame.image;
  Camera flat = camera();
  flat.vertical_fov = 0.0f;
  const Expected<void> done = renderer.render(flat, size_of(4, 4), frame);
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().place, "camera");
  expect_same_bits(frame.image, before);
}

TEST_F(RendererTest, RendersTheSameBitsWhateverItRenderedBefore) {
  const IrradianceField field = test::make_field(stage, few_probes(3));
  const IndirectSources sources[] = {
      {.field = &field}, {.rsm = small_maps(), .rsm_stages = true}, {}};
  for (const IndirectSources& lit_by : sources) {
    const LayeredImage fresh =
        Renderer(stage.world, lit_by).render(camera(), size_of(24, 16)).value().image;
    Renderer renderer(stage.world, lit_by);
    RenderedFrame frame;
    for (const int height : {12, 40, 16}) {
      ASSERT_TRUE(renderer.render(moved(camera()), size_of(24, height), frame));
    }
    const float* memory = frame.image.find("direct")->pixels.data();
    ASSERT_TRUE(renderer.render(camera(), size_of(24, 16), frame));
    expect_same_bits(frame.image, fresh);
    EXPECT_EQ(frame.image.find("direct")->pixels.data(), memory);
    EXPECT_EQ(renderer.frames(), 4u);
  }
}

TEST_F(RendererTest, RendersIntoAFrameThatHeldOtherLayers) {
  RenderedFrame frame;
  frame.image.width = 3;
  frame.image.height = 2;
  frame.image.require("direct", 1);
  frame.image.require("mine", 2);
  frame.passes = {{"mine", 1.0}};
  frame.rays = 7;
  Renderer renderer(stage.world);
  ASSERT_TRUE(renderer.render(camera(), size_of(8, 6), frame));
  const RenderedFrame fresh = renderer.render(camera(), size_of(8, 6)).value();
  expect_same_bits(frame.image, fresh.image);
  EXPECT_EQ(frame.passes.size(), fresh.passes.size());
  EXPECT_EQ(frame.rays, fresh.rays);
}

TEST_F(RendererTest, MakesMapsOnceForThePartsOfAPictureAndAnewForTheNext) {
  Scene scene = stage.scene;
  World world(scene);
  Renderer renderer(world, {.rsm = small_maps()});
  FrameSettings top = size_of(24, 16), rest = top;
  top.rows = 5;
  rest.first_row = 5;
  const auto makes_maps = [&](const Camera& from, const FrameSettings& settings) {
    return made_maps(renderer.render(from, settings).value());
  };
  // Rows without a picture before them
  EXPECT_TRUE(makes_maps(camera(), rest));
  EXPECT_TRUE(makes_maps(camera(), top));
  EXPECT_FALSE(makes_maps(camera(), rest));
  EXPECT_TRUE(makes_maps(camera(), size_of(24, 16)));

  EXPECT_TRUE(makes_maps(moved(camera()), rest));
  FrameSettings wider = rest;
  wider.width = 25;
  EXPECT_TRUE(makes_maps(moved(camera()), wider));
  EXPECT_FALSE(makes_maps(moved(camera()), wider));
  scene.lights.at(0).intensity *= 2.0f;
  ASSERT_TRUE(world.update());
  EXPECT_TRUE(makes_maps(moved(camera()), wider));
}

TEST_F(RendererTest, SeesWhatItsWorldAndFieldBecame) {
  Scene scene = stage.scene;
  World world(scene);
  IrradianceField field = IrradianceField::make(few_probes(3), open_bounds(world)).value();
  Renderer renderer(world, {.field = &field});
  RenderedFrame frame;
  ASSERT_TRUE(renderer.render(camera(), size_of(24, 16), frame));
  scene.lights.at(0).intensity *= 2.0f;
  ASSERT_TRUE(world.update());
  field.update(world);
  ASSERT_TRUE(renderer.render(camera(), size_of(24, 16), frame));
  const RenderedFrame fresh =
      Renderer(world, {.field = &field}).render(camera(), size_of(24, 16)).value();
  expect_same_bits(frame.image, fresh.image);
}

}  // namespace
}  // namespace lambent::renderer_test
