// SPDX-License-Identifier: Apache-2.0
// Common parts of the measurements of light streams: the atrium in motion, a field that follows it
// ten times a second, and the costs of a stream of it.
#pragma once

#include <cstdint>
#include <ctime>
#include <functional>
#include <string>

#include "bench/median.h"
#include "lambent/field.h"
#include "lambent/stream.h"
#include "lambent/world.h"

namespace lambent::light_stream {

/// Seconds from one state to the next.
inline constexpr double kInterval = 0.1;

/// Processor time of all threads of this process since the last lap [ms].
class ProcessorTime {
 public:
  double lap() {
    const std::clock_t now = std::clock();
    const double ms = 1e3 * static_cast<double>(now - start_) / CLOCKS_PER_SEC;
    start_ = now;
    return ms;
  }

 private:
  std::clock_t start_ = std::clock();
};

/// The state of a scene as a function of time.
struct Motion {
  std::string label;
  std::function<void(Scene& scene, double time_s)> move;
};

/// About what two cores trace in the time of a state.
inline constexpr std::uint64_t kRealTimeRays = 100'000;

/// The motions: the sun at 8.7 degrees per second; the sun at a twentieth of that; the door; one
/// lamp that brightens and dims with a period of four seconds; nothing.
Motion fast_sun();
Motion slow_sun();
Motion moving_door();
Motion pulsing_lamp();
Motion rest();

/// The atrium with a field that was settled at time 0.
class MovingAtrium {
 public:
  /// `ray_budget` limits the probe rays per state; 0: unlimited.
  MovingAtrium(Motion motion, std::uint64_t ray_budget);

  /// Advances to the next state.
  void advance();
  const IrradianceField& field() const { return field_; }

 private:
  Motion motion_;
  Scene scene_;
  World world_;
  IrradianceField field_;
  std::uint64_t ray_budget_;
  int states_ = 0;
};

/// The costs of a stream of some states.
struct StreamCost {
  int deltas = 0, keys = 0, states = 0;
  std::uint64_t light_bytes = 0;     ///< Size of deltas, and of keys except the first.
  std::uint64_t geometry_bytes = 0;  ///< Size of geometry messages except the first.
  std::uint64_t first_key = 0, first_geometry = 0, last_key = 0;
  double relative = 0.0, dark = 0.0;   ///< Means of LightErrors.
  double most = 0.0;                   ///< The largest of them.
  bench::Median encode_ms, decode_ms;  ///< Processor time.

  double light_mbit_s() const;
  double geometry_mbit_s() const;
};

/// Streams the atrium for `states` states after the first, through H.265 if requested.
StreamCost stream(MovingAtrium& atrium, const stream::LightEncoderSettings& settings, int states,
                  bool h265 = false);

/// The rows, each a function that prints a table.
void measure_rates();     ///< Data rates, errors and speed of streams.
void measure_quality();   ///< Data rates at other target errors.
void measure_regions();   ///< Data rates of a large field, for all light and by regions.
void measure_textures();  ///< Data rates through H.265.
void measure_geometry();  ///< Sizes of geometry and keys.
void measure_pictures();  ///< Differences of clients' pictures from the server's.
/// Writes atrium.stream into the working directory: a Recording of the fast sun.
void record_stream();

}  // namespace lambent::light_stream
