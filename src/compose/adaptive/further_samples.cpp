// SPDX-License-Identifier: Apache-2.0
#include "compose/adaptive/further_samples.h"

#include <algorithm>

namespace lambent {
namespace {

// A further sample has this share of the rays of one of the first samples.
constexpr int kFewerRays = 4;

/// The number of rays of a further sample. Where there were several, there are two at least: their
/// variance is measured.
int fewer(int rays) {
  return rays > 1 ? std::max(rays / kFewerRays, 2) : rays;
}

bool takes_further(const FrameSettings& settings) {
  const bool whole = rendered_rows(settings).rows == settings.height;
  return whole && !averages(settings) && !settings.temporal_antialiasing && settings.samples > 1 &&
         settings.most_samples / 2 >= settings.samples;
}

}  // namespace

FurtherSamples::FurtherSamples(const FrameRequest& request, FramePasses& passes)
    : request_(request), passes_(passes), settings_(request.settings) {
  if (!takes_further(settings_)) return;
  const auto width = static_cast<std::size_t>(settings_.width);
  const auto height = static_cast<std::size_t>(settings_.height);
  skipped_.assign(width * height, 0);
  noise_.emplace(width, height);
  settings_.gather_rays = fewer(settings_.gather_rays);
  settings_.coat_rays = fewer(settings_.coat_rays);
  settings_.reflected_emissive_samples = fewer(settings_.reflected_emissive_samples);
}

void FurtherSamples::note_sample() {
  // The last round's samples are not looked at
  if (!noise_ || !takes_further(settings_)) return;
  passes_.read_luminances(luminances_);
  noise_->add(luminances_, 1.0f / static_cast<float>(settings_.samples), skipped_);
}

const FrameRequest* FurtherSamples::next_round() {
  if (!noise_ || !takes_further(settings_)) return nullptr;
  if (!round_) stops_ = passes_.exposure();
  if (noise_->choose(stops_, skipped_) == 0) return nullptr;
  constexpr float kKept = 0.5f;
  const int taken = settings_.samples;
  settings_.samples = 2 * taken;
  round_.emplace(FrameRequest{request_.world,
                              request_.sources,
                              request_.camera,
                              settings_,
                              request_.before,
                              request_.light_continues,
                              request_.moved,
                              request_.first_sample,
                              request_.sequence,
                              {taken, skipped_}});
  passes_.refine(*round_, kKept);
  noise_->scale(kKept, skipped_);
  return &*round_;
}

}  // namespace lambent
