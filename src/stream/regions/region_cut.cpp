// SPDX-License-Identifier: Apache-2.0
#include "stream/regions/region_cut.h"

#include <algorithm>
#include <cmath>

namespace lambent::stream {
namespace {

Region region_of(const ProbeGrid& grid, int volume, const glm::ivec3& low, int texels) {
  Region region;
  region.volume = volume;
  region.low = low;
  region.high = glm::min(low + kRegionEdge, grid.count) - 1;
  for (int z = low.z; z <= region.high.z; ++z) {
    for (int y = low.y; y <= region.high.y; ++y) {
      for (int x = low.x; x <= region.high.x; ++x) {
        region.probes.push_back(grid.first + x + grid.count.x * (y + grid.count.y * z));
      }
    }
  }
  const glm::ivec3 count = region.high - low + 1;
  region.layout.texels = texels;
  region.layout.add_volume({count.x, count.y, count.z});
  return region;
}

}  // namespace

RegionCut::RegionCut(const FieldGeometry& geometry, const LightLayout& layout) {
  for (std::size_t v = 0; v < geometry.volumes.size(); ++v) {
    const ProbeGrid& grid = geometry.volumes[v].grid;
    for (int z = 0; z < grid.count.z; z += kRegionEdge) {
      for (int y = 0; y < grid.count.y; y += kRegionEdge) {
        for (int x = 0; x < grid.count.x; x += kRegionEdge) {
          regions_.push_back(region_of(grid, static_cast<int>(v), {x, y, z}, layout.texels));
        }
      }
    }
  }
  follow(layout);
}

void RegionCut::follow(const LightLayout& layout) {
  for (Region& region : regions_) {
    for (std::size_t i = 0; i < region.probes.size(); ++i) {
      region.layout.lit[i] = layout.lit[region.probes[i]];
    }
  }
}

bool is_near(const Surroundings& client, const Region& region, const FieldGeometry& geometry) {
  const Volume& volume = geometry.volumes[region.volume];
  if (volume.role.follows_viewer) return true;
  const ProbeGrid& grid = volume.grid;
  // The light of a probe extends to the neighbouring probes
  const glm::vec3 low = glm::vec3(region.low) - 1.0f, high = glm::vec3(region.high) + 1.0f;
  const glm::vec3 here = grid_coords(grid, client.position_ws);
  const float distance = glm::length((here - glm::clamp(here, low, high)) * grid.spacing);
  if (distance <= client.radius) return true;
  if (distance > 2.0f * client.radius) return false;
  const glm::vec3 to_centre = grid_position(grid, 0.5f * (low + high)) - client.position_ws;
  const float reach = 0.5f * glm::length((high - low) * grid.spacing), far = glm::length(to_centre);
  if (far <= reach) return true;
  const float off =
      std::acos(std::clamp(glm::dot(to_centre, client.forward_ws) / far, -1.0f, 1.0f));
  return off <= client.half_view + std::asin(reach / far);
}

}  // namespace lambent::stream
