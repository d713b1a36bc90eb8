// SPDX-License-Identifier: Apache-2.0
// The data that a client receives of a large field.
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include "bench/stage.h"
#include "bench/stream/scenes.h"
#include "stream/regions/region_encoder.h"

namespace lambent::light_stream {
namespace {

// The house is 20 m wide, of rooms of 5 m.
const glm::ivec3 kProbes(64, 10, 64);
constexpr int kStates = 32, kFirstUpdates = 4;
constexpr std::uint64_t kRays = 400'000;  // as many as four times as many cores would trace

struct Cost {
  std::uint64_t bytes = 0, first = 0;
  stream::FollowedRegions has;
  stream::LightDecoder decoder;
  bench::Median code_ms;
};

void take(const stream::LightMessage& message, bool first, Cost& cost) {
  (first ? cost.first : cost.bytes) += message.bytes.size();
  bench::value_or_throw(cost.decoder.receive(message.bytes));
}

void print(const char* label, const Cost& cost) {
  std::printf("| %s | %.3f | %.0f | %.1f |\n", label,
              8e-6 * static_cast<double>(cost.bytes) / (kStates * kInterval),
              1e-3 * static_cast<double>(cost.first), cost.code_ms.value());
}

}  // namespace

void measure_regions() {
  Scene scene = bench::open_stage("house");
  World world(scene);
  FieldSettings settings;
  settings.probe_count = kProbes;
  settings.corrections = false;
  IrradianceField field =
      bench::value_or_throw(IrradianceField::make(settings, open_bounds(world)));
  for (int i = 0; i < kFirstUpdates; ++i) field.update(world);
  stream::LightEncoder encoder = bench::value_or_throw(stream::LightEncoder::create());
  stream::LightDecoder whole;
  stream::RegionEncoder regions;
  const Camera& camera = scene.cameras.front();
  Cost all, by_regions, some, few;
  const std::vector<glm::vec3> lamps = [&] {
    std::vector<glm::vec3> emission;
    for (const Material& material : scene.materials) emission.push_back(material.emission);
    return emission;
  }();
  for (int state = 0; state <= kStates; ++state) {
    // All lamps brighten and dim
    const float share = 0.6f + 0.4f * std::cos(0.16f * static_cast<float>(state));
    for (std::size_t i = 0; i < lamps.size(); ++i) scene.materials[i].emission = share * lamps[i];
    bench::value_or_throw(world.update());
    field.update(world, {.ray_budget = kRays});
    ProcessorTime watch;
    const auto messages = bench::value_or_throw(encoder.encode(field));
    all.code_ms.add(watch.lap());
    const bool first = state == 0;
    for (const auto& message : messages) {
      bench::value_or_throw(whole.receive(message.bytes));
      if (message.kind != stream::LightMessageKind::geometry) {
        (first ? all.first : all.bytes) += message.bytes.size();
        continue;
      }
      for (Cost* cost : {&by_regions, &some, &few}) {
        bench::value_or_throw(cost->decoder.receive(message.bytes));
      }
    }
    watch.lap();
    const bool anew = regions.follow(whole);
    for (const auto& [cost, radius] :
         {std::pair<Cost*, float>{&by_regions, 1e6f}, {&some, 5.0f}, {&few, 2.5f}}) {
      stream::Surroundings where;
      where.position_ws = glm::vec3(camera.world_from_view[3]);
      where.forward_ws = -glm::normalize(glm::vec3(camera.world_from_view[2]));
      where.radius = radius;
      take(regions.update_for(whole, where, first || anew, cost->has), first, *cost);
      cost->code_ms.add(watch.lap());
    }
  }
  std::printf("### Light of the house, %d probes, 10 states/s, %d states, all lamps change\n",
              field.probes(), kStates);
  std::printf("| what a client gets with each update | light [Mbit/s] | first key [kB] | ms |\n");
  std::printf("|---|---|---|---|\n");
  print("all, as one stream", all);
  print("all, by regions", by_regions);
  print("within 5 m, or seen within 10 m", some);
  print("within 2.5 m, or seen within 5 m", few);
}

}  // namespace lambent::light_stream
