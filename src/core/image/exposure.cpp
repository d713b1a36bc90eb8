// SPDX-License-Identifier: Apache-2.0
#include "core/image/exposure.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "core/image/color_at.h"
#include "core/image/mid_grey.h"
#include "shared/color.h"

namespace lambent {
namespace {

// Pixels count as at most this much darker or brighter than the median [stops]: the range that a
// display shows around mid-grey.
constexpr double kDarker = 5.0, kBrighter = 3.0;
// Interpolation weight between the exposure by a reflected-light meter (0), which shows snow as
// grey, and by an incident-light meter (1), which shows snow as white. With 1, white walls would
// leave no room for highlights. Applies only to surfaces lighter than mid-grey: a street at night
// is dark enough.
constexpr double kAlbedoShare = 0.5;
// Metals, whose albedo is 0, count as if they reflected this share of light; below the second
// albedo, surfaces count as metal in part, so that no noise of a map decides.
constexpr double kMetalReflectance = 0.5, kLeastAlbedo = 0.01;
// Surfaces that cover at most kBrightShare of a picture may be brighter than kBright [stops] above
// mid-grey, half a stop past white; otherwise, as with objects in spot lights on a dark stage, the
// exposure is lowered. What is above kWhollyLowered [stops] counts by kBeyondLowered, and no more
// than kMaxLowered [stops] in all, so that a patch of sun does not make a room dark.
constexpr double kBrightShare = 0.1, kBright = 3.0;
constexpr double kWhollyLowered = 2.0, kBeyondLowered = 0.5, kMaxLowered = 3.5;
// Lamps that cover at least kGlareShare of a picture, more than a bulb does, may be brighter than
// kGlare [stops] above mid-grey: the tubes of a lit room are 4 to 6. Of what is above, as neon
// signs in a dark street are, kGlareLowered lowers the exposure: the street looks dark, as by
// night.
constexpr double kGlareShare = 0.02, kGlare = 5.0, kGlareLowered = 0.5;
// Coloured lamps, as neon and glowing plants, are there to be looked at, not to light a room well:
// of them, this share of a picture is enough. Their least channel is at most kLeastOfColor of the
// largest. Bulbs and candles have as little blue, but more green than kLeastGreen of the red: down
// to 1,800 K.
constexpr double kColoredGlareShare = 0.005;
constexpr float kLeastOfColor = 0.35f, kLeastGreen = 0.2f;
// What is this much darker [stops] than the brightest surfaces that together cover this share of
// the picture counts as black, a million times below: the night side of a planet beside a ship in
// the sun. Pictures of which surfaces are not known have no black.
constexpr double kBlack = 20.0, kBrightestShare = 0.01;
// A surface that emits more than this share of the light that it sends counts as a lamp, whatever
// it reflects.
constexpr float kMaxEmitted = 0.5f;
// The background counts at most as much as the first share of all surfaces, and as if these covered
// the second share of the picture at least: a bird in the sky does not decide.
constexpr double kMostBackground = 0.5, kLeastSurfaces = 0.05;

/// Whether a colour has any light; NaN counts as such.
bool is_lit(const float* color) {
  return !(color[0] <= 0.0f && color[1] <= 0.0f && color[2] <= 0.0f);
}

/// A layer of vectors or colours; null where there is none.
const Image* layer_of(const LayeredImage& frame, const char* name) {
  const Image* image = frame.find(name);
  return image != nullptr && image->channels >= 3 ? image : nullptr;
}

enum class Shown { surface, lamp, through_glass, background };

/// What tells reflecting surfaces from the sky, lamps, and what is seen through glass.
struct SurfaceLayers {
  explicit SurfaceLayers(const LayeredImage& frame)
      : albedo(layer_of(frame, "albedo")),
        normal(layer_of(frame, "normal")),
        emission(layer_of(frame, "emission")),
        transmission(layer_of(frame, "transmission")) {}

  /// `sent`: the pixel's luminance.
  Shown at(int x, int y, float sent) const {
    const bool hit = is_hit(x, y);
    if (is_emitter(x, y, sent)) return hit ? Shown::lamp : Shown::background;
    if (is_lit(albedo->at(x, y))) return Shown::surface;
    if (!hit || emission == nullptr || transmission == nullptr) return Shown::background;
    if (is_lit(transmission->at(x, y))) return Shown::through_glass;
    return is_lit(emission->at(x, y)) ? Shown::background : Shown::surface;
  }

  const Image *albedo, *normal, *emission, *transmission;

 private:
  bool is_emitter(int x, int y, float sent) const {
    if (emission == nullptr) return false;
    const float* e = emission->at(x, y);
    return luminance(vec3(e[0], e[1], e[2])) > kMaxEmitted * sent;
  }
  bool is_hit(int x, int y) const {
    if (normal == nullptr) return false;
    const float* n = normal->at(x, y);
    return n[0] != 0.0f || n[1] != 0.0f || n[2] != 0.0f;
  }
};

/// Whether a lamp has another colour than white or that of something hot.
bool is_colored(const vec3& color) {
  if (color.x >= color.y && color.y >= color.z) return color.y <= kLeastGreen * color.x;
  const auto [least, most] = std::minmax({color.x, color.y, color.z});
  return least <= kLeastOfColor * most;
}

/// A luminance in stops; not finite where it does not count.
double stops_of(float luminance) {
  return std::log2(luminance > 0.0f ? static_cast<double>(luminance) : 0.0);
}

/// The number of stops by which a surface of this albedo counts as darker than its luminance.
double albedo_stops(const float* albedo) {
  const auto diffuse = static_cast<double>(luminance(vec3(albedo[0], albedo[1], albedo[2])));
  const double level = diffuse + kMetalReflectance * std::max(0.0, 1.0 - diffuse / kLeastAlbedo);
  return level > kMidGrey ? kAlbedoShare * std::log2(level / kMidGrey) : 0.0;
}

/// The share with which a pixel of the background counts beside these numbers of pixels.
double background_weight(double surfaces, double background) {
  const double most =
      kMostBackground * std::max(surfaces, kLeastSurfaces * (surfaces + background));
  return most > 0.0 && background > most ? most / background : 1.0;
}

/// The number of stops by which the exposure is lowered where so many are wanted.
double softly_limited(double lowered) {
  const double beyond = std::max(lowered - kWhollyLowered, 0.0);
  return std::clamp(lowered - (1.0 - kBeyondLowered) * beyond, 0.0, kMaxLowered);
}

template <class Bins>
double total_from(const Bins& bins, std::size_t first) {
  return static_cast<double>(std::accumulate(bins.begin() + static_cast<std::ptrdiff_t>(first),
                                             bins.end(), std::uint64_t{0}));
}

template <class Bins>
Bins plus(Bins a, const Bins& b) {
  std::transform(a.begin(), a.end(), b.begin(), a.begin(), std::plus<>());
  return a;
}

}  // namespace

void LuminanceHistogram::add(const Image& linear) {
  for (int y = 0; y < linear.height; ++y) {
    for (int x = 0; x < linear.width; ++x) {
      const double stops = stops_of(luminance(color_at(linear, x, y)));
      if (std::isfinite(stops)) ++counts_[bin_of(stops)];
    }
  }
}

void LuminanceHistogram::add(const LayeredImage& rows) {
  const Image& linear = *rows.find("");
  const SurfaceLayers layers(rows);
  if (layers.albedo == nullptr) return add(linear);
  for (int y = 0; y < linear.height; ++y) {
    for (int x = 0; x < linear.width; ++x) {
      const float sent = luminance(color_at(linear, x, y));
      const double stops = stops_of(sent);
      if (!std::isfinite(stops)) continue;
      const std::size_t bin = bin_of(stops);
      switch (layers.at(x, y, sent)) {
        case Shown::surface:
          ++surfaces_[bin];
          ++counts_[bin_of(stops - albedo_stops(layers.albedo->at(x, y)))];
          break;
        case Shown::lamp:
          ++lamps_[bin];
          if (is_colored(color_at(linear, x, y))) ++colored_lamps_[bin];
          break;
        case Shown::through_glass:
          ++through_glass_[bin];
          break;
        case Shown::background:
          ++background_[bin];
          break;
      }
    }
  }
}

std::size_t LuminanceHistogram::bin_of(double stops) {
  return static_cast<std::size_t>(
      std::clamp((stops - kMinStop) * kBinsPerStop, 0.0, static_cast<double>(kBins - 1)));
}

double LuminanceHistogram::stop_of(std::size_t bin) {
  return kMinStop + (static_cast<double>(bin) + 0.5) / kBinsPerStop;
}

double LuminanceHistogram::bright_stop(const Bins& bins, double pixels) {
  double above = 0.0;
  std::size_t bin = kBins;
  while (bin > 0 && above < pixels) above += static_cast<double>(bins[--bin]);
  return above < pixels ? kMinStop : stop_of(bin);
}

float LuminanceHistogram::stops() const {
  Bins counted = counts_, surfaces = surfaces_, background = plus(background_, lamps_);
  // What is seen through glass is the picture's subject where it is most of it: a display case
  const bool is_subject = total_from(through_glass_, 0) > total_from(surfaces_, 0);
  if (is_subject) surfaces = plus(surfaces, through_glass_);
  Bins& seen_as = is_subject ? counted : background;
  seen_as = plus(seen_as, through_glass_);

  const double pixels = total_from(counted, 0) + total_from(background, 0);
  const std::size_t first = bin_of(bright_stop(surfaces, kBrightestShare * pixels) - kBlack);
  const double weight =
      background_weight(total_from(counted, first), total_from(background, first));
  std::array<double, kBins> counts{};
  double total = 0.0;
  for (std::size_t bin = first; bin < kBins; ++bin) {
    counts[bin] = static_cast<double>(counted[bin]) + weight * static_cast<double>(background[bin]);
    total += counts[bin];
  }
  if (total <= 0.0) return 0.0f;
  std::size_t median = 0;
  for (double below = counts[0]; 2.0 * below < total && median + 1 < kBins;)
    below += counts[++median];

  const double low = stop_of(median) - kDarker, high = stop_of(median) + kBrighter;
  double sum = 0.0;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    sum += counts[bin] * std::clamp(stop_of(bin), low, high);
  }
  const double typical = sum / total;
  const double too_bright = bright_stop(surfaces, kBrightShare * pixels) - typical - kBright;
  const double glaring = std::max(bright_stop(lamps_, kGlareShare * pixels),
                                  bright_stop(colored_lamps_, kColoredGlareShare * pixels));
  const double lowered = std::max(too_bright, kGlareLowered * (glaring - typical - kGlare));
  return static_cast<float>(std::log2(kMidGrey) - typical - softly_limited(lowered));
}

float display_stops(const Image& linear) {
  LuminanceHistogram histogram;
  histogram.add(linear);
  return histogram.stops();
}

float display_stops(const LayeredImage& frame) {
  LuminanceHistogram histogram;
  histogram.add(frame);
  return histogram.stops();
}

}  // namespace lambent
