// SPDX-License-Identifier: Apache-2.0
// Maps on a Vulkan device: they are traced and their texels clustered there.
#pragma once

#include <cstddef>
#include <vector>

#include "lambent/rsm.h"
#include "raytracing/vulkan/device_world.h"
#include "raytracing/vulkan/hit_shading.h"
#include "rsm/maps/lights.h"
#include "rsm/vulkan/device_maps.h"
#include "rsm/vulkan/passes_vulkan.h"
#include "vulkan/buffer.h"
#include "vulkan/kernel.h"
#include "vulkan/recorder.h"

namespace lambent {

/// Maps in a device's memory: resolution^2 RsmTexelRecords for each, one map after the other.
struct RsmMapsOnDevice {
  int resolution = 0;
  std::vector<RsmProjection> projections;  ///< One for each map.
  vulkan::Buffer texels;                   ///< May be larger than needed.
  /// There is room for one map alone, which is rendered before it is read; see keeps_one_map().
  bool one_at_a_time = false;

  std::size_t texels_of_map() const { return static_cast<std::size_t>(resolution) * resolution; }
  /// Address of a map's first texel.
  RsmTexelArray of(std::size_t map) const {
    return {texels.address() + first_texel(map) * sizeof(RsmTexelRecord)};
  }
  std::size_t first_texel(std::size_t map) const {
    return one_at_a_time ? 0 : map * texels_of_map();
  }
};

/// Whether maps are rendered and read one after the other, so that memory does not grow with the
/// number of lights: where the gather does not read them later.
bool keeps_one_map(const RsmSettings& settings);

/// Copies a map, which must have been rendered, to the host. Waits for the device.
ReflectiveShadowMap download_map(const vulkan::Device& device, const RsmMapsOnDevice& maps,
                                 std::size_t map);
/// The same for all maps.
std::vector<ReflectiveShadowMap> download_maps(const vulkan::Device& device,
                                               const RsmMapsOnDevice& maps);

/// The kernels, owned by the device (Device::kept).
struct RsmMapKernels {
  explicit RsmMapKernels(const vulkan::Device& device);
  vulkan::Kernel map_rays, map_texels, camera_texels, view_points, clusters, weigh;
};

/// Renders maps and chooses the texels that are gathered. Keeps memory for one map's rays (76 bytes
/// a texel; for a camera's 168) and clusters (12 bytes a texel).
class RsmMapperVulkan {
 public:
  /// The device must outlive it.
  explicit RsmMapperVulkan(const vulkan::Device& device);

  /// render_rsms(), for a world on this device; `maps` reuses its memory. Waits for the device.
  void render(const World& world, const Camera& camera, float aspect, const RsmSettings& settings,
              RsmMapsOnDevice& maps);

  /// The same, but where keeps_one_map(), nothing is rendered yet: `make` has to be called for each
  /// map before it is read.
  void prepare(const World& world, const Camera& camera, float aspect, const RsmSettings& settings,
               RsmMapsOnDevice& maps);
  /// Renders a light's map. Waits for the device; returns the time that took [ms].
  double make(const DeviceWorld& world, const RsmMapsOnDevice& maps, std::size_t light);

  /// choose_lights(). Blocks of texels are clustered and weighted on the device, and the remaining
  /// few clusters are merged on the host. Waits for the device, including the view. Where maps are
  /// stored one at a time, renders them; `map_ms`: the time that took.
  RsmLights choose(const RsmMapsOnDevice& maps, const RsmViewOnDevice& view,
                   const RsmSettings& settings, const DeviceWorld* world = nullptr,
                   double* map_ms = nullptr);

 private:
  /// Sets the projections, and makes room for maps and their rays.
  void reserve(const World& world, const Camera& camera, float aspect, const RsmSettings& settings,
               RsmMapsOnDevice& maps);
  void trace(vulkan::Recorder& to, const DeviceWorld& world, const MapProjection& projection,
             int resolution);
  void make_texels(vulkan::Recorder& to, const DeviceWorld& world, const RsmMapsOnDevice& maps,
                   std::size_t light);
  void make_camera_texels(vulkan::Recorder& to, const DeviceWorld& world,
                          const RsmMapsOnDevice& maps, const RsmSettings& settings);
  ViewPoints find_view_points(const RsmViewOnDevice& view, const RsmSettings& settings);
  std::vector<ClusterRecord> cluster_blocks(const RsmMapsOnDevice& maps, std::size_t map,
                                            bool weigh);

  const vulkan::Device& device_;
  const RsmMapKernels& kernels_;
  HitShading shading_;
  vulkan::Buffer rays_, hits_, points_, shaded_, irradiance_, first_index_;
  vulkan::Buffer view_point_memory_, view_point_count_, cluster_memory_;
};

}  // namespace lambent
