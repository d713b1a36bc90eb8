// SPDX-License-Identifier: Apache-2.0
#include "stream/pace/pace.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "stream/protocol/messages.h"

namespace lambent::stream {
namespace {

// Scales of the requested size, along each edge.
constexpr std::array kScales = {1.0, 0.75, 0.5, 0.375, 0.25};

// Bits per pixel: the least, below which blocks are visible; the initial value; the most, above
// which pictures look no better.
constexpr double kFewestBits = 0.03, kFirstBits = 0.12, kMostBits = 0.4;
// Least bits per pixel that a larger size must have immediately.
constexpr double kBitsToGrow = 0.08;

// A larger size must be expected to take at most this share of PaceLimits::picture_ms.
constexpr double kFastEnough = 0.5;
// Number of successive pictures that must permit a larger size: some seconds.
constexpr int kSteadyPictures = 40;

// Pictures whose transit takes this much longer than the fastest one's wait in queues [ms].
// Receivers may delay acknowledgements by 40 ms.
constexpr double kInLine = 60.0;
// Multiplicative decrease and slow increase, as in congestion control.
constexpr double kLess = 0.8, kMore = 1.02;
// Growth of the fastest transit per picture, so that a path that became longer is recognised.
constexpr double kForgetLeast = 1.002;

constexpr double kNewShare = 0.2;  // weight of the latest time in a smoothed one

double smoothed(double before, double now) {
  return before > 0.0 ? before + kNewShare * (now - before) : now;
}

}  // namespace

Pace::Pace(const PaceLimits& limits, glm::uvec2 size, float rate) : limits_(limits) {
  bits_a_pixel_ = kFirstBits;
  ask(size, rate);
}

void Pace::ask(glm::uvec2 size, float rate) {
  // Within the limits, with the requested aspect
  const double scale = std::min({1.0, static_cast<double>(limits_.size.x) / size.x,
                                 static_cast<double>(limits_.size.y) / size.y});
  asked_size_ = glm::uvec2(glm::dvec2(size) * scale + 0.5);
  rate_ = std::min(rate, limits_.rate);
}

glm::uvec2 Pace::size_at(int step) const {
  const glm::dvec2 scaled = glm::dvec2(asked_size_) * kScales[static_cast<std::size_t>(step)];
  const glm::uvec2 even = 2u * glm::uvec2(scaled / 2.0 + 0.5);
  return glm::clamp(even, glm::uvec2(kMinPictureSide), glm::uvec2(kMaxPictureSide));
}

double Pace::pixels_at(int step) const {
  const glm::uvec2 size = size_at(step);
  return static_cast<double>(size.x) * size.y;
}

glm::uvec2 Pace::size() const {
  return size_at(step_);
}

float Pace::likely_rate() const {
  constexpr double kMsOfSecond = 1000.0;
  const double possible = made_ms_ > 0.0 ? kMsOfSecond / made_ms_ : rate_;
  return static_cast<float>(std::clamp(possible, 1.0, std::max(1.0, static_cast<double>(rate_))));
}

std::uint32_t Pace::bitrate() const {
  constexpr double kLeastBitrate = 64'000.0;  // [bit/s]; the codec accepts no less for any size
  const double wanted = bits_a_pixel_ * pixels_at(step_) * likely_rate();
  const double most = std::max(kLeastBitrate, static_cast<double>(limits_.bitrate));
  return static_cast<std::uint32_t>(std::clamp(wanted, kLeastBitrate, most));
}

void Pace::made(double ms) {
  made_ms_ = smoothed(made_ms_, ms);
  choose_step();
}

void Pace::delivered(double round_trip_ms, double path_ms) {
  round_trip_ms_ = smoothed(round_trip_ms_, round_trip_ms);
  least_path_ms_ =
      least_path_ms_ > 0.0 ? std::min(path_ms, least_path_ms_ * kForgetLeast) : path_ms;
  const bool waits = path_ms > 2.0 * least_path_ms_ + kInLine;
  bits_a_pixel_ = std::clamp(bits_a_pixel_ * (waits ? kLess : kMore), kFewestBits / 2.0, kMostBits);
}

void Pace::choose_step() {
  constexpr int kLastStep = static_cast<int>(kScales.size()) - 1;
  const double bits = static_cast<double>(bitrate()) / (pixels_at(step_) * likely_rate());
  if (step_ < kLastStep && (bits < kFewestBits || made_ms_ > limits_.picture_ms)) {
    const double share = pixels_at(step_ + 1) / pixels_at(step_);
    ++step_;
    made_ms_ *= share;
    bits_a_pixel_ = std::min(bits_a_pixel_ / share, kMostBits);
    steady_pictures_ = 0;
    return;
  }
  if (step_ == 0) return;
  const double growth = pixels_at(step_ - 1) / pixels_at(step_);
  const bool has_room =
      made_ms_ * growth < kFastEnough * limits_.picture_ms && bits / growth > kBitsToGrow;
  steady_pictures_ = has_room ? steady_pictures_ + 1 : 0;
  if (steady_pictures_ < kSteadyPictures) return;
  --step_;
  made_ms_ *= growth;
  bits_a_pixel_ /= growth;
  steady_pictures_ = 0;
}

}  // namespace lambent::stream
