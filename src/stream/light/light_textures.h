// SPDX-License-Identifier: Apache-2.0
// Textures in which shaders look up streamed light, for WebGL or any other client that renders with
// its own graphics API.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "field/probes/probe_grid.h"
#include "lambent/stream.h"

namespace lambent::stream {

/// Converts the state of a decoder to textures. Tiles have gutters, and are in rows of as many as
/// fit into kWidth; probe p is tile number p.
class LightTextures {
 public:
  /// Texels along a row, which every WebGL 2 and Vulkan device supports.
  static constexpr int kWidth = 2048;

  /// Refers to the decoder, which must outlive it.
  explicit LightTextures(const LightDecoder& decoder) : decoder_(decoder) {}

  /// Updates the textures. To be called after each message that the decoder accepted.
  void follow();

  /// RGB9E5, one word per texel [W/m^2].
  const std::vector<std::uint32_t>& irradiance() const { return irradiance_; }
  /// Two half floats per texel: mean distance [distance_unit of the probe's grid], and mean squared
  /// one.
  const std::vector<std::uint32_t>& distances() const { return distances_; }
  /// Positions of probes [m], one texel each; the fourth number is 0.
  const std::vector<glm::vec4>& places() const { return places_; }
  /// The volumes, in the order in which lookups use them.
  const std::vector<ProbeGrid>& grids() const { return grids_; }

  /// A counter of changes of distances, places and grids.
  std::uint32_t geometry_changes() const { return geometry_changes_; }
  /// CRC-32 of the decoder's coefficients and of all textures.
  std::uint32_t checksum() const;

 private:
  void follow_geometry();
  void store_irradiance(int probe);
  void store_distances(int probe, float unit);

  const LightDecoder& decoder_;
  std::uint64_t geometry_ = 0;
  std::uint32_t geometry_changes_ = 0;
  std::vector<std::uint32_t> irradiance_, distances_;
  std::vector<glm::vec4> places_;
  std::vector<ProbeGrid> grids_;
  std::vector<glm::vec3> light_;
  std::vector<glm::vec2> moments_;
};

}  // namespace lambent::stream
