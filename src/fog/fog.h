// SPDX-License-Identifier: Apache-2.0
// Fog of a frame on the processor: its light in froxels, and its effect on light along rays.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "fog/froxels.h"
#include "lambent/error.h"
#include "lambent/fog.h"
#include "lambent/world.h"
#include "scene/media/media.h"

namespace lambent {

class IrradianceField;
class ProbeStore;

/// Fails with the first setting that is out of range.
Expected<void> check(const FogSettings& settings);

/// Fails where this many rows of pixels would have more froxels than memory should hold.
Expected<void> check_froxels(const FogSettings& settings, int width, int rows);

/// Whether a scene has fog.
bool has_fog(const Scene& scene);

/// The fog of a picture, and how its light is computed.
struct FogRequest {
  const World& world;
  const IrradianceField* field = nullptr;  ///< Supplies multi-bounce light; null: there is none.
  FogSettings settings = {};
  CameraRecord camera = {};
  int width = 0, height = 0;    ///< Size of the picture [pixels].
  int first_row = 0, rows = 0;  ///< Rows of pixels that will call FroxelFog::along.
  int tree_samples = 1;         ///< Samples of the light tree at a froxel's point.
  std::uint32_t frame = 0;      ///< Makes random numbers of frames differ.
  std::uint32_t seed = 1;
  int averaged_frames = 1;  ///< Number of frames that light is averaged over; 1: this one alone.
};

/// The froxels of a sequence of frames.
class FroxelFog {
 public:
  /// Computes the light of a picture's froxels. `continues`: neither light nor fog has changed
  /// since the last call. Returns the number of rays traced.
  std::uint64_t find_light(const FogRequest& request, bool continues);

  /// Radiance and transmittance of the fog along a ray of the camera through a point of the
  /// picture; see fog_along() of froxels.inl.h.
  vec4 along(const glm::vec2& pixel, const glm::vec3& origin_ws, const glm::vec3& direction_ws,
             float ray_end) const;

  const FroxelGrid& grid() const { return grid_; }
  const Media& media() const { return media_; }
  /// The froxels that `along` reads: the source function times its weight, and the weight.
  std::span<const vec4> froxels() const { return smoothed_; }

 private:
  struct Columns;
  struct FroxelSample;
  std::uint64_t trace_columns(const FogRequest& request);
  void place_slices(const FogRequest& request);
  void queue_light(const FogRequest& request, const FroxelSample& sample, RandomStream random,
                   Columns& columns) const;
  void light_froxel(const FogRequest& request, const ProbeStore* store, const glm::uvec3& at,
                    Columns& columns);
  void light_columns(const FogRequest& request, const ProbeStore* store, Columns& columns);
  void average(const FroxelGrid& before, int frames);
  void smooth();
  glm::uvec3 froxel_at(std::size_t index) const;

  Media media_;
  FroxelGrid grid_{};
  std::vector<float> ray_ends_;  // lengths of the columns' rays [m]
  std::vector<vec4> lit_, averaged_, smoothed_;
};

}  // namespace lambent
