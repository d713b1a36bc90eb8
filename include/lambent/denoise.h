// SPDX-License-Identifier: Apache-2.0
// A spatial filter for light that few rays sampled: keeps edges of surfaces, and whatever stands
// out from the noise.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <span>

#include "lambent/error.h"

namespace lambent {

/// Lobes of GGX coats that reflect the light which is filtered, a pixel each; all spans are empty
/// where light comes from the whole hemisphere. Light is then averaged no farther than neighbouring
/// lobes see the same, over a small share of their width: mirrors keep what they show, and rough
/// coats, too, what stands close to them.
struct DenoiseLobes {
  std::span<const glm::vec3> to_viewer_ws;  ///< Unit.
  /// GGX widths, roughness squared; 0 where no lobe reflects, and light there stays as it is.
  std::span<const float> alphas;
  /// One over the distance to what the lobe sees, on average [1/m]; 0: it is infinite.
  std::span<const float> inverse_distances;
};

/// What the pixels of a picture show, row after row from the top. Spans have width * height
/// elements.
struct DenoiseView {
  int width = 0;                            ///< Pixels, 1 to 16384.
  int height = 0;                           ///< Pixels, 1 to 16384.
  std::span<const glm::vec3> positions_ws;  ///< [m]
  /// By which surfaces are told apart: geometric ones for light from the whole hemisphere, whose
  /// detail of normal maps is in NoisyLight::base; shading normals for light of emitters. Unit; 0
  /// where nothing is seen, and light there stays as it is.
  std::span<const glm::vec3> normals_ws;
  std::span<const float> depths;  ///< Distance along the axis of view [m], > 0 where a surface is.
  DenoiseLobes lobes = {};        ///< Of coats with the shading normals, if these are filtered.
};

/// Light that arrives at the pixels' surfaces, without their albedo. Light, base and variance that
/// are not finite count as 0, lest they spread; levels are finite.
struct NoisyLight {
  std::span<const glm::vec3> light;  ///< As it was sampled, >= 0.
  /// The same light as another method knows it, without noise, such as the irradiance field's
  /// lookup: the difference alone is filtered, and its detail is added back. Empty: there is none.
  std::span<const glm::vec3> base;
  /// Variance of the light's luminance, from the samples of each pixel. Empty: it is estimated
  /// from neighbouring pixels, which takes edges of light for noise.
  std::span<const float> variance;
  /// What `light` was divided by, such as the light that would arrive if nothing were in the way,
  /// without noise; >= 0. Neighbours with lower levels count less in proportion. Empty: nothing.
  /// Not together with `base`. Light that lobes reflect has neither.
  std::span<const float> levels = {};
};

/// How light is filtered. The defaults are those for indirect light.
struct DenoiseSettings {
  /// Passes, 1 to 6. Each takes 3 x 3 pixels, those of pass i 2^i pixels apart: pass by pass the
  /// filter reaches 1, 3, 7, 15, 31 and 63 pixels. Cost is in proportion.
  int passes = 6;
  /// First passes that know no difference of light, only surfaces, 1 to `passes`. They tell how
  /// much noise there is. Light of few rays needs two: a bright ray differs from all around it.
  /// Where both variance and levels are given, the first pass averages the variance and leaves the
  /// light as it is; all others are half as far apart.
  int blind_passes = 2;
  /// Neighbours weigh exp(-sharpness * (1 - cosine between normals)); 0 to 1024.
  float normal_sharpness = 8.0f;
  /// Neighbours weigh exp(-d^2), where d is their distance from the pixel's plane over this share
  /// of its depth; above 0 to 1.
  float plane_tolerance = 0.01f;
  /// Neighbours weigh exp(-(difference of luminance)^2 / (tolerance^2 * variance of it)); above 0
  /// to 1024. Less keeps more of faint detail, and more noise. Three standard deviations: what
  /// noise alone hardly ever is.
  float noise_tolerance = 3.0f;
};

/// Fails with the first setting that is out of range.
Expected<void> check(const DenoiseSettings& settings);

/// Settings for direct light of emissive surfaces, with shading normals.
DenoiseSettings emitter_denoising();

/// Settings that know no difference of light: for what is spread over surfaces whatever its noise,
/// and for light that lobes reflect.
DenoiseSettings blind_denoising();

/// Pixels around one that its filtered light depends on, to each side.
int denoise_reach(const DenoiseSettings& settings);

/// Filters pictures, one after the other, and keeps its memory: 96 bytes for each pixel, 32 more
/// with lobes. Not thread-safe.
class Denoiser {
 public:
  Denoiser();
  ~Denoiser();
  Denoiser(Denoiser&&) noexcept;
  Denoiser& operator=(Denoiser&&) noexcept;

  /// Writes what the view's light would be with many more samples: width * height of vec3, >= 0.
  /// Runs on all cores; the same bits on any number of threads, and for a part of a picture that
  /// has denoise_reach() more rows on each side. Fails on sizes and settings that are out of range
  /// and on spans whose sizes are not the view's.
  Expected<void> filter(const DenoiseView& view, const NoisyLight& light,
                        const DenoiseSettings& settings, std::span<glm::vec3> filtered);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace lambent
