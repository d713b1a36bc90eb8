// SPDX-License-Identifier: Apache-2.0
// A spatial filter for light that was sampled with few rays. It preserves the edges of surfaces,
// and differences of light that exceed the noise.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <span>

#include "lambent/error.h"

namespace lambent {

/// The GGX lobes that reflect the filtered light, one per pixel. All spans are empty where the
/// light comes from the whole hemisphere. With lobes, light is averaged only over neighbours whose
/// lobes see the same to within a small share of their width: this preserves the images in mirrors,
/// and reflections of close objects in rough surfaces.
struct DenoiseLobes {
  std::span<const glm::vec3> to_viewer_ws;  ///< Unit.
  /// GGX widths, roughness squared; 0 where no lobe reflects, and light there stays as it is.
  std::span<const float> alphas;
  /// Mean of the inverse distance to what the lobe sees [1/m]; 0: infinitely far.
  std::span<const float> inverse_distances;
};

/// The surfaces that the pixels of a picture show, row after row from the top. Spans have width *
/// height elements.
struct DenoiseView {
  int width = 0;                                 ///< Pixels, 1 to 16384.
  int height = 0;                                ///< Pixels, 1 to 16384.
  std::span<const glm::vec3> positions_ws = {};  ///< [m]
  /// Normals that tell surfaces apart: geometric normals for light from the whole hemisphere, since
  /// NoisyLight::base holds the detail of normal maps; shading normals for light of emitters. Unit
  /// length; 0 where the pixel shows no surface, and its light is not changed.
  std::span<const glm::vec3> normals_ws = {};
  std::span<const float> depths = {};  ///< Along the axis of view [m], > 0 where a surface is.
  /// Lobes about the shading normals, for reflected light; empty otherwise.
  DenoiseLobes lobes = {};
};

/// Light that arrives at the pixels' surfaces, without their albedo. Light, base and variances that
/// are not finite count as 0, lest they spread; levels are finite.
struct NoisyLight {
  std::span<const glm::vec3> light;  ///< As it was sampled, >= 0.
  /// An estimate of the same light without noise, such as the irradiance field's lookup. Only the
  /// difference from it is filtered, and the estimate is added back with its detail. Empty: there
  /// is none.
  std::span<const glm::vec3> base = {};
  /// Variance of the light's luminance, from the samples of each pixel. Empty: it is estimated from
  /// neighbouring pixels, which mistakes edges of light for noise.
  std::span<const float> variance = {};
  /// The noise-free quantity by which `light` was divided, such as the unoccluded light; >= 0.
  /// Neighbours with lower levels count less in proportion. Empty: it was not divided. Not together
  /// with `base`. With lobes, both must be empty.
  std::span<const float> levels = {};
  /// Variance of the luminance of light, less its base if any, that was averaged over pictures of
  /// one sample a pixel, from the differences between these pictures. Pass by pass it is averaged
  /// over neighbours, and replaces the noise that is estimated from them: in averages of
  /// reprojected pictures, neighbours have most of their noise in common. All else is as without a
  /// variance. Not together with `variance`. Empty: it is unknown.
  std::span<const float> history_variance = {};
};

/// How light is filtered. The defaults are those for indirect light.
struct DenoiseSettings {
  /// Passes, 1 to 6. Each takes 3 x 3 pixels, those of pass i 2^i pixels apart: pass by pass the
  /// filter reaches 1, 3, 7, 15, 31 and 63 pixels. Cost is in proportion.
  int passes = 6;
  /// Number of first passes that ignore differences of light and stop only at edges of surfaces, 1
  /// to `passes`. The noise is estimated in them, or averaged. Light of few rays needs two, since a
  /// bright ray differs from everything around it. Exceptions:
  /// - light with a base and a variance, unless this is all `passes`: only the first pass ignores
  ///   differences of light, the others of this number stop at those beyond the noise of both
  ///   pixels;
  /// - light with a variance and levels: the first pass averages the variance and leaves the light
  ///   unchanged, and the pixels of all other passes are half as far apart; light that single rare
  ///   samples brought (fireflies) is taken off first and spread over 15 x 15 pixels without regard
  ///   to differences of light.
  int geometric_passes = 2;
  /// Neighbours have the weight exp(-sharpness * (1 - cosine between normals)); 0 to 1024.
  float normal_sharpness = 8.0f;
  /// Neighbours have the weight exp(-d^2), where d is their distance from the pixel's plane,
  /// divided by this share of its depth; above 0 to 1.
  float plane_tolerance = 0.01f;
  /// Neighbours have the weight exp(-(difference of luminance)^2 / (tolerance^2 * its variance));
  /// above 0 to 1024. Lower values preserve more faint detail, and more noise. Noise alone hardly
  /// ever exceeds the default of three standard deviations.
  float noise_tolerance = 3.0f;
  /// With lobes: light is averaged over about this share of their width; 1/1024 to 16. Higher
  /// values leave less noise and blur more: with the default, reflections look as if the surface
  /// were 2 % rougher, with 1 as if it were 8 % rougher.
  float lobe_share = 0.5f;
  /// With lobes, where all passes are geometric: light is averaged also over this share of their
  /// width as if what they see were infinitely far away, 1/1024 to 16; 0: it is not. Where the
  /// light has a variance, this holds for neighbours whose light differs by no more than its noise.
  /// Near what it reflects, a lobe sees something else at each pixel, so that `lobe_share` leaves
  /// noise there; but what a polished surface shows in another one lies far behind it.
  float far_lobe_share = 0.0f;
};

/// Fails with the first setting that is out of range.
Expected<void> check(const DenoiseSettings& settings);

/// Settings for direct light of emissive surfaces, with shading normals.
DenoiseSettings emitter_denoising();

/// Settings with which all passes ignore differences of light: for quantities that are spread over
/// surfaces whatever their noise, and for light of unknown variance that lobes reflect.
DenoiseSettings geometric_denoising();

/// geometric_denoising() for the excess of light that lobes reflect: what single rays brought that
/// are so rare that their light is best spread beyond the lobes that found it.
DenoiseSettings excess_denoising();

/// geometric_denoising() for light that lobes reflect on surfaces that mirrors show.
DenoiseSettings mirrored_denoising();

/// geometric_denoising() for light that lobes reflect, with a variance, of one of `samples`
/// pictures whose mean is shown, >= 1. Of what is near, light is averaged as far as it differs by
/// no more than the noise of that mean.
DenoiseSettings reflection_denoising(int samples);

/// The radius [pixels] around a pixel on which its filtered light depends.
int denoise_reach(const DenoiseSettings& settings);

/// Filters pictures, one after the other, and reuses its memory: 96 bytes for each pixel, 32 more
/// with lobes. Not thread-safe.
class Denoiser {
 public:
  Denoiser();
  ~Denoiser();
  Denoiser(Denoiser&&) noexcept;
  Denoiser& operator=(Denoiser&&) noexcept;

  /// Writes an estimate of what the view's light would be with many more samples: width * height of
  /// vec3, >= 0. Runs on all cores. The result has the same bits on any number of threads, and for
  /// a part of a picture that has denoise_reach() more rows on each side. Fails on sizes and
  /// settings that are out of range and on spans whose sizes are not the view's. `filtered` must
  /// not overlap what is filtered.
  Expected<void> filter(const DenoiseView& view, const NoisyLight& light,
                        const DenoiseSettings& settings, std::span<glm::vec3> filtered);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace lambent
