// SPDX-License-Identifier: Apache-2.0
#include "bench/stream/scenes.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bench/stage.h"
#include "lambent/animation.h"
#include "stream/textures/h265.h"

namespace lambent::light_stream {
namespace {

// The atrium's sun turns by 1.66 rad in the 20 s of its animation.
constexpr double kPi = 3.14159265358979;
constexpr double kDaySeconds = 20.0, kDegreesPerDaySecond = 1.66 * 180.0 / kPi / kDaySeconds;
constexpr double kFastSun = 8.7;  // [degrees/s]
constexpr double kSlowSun = kFastSun / 20.0;
// Start of the slow sun's motion, in the morning [s of the animation].
constexpr double kSlowStart = 6.0;
constexpr double kDoorStart = 2.0;
constexpr double kLampPeriod = 4.0;  // [s]
constexpr double kLampLeast = 0.2;

// Updates after which a field at rest has settled.
constexpr int kSettledUpdates = 24;

// Without corrections, which are part of geometry and so measured by measure_geometry(); updates
// then take half the time.
FieldSettings field_settings() {
  FieldSettings settings;
  settings.corrections = false;
  return settings;
}

int animation_named(const Scene& scene, const std::string& name) {
  for (std::size_t i = 0; i < scene.animations.size(); ++i) {
    if (scene.animations[i].name == name) return static_cast<int>(i);
  }
  throw std::runtime_error("the atrium has no animation called " + name);
}

void set_sun(Scene& scene, double time_s) {
  animate(scene, animation_named(scene, "day"), static_cast<float>(std::min(time_s, kDaySeconds)));
}

/// The scene at the start of a motion.
Scene moved_scene(const Motion& motion) {
  Scene scene = bench::open_stage("atrium");
  motion.move(scene, 0.0);
  return scene;
}

}  // namespace

Motion fast_sun() {
  return {"sun, 8.7 degrees/s",
          [](Scene& scene, double t) { set_sun(scene, t * kFastSun / kDegreesPerDaySecond); }};
}

Motion slow_sun() {
  return {"sun, 0.44 degrees/s", [](Scene& scene, double t) {
            set_sun(scene, kSlowStart + t * kSlowSun / kDegreesPerDaySecond);
          }};
}

Motion moving_door() {
  return {"door", [](Scene& scene, double t) {
            animate(scene, animation_named(scene, "door"), static_cast<float>(kDoorStart + t));
          }};
}

Motion pulsing_lamp() {
  return {"one lamp", [lit = glm::vec3(0.0f)](Scene& scene, double t) mutable {
            const auto lamp =
                std::find_if(scene.materials.begin(), scene.materials.end(),
                             [](const Material& m) { return m.emission != glm::vec3(0.0f); });
            if (lit == glm::vec3(0.0f)) lit = lamp->emission;
            const double swing = 0.5 + 0.5 * std::cos(2.0 * kPi * t / kLampPeriod);
            lamp->emission = lit * static_cast<float>(kLampLeast + (1.0 - kLampLeast) * swing);
          }};
}

Motion rest() {
  return {"nothing moves", [](Scene&, double) {}};
}

MovingAtrium::MovingAtrium(Motion motion, std::uint64_t ray_budget)
    : motion_(std::move(motion)),
      scene_(moved_scene(motion_)),
      world_(scene_),
      field_(bench::value_or_throw(IrradianceField::make(field_settings(), open_bounds(world_)))),
      ray_budget_(ray_budget) {
  for (int i = 0; i < kSettledUpdates; ++i) field_.update(world_);
}

void MovingAtrium::advance() {
  motion_.move(scene_, ++states_ * kInterval);
  bench::value_or_throw(world_.update());
  field_.update(world_, {.ray_budget = ray_budget_});
}

double StreamCost::light_mbit_s() const {
  return 8e-6 * static_cast<double>(light_bytes) / (states * kInterval);
}
double StreamCost::geometry_mbit_s() const {
  return 8e-6 * static_cast<double>(geometry_bytes) / (states * kInterval);
}

stream::LightEncoder make_encoder(const stream::LightEncoderSettings& settings, bool h265) {
  if (!h265) return bench::value_or_throw(stream::LightEncoder::create(settings));
  return bench::value_or_throw(
      stream::LightEncoder::create(settings, bench::value_or_throw(stream::make_h265_writer())));
}

StreamCost stream(MovingAtrium& atrium, const stream::LightEncoderSettings& settings, int states,
                  bool h265) {
  using stream::LightMessageKind;
  stream::LightEncoder encoder = make_encoder(settings, h265);
  stream::LightDecoder decoder;
  if (h265) decoder.read_textures(bench::value_or_throw(stream::make_h265_reader()));
  StreamCost cost;
  for (const stream::LightMessage& message :
       bench::value_or_throw(encoder.encode(atrium.field()))) {
    (message.kind == LightMessageKind::geometry ? cost.first_geometry : cost.first_key) =
        message.bytes.size();
    bench::value_or_throw(decoder.receive(message.bytes));
  }
  for (int i = 0; i < states; ++i) {
    atrium.advance();
    ProcessorTime watch;
    const auto messages = bench::value_or_throw(encoder.encode(atrium.field()));
    cost.encode_ms.add(watch.lap());
    for (const stream::LightMessage& message : messages) {
      (message.kind == LightMessageKind::geometry ? cost.geometry_bytes : cost.light_bytes) +=
          message.bytes.size();
      const bool is_delta =
          message.kind == LightMessageKind::delta || message.kind == LightMessageKind::texture;
      cost.keys += is_delta || message.kind == LightMessageKind::geometry ? 0 : 1;
      cost.deltas += is_delta ? 1 : 0;
      watch.lap();
      bench::value_or_throw(decoder.receive(message.bytes));
      if (is_delta) cost.decode_ms.add(watch.lap());
    }
    const stream::LightErrors errors = encoder.errors();
    cost.relative += errors.relative / states;
    cost.dark += errors.dark / states;
    cost.most = std::max({cost.most, errors.relative, errors.dark});
  }
  cost.states = states;
  if (h265) {
    encoder.refresh();
    cost.last_key = bench::value_or_throw(encoder.encode(atrium.field())).back().bytes.size();
  } else {
    cost.last_key = bench::value_or_throw(encoder.join(decoder.geometry())).back().bytes.size();
  }
  return cost;
}

}  // namespace lambent::light_stream
