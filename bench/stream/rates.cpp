// SPDX-License-Identifier: Apache-2.0
// The data rates of light streams.
#include <cstdio>

#include "bench/stream/scenes.h"

namespace lambent::light_stream {
namespace {

// States of the atrium's whole day at 8.7 degrees/s.
constexpr int kDayStates = 108;

double raw_mbit_s(const IrradianceField& field) {
  return 8e-6 * static_cast<double>(field.store_bytes()) / kInterval;
}

void print_row(const Motion& motion, std::uint64_t ray_budget,
               const stream::LightEncoderSettings& settings, bool h265 = false) {
  MovingAtrium atrium(motion, ray_budget);
  const StreamCost cost = stream(atrium, settings, kDayStates, h265);
  const double all = cost.light_mbit_s() + cost.geometry_mbit_s();
  std::printf("| %s | %s | %.3f | %.3f | %.2f, %.2f | %.2f | %d | %.0f | %.1f, %.1f | %.3f |\n",
              motion.label.c_str(), ray_budget == 0 ? "no" : "100,000 rays", cost.light_mbit_s(),
              cost.geometry_mbit_s(), 100.0 * cost.relative, 100.0 * cost.dark, 100.0 * cost.most,
              cost.keys, 1e-3 * static_cast<double>(cost.last_key), cost.encode_ms.value(),
              cost.decode_ms.value(), 100.0 * (1.0 - all / raw_mbit_s(atrium.field())));
  std::fflush(stdout);
}

void print_head(const char* what) {
  std::printf("### %s, atrium, 10 states/s, %d states\n", what, kDayStates);
  std::printf(
      "| what moves | budget | light [Mbit/s] | geometry [Mbit/s] | errors [%%] | largest [%%] | "
      "keys after the first | key at the end [kB] | encode, decode [ms of one core] | saved of the "
      "raw store "
      "[%%] |\n");
  std::printf("|---|---|---|---|---|---|---|---|---|---|\n");
}

}  // namespace

void measure_rates() {
  print_head("Light streams, target error 1 %");
  for (const Motion& motion : {fast_sun(), slow_sun(), moving_door(), pulsing_lamp(), rest()}) {
    print_row(motion, kRealTimeRays, {});
  }
  print_row(fast_sun(), 0, {});
}

void measure_quality() {
  print_head("Light streams by target error (3 %, 1 %, 0.3 %)");
  for (const float target : {0.03f, 0.01f, 0.003f}) {
    stream::LightEncoderSettings settings;
    settings.target_error = target;
    print_row(fast_sun(), kRealTimeRays, settings);
  }
}

void measure_textures() {
  print_head("Light through H.265, target errors 1.2 % and 1 %");
  for (const float target : {0.012f, 0.01f}) {
    stream::LightEncoderSettings settings;
    settings.target_error = target;
    print_row(fast_sun(), kRealTimeRays, settings, true);
  }
  stream::LightEncoderSettings settings;
  settings.target_error = 0.012f;
  print_row(fast_sun(), 0, settings, true);
  print_row(slow_sun(), kRealTimeRays, settings, true);
}

}  // namespace lambent::light_stream
