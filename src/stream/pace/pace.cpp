// SPDX-License-Identifier: Apache-2.0
#include "stream/pace/pace.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "stream/protocol/messages.h"

namespace lambent::stream {
namespace {

// Scales of the requested size, along each edge.
constexpr std::array kScales = {1.0, 0.75, 0.5, 0.375, 0.25};

// Bits per pixel: the least, below which blocks are visible; the initial value; the most, above
// which pictures look no better.
constexpr double kFewestBits = 0.03, kFirstBits = 0.12, kMostBits = 0.4;
constexpr double kLeastBitrate = 64'000.0;  // [bit/s]; the codec accepts no less for any size
// Least bits per pixel that a larger size must have immediately.
constexpr double kBitsToGrow = 0.08;

// A larger size must be expected to take at most this share of PaceLimits::picture_ms.
constexpr double kFastEnough = 0.5;
// Number of successive pictures that must permit a larger size: as few as exclude that one was
// fast by chance. It doubles whenever a size to which pictures have grown must be given up,
// and is forgotten once a size has lasted for so many pictures, some ten seconds, so that sizes do
// not go up and down where load does.
constexpr int kFewestPicturesToGrow = 3, kMostPicturesToGrow = 40, kLastingPictures = 120;
constexpr int kLastStep = static_cast<int>(kScales.size()) - 1;

// Pictures whose transit takes this much longer than the fastest one's wait in queues [ms].
// Receivers may delay acknowledgements by 40 ms.
constexpr double kInLine = 60.0;
// Multiplicative decrease and slow increase, as in congestion control; and the increase once so
// many successive pictures have not waited.
constexpr double kLess = 0.8, kMore = 1.02, kMoreOnceCalm = 1.1;
constexpr int kCalmPictures = 20;
// Growth of the fastest transit per picture, so that a path that became longer is recognised.
constexpr double kForgetLeast = 1.002;

// Weight of the latest time in a smoothed one. The first few count alike: the very first picture
// also takes the time to allocate memory.
constexpr double kNewShare = 0.2;
constexpr int kAlikePictures = 5;  // the inverse of kNewShare

double smoothed(double before, double now) {
  return before > 0.0 ? before + kNewShare * (now - before) : now;
}

}  // namespace

Pace::Pace(const PaceLimits& limits, glm::uvec2 size, float rate, double ms_a_pixel)
    : limits_(limits),
      pictures_to_grow_(kFewestPicturesToGrow),
      calm_pictures_(kCalmPictures),
      bits_a_pixel_(kFirstBits),
      ms_a_pixel_(ms_a_pixel) {
  ask(size, rate);
}

void Pace::ask(glm::uvec2 size, float rate) {
  // Within the limits, with the requested aspect
  const double scale = std::min({1.0, static_cast<double>(limits_.size.x) / size.x,
                                 static_cast<double>(limits_.size.y) / size.y});
  const glm::uvec2 before = std::exchange(asked_size_, glm::dvec2(size) * scale + 0.5);
  rate_ = std::min(rate, limits_.rate);
  if (asked_size_ == before) return;
  // The largest size that is fast enough
  step_ = steady_pictures_ = pictures_at_step_ = 0;
  has_grown_ = false;
  while (step_ < kLastStep && ms_at(step_) > kFastEnough * limits_.picture_ms) ++step_;
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

double Pace::rate_at(int step) const {
  constexpr double kMsOfSecond = 1000.0;
  return std::clamp(kMsOfSecond / ms_at(step), 1.0, std::max(1.0, static_cast<double>(rate_)));
}

float Pace::likely_rate() const {
  return static_cast<float>(rate_at(step_));
}

std::uint32_t Pace::bitrate_at(int step) const {
  const double wanted = bits_a_pixel_ * pixels_at(step) * rate_at(step_);
  const double most = std::max(kLeastBitrate, static_cast<double>(limits_.bitrate));
  return static_cast<std::uint32_t>(std::clamp(wanted, kLeastBitrate, most));
}

/// Whether pictures have not waited in queues for some time.
bool Pace::is_calm() const {
  return calm_pictures_ >= kCalmPictures;
}

/// Bits of a pixel at another size: a picture has as many as now. On a calm path, larger ones may
/// have more, as the first ones have.
double Pace::bits_a_pixel_at(int step) const {
  const double kept = bits_a_pixel_ * pixels_at(step_) / pixels_at(step);
  const double more = step < step_ && is_calm() ? std::min(bits_a_pixel_, kFirstBits) : 0.0;
  return std::clamp(kept, more, kMostBits);
}

/// Bits of a pixel at another size, within the limits of the bit rate.
double Pace::bits_at(int step) const {
  const double pixels_of_second = pixels_at(step) * rate_at(step);
  const double most = std::max(kLeastBitrate, static_cast<double>(limits_.bitrate));
  return std::clamp(bits_a_pixel_at(step), kLeastBitrate / pixels_of_second,
                    most / pixels_of_second);
}

void Pace::made(glm::uvec2 size, double ms) {
  measured_ = std::min(measured_ + 1, kAlikePictures);
  const double now = ms / (static_cast<double>(size.x) * size.y);
  ms_a_pixel_ += (now - ms_a_pixel_) / measured_;
  ++pictures_at_step_;
  choose_step();
}

void Pace::delivered(double round_trip_ms, double path_ms) {
  round_trip_ms_ = smoothed(round_trip_ms_, round_trip_ms);
  least_path_ms_ =
      least_path_ms_ > 0.0 ? std::min(path_ms, least_path_ms_ * kForgetLeast) : path_ms;
  const bool waits = path_ms > 2.0 * least_path_ms_ + kInLine;
  calm_pictures_ = waits ? 0 : std::min(calm_pictures_ + 1, kCalmPictures);
  const double more = is_calm() ? kMoreOnceCalm : kMore;
  bits_a_pixel_ = std::clamp(bits_a_pixel_ * (waits ? kLess : more), kFewestBits / 2.0, kMostBits);
}

/// Whether pictures of the present or a smaller size take no longer than they may, with enough
/// bits.
bool Pace::fits(int step) const {
  return ms_at(step) <= limits_.picture_ms && bits_at(step) >= kFewestBits;
}

/// Whether pictures of a larger size would, with some time and bits to spare.
bool Pace::has_room(int step) const {
  return ms_at(step) < kFastEnough * limits_.picture_ms && bits_at(step) > kBitsToGrow;
}

void Pace::change_to(int step) {
  bits_a_pixel_ = bits_a_pixel_at(step);
  has_grown_ = step < step_;
  step_ = step;
  steady_pictures_ = pictures_at_step_ = 0;
}

/// Goes to the size that fits, at once where the present one is too large.
void Pace::choose_step() {
  if (pictures_at_step_ >= kLastingPictures) pictures_to_grow_ = kFewestPicturesToGrow;
  int fitting = step_;
  while (fitting < kLastStep && !fits(fitting)) ++fitting;
  if (fitting > step_) {
    if (has_grown_) pictures_to_grow_ = std::min(2 * pictures_to_grow_, kMostPicturesToGrow);
    return change_to(fitting);
  }
  int larger = step_;
  while (larger > 0 && has_room(larger - 1)) --larger;
  steady_pictures_ = larger < step_ ? steady_pictures_ + 1 : 0;
  if (steady_pictures_ >= pictures_to_grow_) change_to(larger);
}

}  // namespace lambent::stream
