// SPDX-License-Identifier: Apache-2.0
#include "compose/adaptive/further_samples.h"

#include <algorithm>

namespace lambent {
namespace {

// How many times fewer rays gather the light of a further sample than that of one of the first.
// With four times fewer, the filter blurs it: hotel_room had a FLIP of 0.091 instead of 0.078.
constexpr int kFewerGathers = 2;
// The same for rays of reflections and of what glass shows.
constexpr int kFewerReflections = 4;

/// A number of rays, so many times fewer. Where there were several, there are two at least: their
/// variance is measured.
int fewer(int rays, int times) {
  return rays > 1 ? std::max(rays / times, 2) : rays;
}

}  // namespace

bool takes_further_samples(const FrameSettings& settings) {
  const bool whole = rendered_rows(settings).rows == settings.height;
  return whole && !averages(settings) && !settings.temporal_antialiasing && settings.samples > 1 &&
         settings.most_samples / 2 >= settings.samples;
}

FurtherSamples::FurtherSamples(const FrameRequest& request, FramePasses& passes)
    : request_(request), passes_(passes), settings_(request.settings) {
  if (!takes_further_samples(settings_)) return;
  const auto width = static_cast<std::size_t>(settings_.width);
  const auto height = static_cast<std::size_t>(settings_.height);
  skipped_.assign(width * height, 0);
  noise_.emplace(width, height);
  // What mirrors and glass show gathers in all rounds, or in none
  const int gathers = fewer(settings_.gather_rays, kFewerGathers);
  const bool shown = shown_gather_rays(settings_) > 0;
  settings_.gather_rays = shown ? std::max(gathers, kGathersOverShown) : gathers;
  settings_.coat_rays = fewer(settings_.coat_rays, kFewerReflections);
  settings_.reflected_emissive_samples =
      fewer(settings_.reflected_emissive_samples, kFewerReflections);
}

void FurtherSamples::note_sample() {
  // The last round's samples are not looked at
  if (!noise_ || !takes_further_samples(settings_)) return;
  passes_.read_luminances(luminances_);
  noise_->add(luminances_, 1.0f / static_cast<float>(settings_.samples), skipped_);
}

const FrameRequest* FurtherSamples::start_round() {
  if (!noise_ || !takes_further_samples(settings_)) return nullptr;
  if (!round_) noise_->expose(passes_.exposure());
  if (noise_->choose(skipped_) == 0) return nullptr;
  const int taken = settings_.samples;
  settings_.samples = 2 * taken;
  const float kept = static_cast<float>(taken) / static_cast<float>(settings_.samples);
  round_.emplace(FrameRequest{request_.world,
                              request_.sources,
                              request_.camera,
                              settings_,
                              request_.before,
                              request_.light_continues,
                              request_.changed,
                              request_.first_sample,
                              request_.sequence,
                              {taken, skipped_}});
  passes_.refine(*round_, kept);
  noise_->scale(kept, skipped_);
  return &*round_;
}

}  // namespace lambent
