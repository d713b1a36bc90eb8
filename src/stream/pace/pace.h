// SPDX-License-Identifier: Apache-2.0
// How large a client's pictures are, and how many bits they have: as much as this machine can
// render and as the client and what lies between keep up with.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace lambent::stream {

struct PaceLimits {
  glm::uvec2 size{1280, 720};          ///< Of pictures [pixels].
  float rate = 30.0f;                  ///< Pictures a second.
  std::uint32_t bitrate = 20'000'000;  ///< [bit/s]
  /// Pictures that take longer to render and encode shrink [ms].
  double picture_ms = 250.0;
};

/// Follows one client. Sizes go down and up in steps, as each step costs a key picture.
class Pace {
 public:
  /// What the client asks for is held to the limits.
  Pace(const PaceLimits& limits, glm::uvec2 size, float rate);

  /// The client asks for something else.
  void ask(glm::uvec2 size, float rate);
  /// A picture of the present size took so long to render and to encode [ms].
  void made(double ms);
  /// The client has decoded a picture, so long after it was given to the network; its bytes were on
  /// their way for `path_ms` of that. Only these tell of a path that has too little room: a machine
  /// that is busy, the client's or this one, makes pictures no smaller.
  void delivered(double round_trip_ms, double path_ms);

  glm::uvec2 size() const;              ///< Even [pixels].
  float rate() const { return rate_; }  ///< Pictures a second, at most.
  /// Pictures a second that are likely: what rendering allows, up to the rate.
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
  int step_ = 0;                // of the list of scales
  int steady_pictures_ = 0;     // for which a larger size would have done
  double bits_a_pixel_ = 0.0;   // of a second's pictures at the likely rate
  double made_ms_ = 0.0;        // smoothed; 0: none yet
  double round_trip_ms_ = 0.0;  // smoothed; 0: none yet
  double least_path_ms_ = 0.0;
};

}  // namespace lambent::stream
