// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>

#include "denoise/denoise_passes.h"

namespace lambent {
namespace {

constexpr float kMostSharpness = 1024.0f;  // also for noise tolerance: practically infinite
// With the least share coats stay as noisy as they are; with the most, light is averaged over all
// directions even where lobes are as narrow as that of roughness 0.3.
constexpr float kLeastLobeShare = 1.0f / 1024.0f, kMostLobeShare = 16.0f;

// Excess is averaged over this share of lobes' width, three times that of other light: specks hide
// in the light around them. Twice that takes more noise off, and lights what should be dark beside
// narrow reflections (docs/math.md, "Rare bright rays").
constexpr float kExcessLobeShare = 1.5f;
// Excess is averaged over this share as if what lobes show were far away. Twice that puts light on
// the dark frame of a mirror between the bulbs on it (docs/math.md, "Metal in metal").
constexpr float kFarExcessLobeShare = 0.25f;

// What coats in mirrors reflect is averaged over this share as if it were far away: a pixel has a
// single ray there, and no variance. It takes the grain off floors in mirrors, and reflections look
// hardly rougher (docs/math.md, "Metal in metal").
constexpr float kMirroredLobeShare = 0.125f;

// Light that differs by less than its noise is averaged over this share of lobes' width:
// reflections then look as if surfaces were up to 8 % rougher, with twice the share 28 %.
constexpr float kFarLobeShare = 1.0f;

Expected<void> check_range(const char* name, bool fine, const char* range) {
  if (fine) return {};
  return fail("", name, std::string("is not ") + range);
}

}  // namespace

Expected<void> check(const DenoiseSettings& s) {
  const Expected<void> checks[] = {
      check_range("denoise passes", s.passes >= 1 && s.passes <= kMaxDenoisePasses, "1 to 6"),
      check_range("geometric passes", s.geometric_passes >= 1 && s.geometric_passes <= s.passes,
                  "1 to the number of passes"),
      check_range("normal sharpness",
                  s.normal_sharpness >= 0.0f && s.normal_sharpness <= kMostSharpness, "0 to 1024"),
      check_range("plane tolerance", s.plane_tolerance > 0.0f && s.plane_tolerance <= 1.0f,
                  "above 0 to 1"),
      check_range("noise tolerance",
                  s.noise_tolerance > 0.0f && s.noise_tolerance <= kMostSharpness,
                  "above 0 to 1024"),
      check_range("lobe share", s.lobe_share >= kLeastLobeShare && s.lobe_share <= kMostLobeShare,
                  "1/1024 to 16"),
      check_range("far lobe share",
                  s.far_lobe_share == 0.0f ||
                      (s.far_lobe_share >= kLeastLobeShare && s.far_lobe_share <= kMostLobeShare),
                  "0 or 1/1024 to 16")};
  for (const Expected<void>& fine : checks) {
    if (!fine) return fine;
  }
  return {};
}

DenoiseSettings emitter_denoising() {
  DenoiseSettings settings;
  settings.passes = 5;
  settings.geometric_passes = 1;
  settings.noise_tolerance = 2.5f;
  return settings;
}

DenoiseSettings geometric_denoising() {
  DenoiseSettings geometric;
  geometric.geometric_passes = geometric.passes;
  return geometric;
}

DenoiseSettings excess_denoising() {
  DenoiseSettings settings = geometric_denoising();
  settings.lobe_share = kExcessLobeShare;
  settings.far_lobe_share = kFarExcessLobeShare;
  return settings;
}

DenoiseSettings mirrored_denoising() {
  DenoiseSettings settings = geometric_denoising();
  settings.far_lobe_share = kMirroredLobeShare;
  return settings;
}

DenoiseSettings reflection_denoising(int samples) {
  DenoiseSettings settings = geometric_denoising();
  settings.far_lobe_share = kFarLobeShare;
  settings.noise_tolerance /= std::sqrt(static_cast<float>(samples));
  return settings;
}

int denoise_reach(const DenoiseSettings& settings) {
  // Fireflies are spread over up to 7 pixels, and their neighbours one pixel farther tell them
  return std::max((1 << settings.passes) - 1, 1 << std::min(settings.passes, kFireflyPasses));
}

DenoiseSettings firefly_denoising(DenoiseSettings settings) {
  settings.passes = std::min(settings.passes, kFireflyPasses);
  settings.geometric_passes = settings.passes;
  return settings;
}

std::vector<AtrousPass> denoise_passes(const DenoiseSettings& settings, bool has_base,
                                       NoiseFrom noise_from, bool has_levels, bool has_lobes) {
  const bool measured = noise_from == NoiseFrom::samples;
  const bool all_geometric = settings.geometric_passes == settings.passes;
  // Light over its level has few rare bright rays, and its samples measure its variance. So the
  // first pass averages variances alone, and not even the smallest shadows are blurred (Schied et
  // al. 2017, sec. 4.4: variances are filtered before they are used)
  const bool knows_noise = has_levels && measured;
  // Rays of a pixel measure the variance of gathered light, too, but a few are far brighter than
  // the others. Once the first pass has averaged variances, the next ones spread such light over
  // neighbours, which the sum of both variances allows, as that of the bright pixel is large; they
  // leave edges of light that exceed its noise
  const bool tells_edges = has_base && measured && !all_geometric;
  const float inverse_share = 1.0f / settings.lobe_share;
  const bool has_far_lobes = has_lobes && all_geometric && settings.far_lobe_share > 0.0f;
  const uint far_lobes = noise_from == NoiseFrom::neighbours ? kFarLobes : kFarLobesWithinNoise;
  const float inverse_far_share = has_far_lobes ? 1.0f / settings.far_lobe_share : 0.0f;
  std::vector<AtrousPass> passes;
  for (int i = 0; i < settings.passes; ++i) {
    AtrousPass pass{};
    pass.apart = 1 << (knows_noise ? std::max(i - 1, 0) : i);
    pass.normal_sharpness = settings.normal_sharpness;
    pass.plane_scale = 1.0f / settings.plane_tolerance;
    pass.contrast_scale = 1.0f / (settings.noise_tolerance * settings.noise_tolerance);
    pass.lobe_scale = inverse_share * inverse_share;
    pass.far_lobe_scale = inverse_far_share * inverse_far_share;
    const bool first = i < settings.geometric_passes;
    pass.geometric = first && !(tells_edges && i > 0) ? 1 : 0;
    // Passes that compare light keep that of a strip from the surface beside it by its brightness
    pass.checks_steps = (!measured || has_lobes) && all_geometric ? 1 : 0;
    pass.ends_estimate =
        noise_from == NoiseFrom::neighbours && i == settings.geometric_passes - 1 ? 1 : 0;
    pass.only_spread = knows_noise && i == 0 ? 1 : 0;
    pass.harmonic = measured && !(first && tells_edges) ? 1 : 0;
    pass.has_base = has_base ? 1 : 0;
    pass.has_levels = has_levels ? 1 : 0;
    pass.has_lobes = has_lobes ? 1 : 0;
    if (has_far_lobes) pass.far_lobes = far_lobes;
    passes.push_back(pass);
  }
  return passes;
}

}  // namespace lambent
