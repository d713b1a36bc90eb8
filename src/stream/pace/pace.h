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
  /// Time that a pixel is expected to take before anything was measured [ms]: interactive pictures
  /// of Sponza took 0.011 ms a pixel on one core. A client that asks for little begins with that.
  static constexpr double kUnmeasuredMsAPixel = 0.01;

  /// The client's request is clamped to the limits. `ms_a_pixel`, above 0, is the time that a pixel
  /// of another client's pictures takes to render and encode [ms].
  Pace(const PaceLimits& limits, glm::uvec2 size, float rate,
       double ms_a_pixel = kUnmeasuredMsAPixel);

  /// Changes the client's request.
  void ask(glm::uvec2 size, float rate);
  /// Reports the time that rendering and encoding a picture of `size` pixels took [ms].
  void made(glm::uvec2 size, double ms);
  /// Reports that the client has decoded a picture `round_trip_ms` after it was given to the
  /// network; its bytes were in transit for `path_ms` of that. Only `path_ms` indicates a congested
  /// path: a busy machine, the client's or this one, does not make pictures smaller.
  void delivered(double round_trip_ms, double path_ms);

  glm::uvec2 size() const { return size_at(step_); }  ///< Even [pixels].
  /// The size that the client asked for, within the limits; even [pixels].
  glm::uvec2 asked_size() const { return size_at(0); }
  /// Time that a pixel takes to render and encode, smoothed [ms].
  double ms_a_pixel() const { return ms_a_pixel_; }
  float rate() const { return rate_; }  ///< Maximum pictures per second.
  /// Expected pictures per second: as many as rendering allows, up to the rate.
  float likely_rate() const;
  std::uint32_t bitrate() const { return bitrate_at(step_); }  ///< [bit/s]
  /// The bit rate of pictures of asked_size() with as many bits for a pixel, at the likely rate of
  /// those of size() [bit/s].
  std::uint32_t asked_bitrate() const { return bitrate_at(0); }
  double round_trip_ms() const { return round_trip_ms_; }

 private:
  glm::uvec2 size_at(int step) const;
  double pixels_at(int step) const;
  double ms_at(int step) const { return ms_a_pixel_ * pixels_at(step); }
  double rate_at(int step) const;
  bool is_calm() const;
  double bits_a_pixel_at(int step) const;
  double bits_at(int step) const;
  std::uint32_t bitrate_at(int step) const;
  bool fits(int step) const;
  bool has_room(int step) const;
  void choose_step();
  void change_to(int step);

  PaceLimits limits_;
  glm::uvec2 asked_size_{0};
  float rate_ = 0.0f;
  int step_ = 0;                // index into the list of scales
  int steady_pictures_ = 0;     // successive pictures for which a larger size was possible
  int pictures_to_grow_;        // of these, how many a larger size takes
  bool has_grown_ = false;      // with the last change of the step
  int pictures_at_step_ = 0;    // since the last change of the step
  int calm_pictures_;           // successive ones that have not waited in queues, up to some
  double bits_a_pixel_ = 0.0;   // at the likely rate
  double ms_a_pixel_;           // smoothed
  int measured_ = 0;            // number of pictures that were measured, up to some
  double round_trip_ms_ = 0.0;  // smoothed; 0: none yet
  double least_path_ms_ = 0.0;
};

}  // namespace lambent::stream
