// SPDX-License-Identifier: Apache-2.0
// Control of the size and bit rate of a client's pictures: as large as this machine can render, and
// as the client and the network can receive.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace lambent::stream {

struct PaceLimits {
  glm::uvec2 size{1280, 720};          ///< Of pictures [pixels].
  float rate = 30.0f;                  ///< Pictures per second.
  std::uint32_t bitrate = 20'000'000;  ///< [bit/s]
  /// Pictures become smaller if they take longer than this to render and encode [ms].
  double picture_ms = 250.0;
};

/// Controls the pictures of one client. Sizes change in steps, since each change costs a key
/// picture.
class Pace {
 public:
  /// The client's request is clamped to the limits.
  Pace(const PaceLimits& limits, glm::uvec2 size, float rate);

  /// Changes the client's request.
  void ask(glm::uvec2 size, float rate);
  /// Reports the time that rendering and encoding a picture of the current size took [ms].
  void made(double ms);
  /// Reports that the client has decoded a picture `round_trip_ms` after it was given to the
  /// network; its bytes were in transit for `path_ms` of that. Only `path_ms` indicates a congested
  /// path: a busy machine, the client's or this one, does not make pictures smaller.
  void delivered(double round_trip_ms, double path_ms);

  glm::uvec2 size() const;              ///< Even [pixels].
  float rate() const { return rate_; }  ///< Maximum pictures per second.
  /// Expected pictures per second: as many as rendering allows, up to the rate.
  float likely_rate() const;
  std::uint32_t bitrate() const;  ///< [bit/s]
  double round_trip_ms() const { return round_trip_ms_; }

 private:
  glm::uvec2 size_at(int step) const;
  double pixels_at(int step) const;
  void choose_step();

  PaceLimits limits_;
  glm::uvec2 asked_size_{0};
  float rate_ = 0.0f;
  int step_ = 0;             // index into the list of scales
  int steady_pictures_ = 0;  // successive pictures for which a larger size would have been possible
  double bits_a_pixel_ = 0.0;   // at the likely rate
  double made_ms_ = 0.0;        // smoothed; 0: none yet
  double round_trip_ms_ = 0.0;  // smoothed; 0: none yet
  double least_path_ms_ = 0.0;
};

}  // namespace lambent::stream
