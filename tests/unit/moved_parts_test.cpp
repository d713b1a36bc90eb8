// SPDX-License-Identifier: Apache-2.0
// Averages of light while parts of the world move.
#include "compose/history/moved_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>

#include "core/image/metrics.h"
#include "lambent/renderer.h"
#include "scene/light_tree/light_tree.h"
#include "shared/random.h"
#include "support/field_scenes.h"
#include "support/hand_made.h"

namespace lambent::moved_parts_test {
namespace {

const Bounds kLamp{{-0.5f, 9.9f, -0.5f}, {0.5f, 10.1f, 0.5f}};
const vec3 kUp(0.0f, 1.0f, 0.0f);

Bounds box_at(const vec3& center, float half) {
  return {center - half, center + half};
}

TEST(MovedParts, CountForLessTheFartherTheyAre) {
  const std::vector<Bounds> moved = {box_at({0.0f, 1.0f, 0.0f}, 0.5f)};
  const MovedParts parts(moved, {});
  EXPECT_EQ(parts.frames_of_gathers({0.0f, 0.4f, 0.0f}, kUp), 1.0f);
  const float near = parts.frames_of_gathers({1.5f, 0.4f, 0.0f}, kUp);
  const float far = parts.frames_of_gathers({2.0f, 0.4f, 0.0f}, kUp);
  EXPECT_GT(near, 1.0f);
  EXPECT_GT(far, near);
  const float most = parts.frames_of_gathers({50.0f, 0.4f, 0.0f}, kUp);
  EXPECT_GT(most, far);
  // What is below a surface's horizon sends no light there
  EXPECT_EQ(parts.frames_of_gathers({0.0f, 2.5f, 0.0f}, kUp), most);
}

TEST(MovedParts, ContainTheirSurfacesAndNotWhatIsBesideThem) {
  const std::vector<Bounds> moved = {
      {}, {{-2.0f, 1.0f, -2.0f}, {2.0f, 1.2f, 2.0f}}, {{4.0f, 0.0f, 0.0f}, {4.0f, 1.0f, 1.0f}}};
  const MovedParts parts(moved, {});
  EXPECT_TRUE(parts.contain({2.0f, 1.1f, 0.0f}));
  EXPECT_TRUE(parts.contain({0.3f, 1.2f, -1.0f}));
  // A sheet, to within rounding
  EXPECT_TRUE(parts.contain({4.0001f, 0.5f, 0.5f}));
  // A floor below a rotor is within its bounding sphere
  EXPECT_FALSE(parts.contain({0.0f, 0.0f, 0.0f}));
}

TEST(MovedParts, EndAveragesInTheShadowsOfLamps) {
  const std::vector<Bounds> moved = {box_at({0.0f, 6.0f, 0.0f}, 0.1f)}, lamps = {kLamp};
  const MovedParts parts(moved, lamps);
  EXPECT_EQ(parts.frames_of_emitters({0.0f, 0.0f, 0.0f}, kUp), 1.0f);
  EXPECT_GT(parts.frames_of_emitters({8.0f, 0.0f, 0.0f}, kUp), 4.0f);
  // A point may be on the part, to within rounding
  EXPECT_EQ(parts.frames_of_emitters({0.0f, 6.1f + 1e-6f, 0.0f}, kUp), 1.0f);
  // Above the lamp the part is not in the way, and lamps below the horizon are hidden anyway
  EXPECT_GT(parts.frames_of_emitters({0.0f, 20.0f, 0.0f}, -kUp), 4.0f);
  EXPECT_GT(parts.frames_of_emitters({0.0f, 0.0f, 0.0f}, -kUp), 4.0f);
  // What bounces there from elsewhere changes little
  EXPECT_GT(parts.frames_of_gathers({0.0f, 0.0f, 0.0f}, kUp), 4.0f);
}

TEST(MovedParts, EndNoAveragesBesideALongStrip) {
  // A strip of light along one wall of a room, and a thing that moves along its middle
  const std::vector<Bounds> strip = {{{-2.4f, 2.38f, 1.9f}, {2.4f, 2.4f, 1.93f}}};
  const std::vector<Bounds> moved = {box_at({0.1f, 0.8f, 0.2f}, 0.1f)};
  const MovedParts parts(moved, strip);
  const auto along = [&](float x) { return parts.frames_of_emitters({x, 0.0f, -1.5f}, kUp); };
  EXPECT_EQ(parts.frames_of_emitters({0.1f, 0.2f, -0.4f}, kUp), 1.0f);
  // From these, all of the strip is seen past the thing, though not past a sphere around the strip
  for (const float x : {-1.5f, 0.1f, 1.5f}) EXPECT_GT(along(x), 4.0f) << x;
}

TEST(MovedParts, ShadeWhereARayToALightMeetsThem) {
  // Against rays from random places to all corners of boxes of lights, and to random points of them
  RandomStream random = make_random_stream(1u, 2u, 3u);
  const auto anywhere = [&] {
    const vec2 xy = next_uniform2(random);
    return 4.0f * vec3(xy.x, xy.y, next_uniform(random)) - 2.0f;
  };
  int shaded = 0, missed = 0;
  for (int i = 0; i < 2000; ++i) {
    const std::vector<Bounds> lights = {box_at(anywhere(), 0.5f)},
                              part = {box_at(anywhere(), 0.3f)};
    const vec3 place = anywhere();
    const bool tells = MovedParts(part, lights).frames_of_emitters(place, vec3(0.0f)) == 1.0f;
    bool meets = false;
    for (int k = 0; k < 256 && !meets; ++k) {
      const vec3 corner(k & 1, k >> 1 & 1, k >> 2 & 1);
      const vec3 any(next_uniform(random), next_uniform(random), next_uniform(random));
      const vec3 offset = k < 8 ? corner : any;
      const vec3 way = lights[0].min + offset * (lights[0].max - lights[0].min) - place;
      const vec3 a = (part[0].min - place) / way, b = (part[0].max - place) / way;
      const vec3 first = glm::min(a, b), last = glm::max(a, b);
      meets =
          std::max({first.x, first.y, first.z, 0.0f}) <= std::min({last.x, last.y, last.z, 1.0f});
    }
    EXPECT_TRUE(tells || !meets);
    shaded += tells ? 1 : 0;
    missed += tells && !meets ? 1 : 0;
  }
  EXPECT_GT(shaded, 150);
  // Random rays miss what is only just in the way
  EXPECT_LT(missed, shaded / 10);
}

TEST(MovedParts, EndAveragesOfLobesThatMayShowThem) {
  const std::vector<Bounds> moved = {box_at({0.0f, 5.0f, 0.0f}, 0.2f)};
  const MovedParts parts(moved, {});
  const auto lobe = [](const vec3& mirror_ws, float alpha, float inverse_distance) {
    return LobeGuide{mirror_ws, vec3(0.0f), 1.0f / (alpha * alpha), inverse_distance};
  };
  const vec3 place(0.0f), aside = normalize(vec3(1.0f, 1.0f, 0.0f));
  EXPECT_EQ(parts.frames_of_lobe(place, lobe(kUp, 0.01f, 0.05f)), 1.0f);
  // A wall hides the part, or the mirror faces elsewhere, unless its lobe is wide
  EXPECT_GT(parts.frames_of_lobe(place, lobe(kUp, 0.01f, 1.0f)), 4.0f);
  EXPECT_GT(parts.frames_of_lobe(place, lobe(aside, 0.01f, 0.05f)), 4.0f);
  EXPECT_EQ(parts.frames_of_lobe(place, lobe(aside, 0.4f, 0.05f)), 1.0f);
  // What the mirror shows is just beside the part
  const vec3 past = normalize(vec3(0.15f, 1.0f, 0.0f));
  EXPECT_LT(parts.frames_of_lobe(place, lobe(past, 0.01f, 0.2f)), 8.0f);
  EXPECT_GT(parts.frames_of_lobe(place, lobe(past, 0.01f, 0.2f)), 1.0f);
}

TEST(ChangedLight, TellsPartsFromLights) {
  Scene scene;
  scene.materials = {test::lambert(glm::vec3(0.5f))};
  test::add_room(scene, 4.0f, 0);
  scene.lights = {test::point_light(glm::vec3(1.0f), glm::vec3(0.0f))};
  World world(scene);
  const auto change = [&](std::uint64_t since) {
    const auto changed = light_changed_since(world, since);
    EXPECT_TRUE(changed) << since;
    return changed.value_or(ChangedLight{MovedParts({}, {})});
  };
  EXPECT_FALSE(change(0).relit);
  scene.instances[0].world_from_object[3].y -= 1.0f;
  ASSERT_TRUE(world.update());
  EXPECT_FALSE(change(0).relit);
  EXPECT_TRUE(change(0).moved.contain({0.0f, -3.0f, 0.0f}));
  scene.lights[0].intensity *= 2.0f;
  ASSERT_TRUE(world.update());
  EXPECT_TRUE(change(0).relit);
  EXPECT_FALSE(change(0).emitters);
  scene.environment.radiance = glm::vec3(2.0f);
  ASSERT_TRUE(world.update());
  EXPECT_TRUE(change(0).emitters);
  EXPECT_EQ(change(2).frames_of_emitters(vec3(0.0f), kUp), 1.0f);
  EXPECT_FALSE(change(3).relit);
  EXPECT_FALSE(light_changed_since(world, 8));
}

TEST(ChangedLight, IsOfWhatIsSampledWhereThereAreManyLights) {
  for (const std::size_t count : {kMaxLightsAsked - 1, kMaxLightsAsked + 1}) {
    Scene scene;
    scene.materials = {test::lambert(glm::vec3(0.5f))};
    test::add_room(scene, 4.0f, 0);
    scene.lights.assign(count, test::point_light(glm::vec3(1.0f), glm::vec3(0.0f)));
    World world(scene);
    scene.lights[0].intensity *= 0.5f;
    ASSERT_TRUE(world.update());
    const auto changed = light_changed_since(world, 0);
    ASSERT_TRUE(changed);
    EXPECT_EQ(changed->emitters, count > kMaxLightsAsked);
  }
}

/// The error of a layer against the same without noise.
double error_of(const RenderedFrame& frame, const RenderedFrame& truth, const char* layer) {
  return compare_images(*frame.image.find(layer), *truth.image.find(layer),
                        {.block = 4, .perceptual = false})
      .value()
      .relative_rmse;
}

/// Errors of sequences in which something changes from frame to frame.
struct SequenceErrors {
  double averaged = 0.0, alone = 0.0;
};

/// The errors of two layers, irradiance and direct, of a scene that `change` edits before each
/// frame: of frames that are averaged, and without averages.
template <class Change>
std::array<SequenceErrors, 2> errors_of(Scene& scene, Change change) {
  World world(scene);
  FieldSettings of_field;
  of_field.probe_count = glm::ivec3(6);
  of_field.rays_per_probe = 64;
  IrradianceField field = *IrradianceField::make(of_field, open_bounds(world));
  for (int i = 0; i < 3; ++i) field.update(world);
  FrameSettings settings = quality_settings(Quality::interactive);
  settings.width = 64;
  settings.height = 48;
  FrameSettings single = settings;
  settings.averaged_frames = 16;
  single.averaged_frames = 1;
  const Camera& camera = scene.cameras.at(0);
  FrameSettings exact = single;
  exact.denoise = false;
  exact.samples = 64;
  exact.gather_rays = exact.emissive_samples = 4;
  exact.seed = 2;
  Renderer averaging(world, {.field = &field}), alone(world, {.field = &field});
  // A single frame's error is chance
  constexpr int kFrames = 12, kCompared = 6;
  const char* const layers[] = {"irradiance", "direct"};
  std::array<SequenceErrors, 2> errors;
  for (int i = 0; i < kFrames; ++i) {
    change();
    EXPECT_TRUE(world.update());
    field.update(world);
    single.seed = 10 + static_cast<std::uint32_t>(i);
    const RenderedFrame averaged = averaging.render(camera, settings).value();
    const RenderedFrame without = alone.render(camera, single).value();
    if (i < kFrames - kCompared) continue;
    const RenderedFrame truth = Renderer(world, {.field = &field}).render(camera, exact).value();
    for (std::size_t k = 0; k < errors.size(); ++k) {
      errors[k].averaged += error_of(averaged, truth, layers[k]) / kCompared;
      errors[k].alone += error_of(without, truth, layers[k]) / kCompared;
    }
  }
  for (std::size_t k = 0; k < errors.size(); ++k) {
    std::printf("%s: error %.4f, %.4f without averages\n", layers[k], errors[k].averaged,
                errors[k].alone);
  }
  return errors;
}

/// The Cornell box, whose last instance is a small block.
Scene box_with_small_block() {
  Scene scene = scenes::make("cornell").value();
  glm::mat4& block = scene.instances.back().world_from_object;
  block = glm::mat4(glm::mat3(0.3f)) * block;
  return scene;
}

TEST(MovedParts, LeaveAveragesElsewhereAsTheyAre) {
  Scene scene = box_with_small_block();
  glm::mat4& block = scene.instances.back().world_from_object;
  const auto [irradiance, direct] = errors_of(scene, [&] { block[3].x += 0.01f; });
  EXPECT_LT(irradiance.averaged, 0.85 * irradiance.alone);
  // Edges that single samples miss are most of the error of direct light
  EXPECT_LT(direct.averaged, 1.02 * direct.alone);
}

TEST(ChangedLight, LeavesFewerFramesOfGatheredLight) {
  // A lamp that moves through the box
  Scene scene = box_with_small_block();
  for (Material& material : scene.materials) material.emission *= 0.1f;
  scene.lights = {test::point_light(glm::vec3(0.3f), glm::vec3(0.3f, 0.7f, 0.5f))};
  const auto [irradiance, direct] =
      errors_of(scene, [&] { scene.lights[0].position_ws.x += 0.02f; });
  EXPECT_LT(irradiance.averaged, 0.85 * irradiance.alone);
  EXPECT_LT(direct.averaged, 1.02 * direct.alone);
}

TEST(MovedParts, ShowWhatTheirRaysBringThoughTheFieldLags) {
  // A field that is nearly dark, so that rays bring more than its lookups by far
  Scene scene = scenes::make("cornell").value();
  const std::vector<Material> materials = scene.materials;
  for (Material& material : scene.materials) material.emission *= 1e-3f;
  World world(scene);
  FieldSettings of_field;
  of_field.probe_count = glm::ivec3(4);
  of_field.rays_per_probe = 64;
  IrradianceField field = *IrradianceField::make(of_field, open_bounds(world));
  field.update(world);
  scene.materials = materials;
  ASSERT_TRUE(world.update());
  FrameSettings settings = quality_settings(Quality::interactive);
  settings.width = 64;
  settings.height = 48;
  Renderer renderer(world, {.field = &field});
  const auto mean_light = [&](int frames) {
    settings.averaged_frames = frames;
    const RenderedFrame frame = renderer.render(scene.cameras.at(0), settings).value();
    double sum = 0.0;
    for (const float value : frame.image.find("irradiance")->pixels) sum += value;
    return sum;
  };
  const double whole = mean_light(1), still = mean_light(16);
  scene.instances.back().world_from_object[3].x += 0.01f;
  ASSERT_TRUE(world.update());
  // The block's light is there at once, that of the walls as slowly as before
  const double moved = mean_light(16);
  EXPECT_LT(still, 0.1 * whole);
  EXPECT_GT(moved, still + 0.05 * whole);
  EXPECT_LT(moved, 0.5 * whole);
  // Once it rests, its average goes on from the frames before: that one frame does not stay
  const double rested = mean_light(16);
  EXPECT_LT(rested, moved);
}

}  // namespace
}  // namespace lambent::moved_parts_test
