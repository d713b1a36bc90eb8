// SPDX-License-Identifier: Apache-2.0
// One direction of a path through a network, as a queue: a replacement of Linux's netem, for
// kernels without it.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <random>

namespace lambent::stream_path {

struct PathSettings {
  std::chrono::microseconds delay{0};  ///< One-way delay of each packet.
  double loss = 0.0;                   ///< Probability with which each packet is lost, 0 to 1.
  double rate = 0.0;                   ///< [bit/s]; 0: unlimited.
  /// Packets that arrive while the queue is longer than this are lost.
  std::chrono::microseconds queue{100'000};
  std::uint32_t seed = 1;  ///< Seed of the losses.
};

/// Decides whether and when a packet arrives. Packets are not reordered.
class PathModel {
 public:
  using Clock = std::chrono::steady_clock;

  explicit PathModel(const PathSettings& settings) : settings_(settings), random_(settings.seed) {}

  /// The arrival time of a packet that is sent now; none: it is lost.
  std::optional<Clock::time_point> send(Clock::time_point now, std::size_t bytes) {
    if (std::bernoulli_distribution(settings_.loss)(random_)) return std::nullopt;
    free_ = std::max(free_, now);
    if (free_ - now > settings_.queue) return std::nullopt;
    if (settings_.rate > 0.0) {
      constexpr double kBits = 8.0;
      free_ += std::chrono::duration_cast<Clock::duration>(
          std::chrono::duration<double>(kBits * static_cast<double>(bytes) / settings_.rate));
    }
    return free_ + settings_.delay;
  }

 private:
  PathSettings settings_;
  std::mt19937 random_;
  Clock::time_point free_;  // when all earlier packets have left the queue
};

}  // namespace lambent::stream_path
