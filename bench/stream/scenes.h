// SPDX-License-Identifier: Apache-2.0
// What the measurements of light streams share: the atrium in motion, a field that follows it ten
// times a second, and what a stream of it takes.
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

/// Processor time, of all threads together, since the last lap [ms]: other programs do not count.
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

/// How a scene is at a time.
struct Motion {
  std::string label;
  std::function<void(Scene& scene, double time_s)> move;
};

/// About what two cores trace in the time of a state.
inline constexpr std::uint64_t kRealTimeRays = 100'000;

/// The sun at 8.7 degrees a second; the sun at a twentieth of that; the door; one lamp that swells
/// and fades in four seconds; nothing.
Motion fast_sun();
Motion slow_sun();
Motion moving_door();
Motion pulsing_lamp();
Motion rest();

/// The atrium with a field that has settled at time 0.
class MovingAtrium {
 public:
  /// Probe rays are bounded by `ray_budget` in each state; 0: not bounded.
  MovingAtrium(Motion motion, std::uint64_t ray_budget);

  /// Goes on to the next state.
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

/// What a stream of some states took.
struct StreamCost {
  int deltas = 0, keys = 0, states = 0;
  std::uint64_t light_bytes = 0;     ///< Of deltas, and of keys but the first.
  std::uint64_t geometry_bytes = 0;  ///< Of geometry but the first.
  std::uint64_t first_key = 0, first_geometry = 0, last_key = 0;
  double relative = 0.0, dark = 0.0;   ///< Means of LightErrors.
  double most = 0.0;                   ///< The largest of them.
  bench::Median encode_ms, decode_ms;  ///< Processor time.

  double light_mbit_s() const;
  double geometry_mbit_s() const;
};

/// Streams the atrium for some states, after the first; through H.265 where that is wanted.
StreamCost stream(MovingAtrium& atrium, const stream::LightEncoderSettings& settings, int states,
                  bool h265 = false);

/// The rows, each a function that prints a table.
void measure_rates();     ///< What streams take, and how exact and how fast they are.
void measure_quality();   ///< What they take at other errors.
void measure_regions();   ///< What a client gets of a large field, all of it or what is near.
void measure_textures();  ///< What they take through H.265.
void measure_geometry();  ///< Geometry, and keys.
void measure_pictures();  ///< How clients' pictures differ from the server's.
/// Writes atrium.stream into the working directory: a Recording of the fast sun.
void record_stream();

}  // namespace lambent::light_stream
