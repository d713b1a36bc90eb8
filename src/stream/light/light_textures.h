// SPDX-License-Identifier: Apache-2.0
// What a client's shader looks streamed light up in: the textures of a WebGL or any other client
// that renders with a graphics API of its own.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "field/probes/probe_grid.h"
#include "lambent/stream.h"

namespace lambent::stream {

/// Follows a decoder. Tiles are kept with their gutters, row after row of as many as fit into
/// kWidth; probe p is tile number p.
class LightTextures {
 public:
  /// Texels along a row, which every WebGL 2 and Vulkan device has.
  static constexpr int kWidth = 2048;

  /// Refers to the decoder, which must outlive it.
  explicit LightTextures(const LightDecoder& decoder) : decoder_(decoder) {}

  /// Brings the textures up to date. To be called after each message that the decoder took.
  void follow();

  /// RGB9E5, a word a texel [W/m^2].
  const std::vector<std::uint32_t>& irradiance() const { return irradiance_; }
  /// Two halves a texel: mean distance [distance_unit of the probe's grid], and mean squared one.
  const std::vector<std::uint32_t>& distances() const { return distances_; }
  /// Where probes are [m], a texel each; the fourth number is 0.
  const std::vector<glm::vec4>& places() const { return places_; }
  /// The volumes, in the order in which lookups use them.
  const std::vector<ProbeGrid>& grids() const { return grids_; }

  /// Counts up with every change of distances, places and grids.
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
