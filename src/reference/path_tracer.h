// SPDX-License-Identifier: Apache-2.0
// The reference: an unbiased path tracer that every method's error is measured against.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <vector>

#include "lambent/image.h"
#include "lambent/progress.h"
#include "lambent/world.h"
#include "raytracing/raytracer.h"
#include "reference/strategy.h"

namespace lambent {

inline constexpr int kUnboundedBounces = std::numeric_limits<int>::max();

/// Cost and quality of a reference image.
struct ReferenceSettings {
  int width = 1280;  ///< Pixels, 1 to 16384.
  int height = 720;  ///< Pixels, 1 to 16384.
  int samples = 64;  ///< Paths a pixel, >= 1. Four times as many halve the noise.
  int max_bounces =
      kUnboundedBounces;   ///< Bounces of indirect light, >= 0; Russian roulette ends longer paths.
  std::uint32_t seed = 1;  ///< Images of different seeds have independent noise.
  bool layer_errors =
      false;  ///< Also store the standard error of each layer of light ("direct.error", ...).
  reference::Strategy strategy =
      reference::Strategy::combined;  ///< How lights are sampled; for tests.
  float unlit_radiance = 1.0f;        ///< See FrameSettings.
};

/// A reference image, rendered in independent passes whose differences give the error.
struct ReferenceResult {
  /// Pixel means (box filter): "" (= direct + indirect + glossy + transmission + emission + fog),
  /// direct, indirect, irradiance, glossy, transmission, emission, fog, albedo, normal. From the
  /// ray through the pixel's middle: position, depth (both 0 where nothing is hit). "error" is the
  /// standard error of "".
  LayeredImage image;
  /// Root mean square of "error" over the mean of "", in luminance; infinite with a single sample.
  double relative_standard_error = 0.0;
  std::uint64_t rays = 0;  ///< Number of rays traced, of all kinds.
  double ms = 0.0;         ///< Wall-clock time.
};

/// Renders on all threads of the task scheduler; the result does not depend on their number.
ReferenceResult render_reference(const World& world, const Camera& camera,
                                 const ReferenceSettings& settings,
                                 const ProgressFn& progress = {});

/// A point of a surface (real or imagined).
struct SurfacePoint {
  glm::vec3 position_ws{0.0f};            ///< [m].
  glm::vec3 normal_ws{0.0f, 1.0f, 0.0f};  ///< Unit.
};

/// An estimate and the standard error of its mean.
struct Estimate {
  glm::vec3 mean{0.0f};
  glm::vec3 standard_error{0.0f};
};

/// The part of the light to estimate, as in the layers of the image.
enum class LightKind : std::uint8_t { all, direct, indirect };

/// Irradiance [W/m^2] at points, from `samples` (>= 2) paths each. Uses all threads; the result
/// does not depend on their number.
std::vector<Estimate> reference_irradiance(
    const World& world, std::span<const SurfacePoint> points, int samples, std::uint32_t seed,
    LightKind which = LightKind::all, reference::Strategy strategy = reference::Strategy::combined,
    int max_bounces = kUnboundedBounces);

/// Radiance [W/(m^2 sr)] that arrives against a ray, from `samples` (>= 2) paths.
Estimate reference_radiance(const World& world, const Ray& ray, int samples, std::uint32_t seed,
                            reference::Strategy strategy = reference::Strategy::combined);

}  // namespace lambent
