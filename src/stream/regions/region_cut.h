// SPDX-License-Identifier: Apache-2.0
// Light by regions, so that a client gets that of its surroundings at once and the rest less often.
//
// The probes of a field are cut into blocks, always in the same way. Of each region there are two
// streams, one of every update and one of every eighth: deltas of the same coefficients, whichever
// the client has, so that the light of a region is exact as of the last update that came of it.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "stream/light/geometry.h"
#include "stream/light/light_state.h"

namespace lambent::stream {

// Probes along an edge of a region: of fewer, models learn too little; of more, too much is sent.
inline constexpr int kRegionEdge = 16;
// Regions that are not near are brought up to date every so many updates, each in its turn.
inline constexpr std::uint64_t kFarUpdates = 8;

struct Region {
  int volume = 0;
  glm::ivec3 low{0}, high{0};  ///< Its first and last probes, as they are in memory.
  std::vector<int> probes;     ///< Ascending.
  LightLayout layout;          ///< Of these alone.
};

/// How a field of this geometry is cut. Encoder and decoder come to the same.
class RegionCut {
 public:
  RegionCut(const FieldGeometry& geometry, const LightLayout& layout);

  std::span<const Region> regions() const { return regions_; }
  std::size_t size() const { return regions_.size(); }
  /// Follows probes that came into or out of solid matter.
  void follow(const LightLayout& layout);

 private:
  std::vector<Region> regions_;
};

/// Whether a region's stream of every eighth update has its turn.
inline bool has_its_turn(std::size_t region, std::uint64_t update) {
  return (update + region) % kFarUpdates == 0;
}

/// Where a client is, and how far it cares.
struct Surroundings {
  glm::vec3 position_ws{0.0f};
  glm::vec3 forward_ws{0.0f, 0.0f, -1.0f};  ///< Unit.
  float half_view = 1.0f;                   ///< Of the cone that holds what it sees [rad].
  float radius = 0.0f;  ///< Within this all is near [m]; of what it sees, within twice as much.
};

/// Whether a region is near. Volumes that follow the viewer of the field's own server always are.
bool is_near(const Surroundings& client, const Region& region, const FieldGeometry& geometry);

}  // namespace lambent::stream
