// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "field/field_access.h"
#include "field/field_state.h"
#include "field/probes/probe_store.h"
#include "field/probes/tile_light.h"
#include "field/schedule/schedule.h"
#include "lambent/renderer.h"
#include "support/field_scenes.h"

namespace lambent::field_update_test {
namespace {

using test::make_field;
using test::Stage;

/// The results of a run: the store's words and the frame's pixels.
struct Outcome {
  std::vector<uint> words;
  std::vector<float> pixels;
  bool operator==(const Outcome&) const = default;
};

FieldSettings small_field(std::uint32_t seed) {
  FieldSettings settings;
  settings.probe_count = glm::ivec3(5);
  settings.rays_per_probe = 32;
  settings.seed = seed;
  return settings;
}

Outcome run(const Stage& stage, std::uint32_t seed) {
  const IrradianceField field = make_field(stage, small_field(seed), 3);
  Outcome outcome;
  const ProbeStore& store = store_of(field);
  outcome.words.assign(store.irradiance_words().begin(), store.irradiance_words().end());
  outcome.words.insert(outcome.words.end(), store.distance_words().begin(),
                       store.distance_words().end());
  FrameSettings frame;
  frame.width = 96;
  frame.height = 64;
  frame.samples = 2;
  frame.seed = seed;
  const RenderedFrame rendered =
      Renderer(stage.world, {.field = &field}).render(stage.scene.cameras[0], frame).value();
  for (const Layer& layer : rendered.image.layers) {
    outcome.pixels.insert(outcome.pixels.end(), layer.image.pixels.begin(),
                          layer.image.pixels.end());
  }
  return outcome;
}

Outcome run_on_threads(const Stage& stage, int threads) {
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  Outcome outcome;
  arena.execute([&] { outcome = run(stage, 1); });
  return outcome;
}

TEST(IrradianceField, SameBitsOnAnyNumberOfThreads) {
  const Stage stage("cornell");
  const Outcome one = run_on_threads(stage, 1);
  EXPECT_TRUE(run_on_threads(stage, 2) == one);
  EXPECT_TRUE(run_on_threads(stage, 4) == one);
}

TEST(IrradianceField, SameBitsForTheSameSeedAndOthersForAnother) {
  const Stage stage("cornell");
  const Outcome first = run(stage, 1), other = run(stage, 2);
  EXPECT_TRUE(run(stage, 1) == first);
  EXPECT_FALSE(other.words == first.words);
  EXPECT_FALSE(other.pixels == first.pixels);
}

TEST(IrradianceField, ResetForgetsAllLight) {
  const Stage stage("cornell");
  IrradianceField field = make_field(stage, small_field(1), 1);
  const auto words = store_of(field).irradiance_words();
  const std::vector<uint> first(words.begin(), words.end());
  field.update(stage.world);
  EXPECT_EQ(field.updates(), 2);
  field.reset();
  EXPECT_EQ(field.updates(), 0);
  EXPECT_TRUE(std::all_of(words.begin(), words.end(), [](uint word) { return word == 0u; }));
  field.update(stage.world);
  EXPECT_TRUE(std::equal(first.begin(), first.end(), words.begin()));
}

TEST(IrradianceField, TellsWhatAnUpdateDid) {
  const Stage stage("cornell");
  IrradianceField field = make_field(stage, small_field(1), 0);
  const UpdateStatistics statistics = field.update(stage.world);
  EXPECT_EQ(statistics.probe_rays, 125u * 32u);
  EXPECT_GT(statistics.shadow_rays, 0u);
  EXPECT_GT(statistics.solve_iterations, 0);
  EXPECT_LE(statistics.residual, field.settings().solve_tolerance);
  EXPECT_GT(statistics.change, 0.5);  // all of the light is new
  EXPECT_LT(field.update(stage.world).change, 0.5);
  EXPECT_GT(field.surfel_bytes(), 0u);
  EXPECT_LE(field.store_bytes(), 1168u * 125u);
}

/// The relative root mean square difference of the light of two fields' probes, weighted as
/// IrradianceField::standard_error() weights it.
double difference(const IrradianceField& a, const IrradianceField& b) {
  const auto texels = static_cast<std::size_t>(a.settings().irradiance_texels) *
                      static_cast<std::size_t>(a.settings().irradiance_texels);
  const WorkingIrradiance& light = FieldAccess::state_of(a).data.light;
  const WorkingIrradiance& other = FieldAccess::state_of(b).data.light;
  const float mean = mean_luminance(light);
  double squares = 0.0;
  int probes = 0;
  for (std::size_t first = 0; first < light.size(); first += texels) {
    const ProbeStatus& status = statuses_of(a)[first / texels];
    if (!is_scheduled(status) || takes_turns(status)) continue;
    const LightChange change = light_change(TileLight(light).subspan(first, texels),
                                            TileLight(other).subspan(first, texels));
    squares +=
        static_cast<double>(estimate_relative_square(change, static_cast<int>(texels), 1.0f, mean));
    ++probes;
  }
  return std::sqrt(squares / probes);
}

TEST(IrradianceField, KnowsItsStandardError) {
  for (const char* scene : {"cornell", "two-rooms"}) {
    const Stage stage(scene);
    IrradianceField field = make_field(stage, small_field(1), 0);
    EXPECT_EQ(field.standard_error(), std::numeric_limits<double>::infinity());
    for (int i = 0; i < 12; ++i) field.update(stage.world);
    const double few = field.standard_error();
    // The difference of two fields has twice the variance of one
    const IrradianceField other = make_field(stage, small_field(2), 12);
    const double found = difference(field, other) / std::sqrt(2.0);
    EXPECT_GT(few, 0.7 * found) << scene;
    EXPECT_LT(few, 1.4 * found) << scene;
    for (int i = 0; i < 36; ++i) field.update(stage.world);
    EXPECT_NEAR(field.standard_error() / few, 0.5, 0.1) << scene;
  }
}

TEST(IrradianceField, StaysDarkWithoutLightAndWithoutScene) {
  Scene dark = scenes::make("cube").value();
  dark.lights.clear();
  for (Scene scene : {dark, Scene{}}) {
    const Stage stage(std::move(scene));
    const IrradianceField field = make_field(stage, small_field(1), 2);
    const FieldQuery query{glm::vec3(0.1f), {0.0f, 1.0f, 0.0f}, {0.0f, 1.0f, 0.0f}};
    EXPECT_EQ(test::look_up(field, {&query, 1})[0], glm::vec3(0.0f));
  }
}

}  // namespace
}  // namespace lambent::field_update_test
