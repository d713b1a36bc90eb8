// SPDX-License-Identifier: Apache-2.0
// Gathered light of a small picture, sample after sample.
#pragma once

#include <vector>

#include "compose/gbuffer.h"
#include "gather/gather.h"
#include "shared/color.h"
#include "support/field_scenes.h"

namespace lambent::test {

/// What the scene's first camera sees.
inline GBuffer seen_of(const Stage& stage, const FrameSettings& frame) {
  GBuffer gbuffer;
  trace_gbuffer(stage.world, stage.scene.cameras.at(0), frame, {0, frame.height}, 0, gbuffer);
  return gbuffer;
}

/// Means over all pixels of a picture.
struct ManyGathers {
  double luminance = 0.0;      ///< Of gathered irradiance.
  double variance = 0.0;       ///< Of a pixel's samples.
  double told_variance = 0.0;  ///< What gathers say it is; 0 where a pixel has one ray.
};

inline ManyGathers gather_often(const Stage& stage, const IrradianceField& field,
                                GatherRequest request, uint samples) {
  const std::size_t pixels = request.seen.size();
  std::vector<double> sums(pixels), squares(pixels);
  ManyGathers all;
  GatheredLight light;
  const double share = 1.0 / (static_cast<double>(samples) * static_cast<double>(pixels));
  for (request.sample = 0; request.sample < samples; ++request.sample) {
    gather_irradiance(stage.world, field, request, light);
    for (std::size_t i = 0; i < pixels; ++i) {
      const double level = luminance(light.irradiance[i]);
      sums[i] += level;
      squares[i] += level * level;
      all.luminance += share * level;
      if (!light.variance.empty()) all.told_variance += share * light.variance[i];
    }
  }
  for (std::size_t i = 0; i < pixels; ++i) {
    all.variance +=
        (squares[i] - sums[i] * sums[i] / samples) / (samples - 1) / static_cast<double>(pixels);
  }
  return all;
}

}  // namespace lambent::test
