// SPDX-License-Identifier: Apache-2.0
// Light by regions, so that a client gets the light of its surroundings with each update, and the
// rest less often.
//
// The probes of a field are divided into blocks in a fixed way. Each region has two streams, one
// with every update and one with every eighth. Both have deltas of the same coefficients, so that a
// client's light of a region is exactly that of the last update that it received.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "stream/light/geometry.h"
#include "stream/light/light_state.h"

namespace lambent::stream {

// Probes along an edge of a region: with fewer, models adapt too little; with more, too much is
// sent.
inline constexpr int kRegionEdge = 16;
// Regions that are not near are updated in one of this many updates, in turn.
inline constexpr std::uint64_t kFarUpdates = 8;

struct Region {
  int volume = 0;
  glm::ivec3 low{0}, high{0};  ///< Coordinates in memory of its first and last probes.
  std::vector<int> probes;     ///< Ascending.
  LightLayout layout;          ///< Layout of these probes.
};

/// The division of a field with this geometry, which is the same in encoder and decoder.
class RegionCut {
 public:
  RegionCut(const FieldGeometry& geometry, const LightLayout& layout);

  std::span<const Region> regions() const { return regions_; }
  std::size_t size() const { return regions_.size(); }
  /// Updates the layouts after probes came into or out of solid matter.
  void follow(const LightLayout& layout);

 private:
  std::vector<Region> regions_;
};

/// Whether a region's stream of every eighth update has a step in this update.
inline bool has_its_turn(std::size_t region, std::uint64_t update) {
  return (update + region) % kFarUpdates == 0;
}

/// A client's camera, and the radius of its interest.
struct Surroundings {
  glm::vec3 position_ws{0.0f};
  glm::vec3 forward_ws{0.0f, 0.0f, -1.0f};  ///< Unit.
  float half_view = 1.0f;                   ///< Half angle of a cone that contains its view [rad].
  /// Everything within this distance is near [m], and everything in view within twice of it.
  float radius = 0.0f;
};

/// Whether a region is near. Volumes that follow the viewer of the field's server always are.
bool is_near(const Surroundings& client, const Region& region, const FieldGeometry& geometry);

}  // namespace lambent::stream
