// SPDX-License-Identifier: Apache-2.0
#include "rsm/vulkan/maps_vulkan.h"

#include <cassert>
#include <cstdint>
#include <span>

#include "core/stopwatch.h"
#include "lambent/world.h"
#include "raytracing/world_access.h"
#include "rsm/maps/map.h"
#include "rsm/to_records.h"
#include "shaders/rsm_camera_texels_comp.h"
#include "shaders/rsm_clusters_comp.h"
#include "shaders/rsm_map_rays_comp.h"
#include "shaders/rsm_map_texels_comp.h"
#include "shaders/rsm_view_points_comp.h"
#include "shaders/rsm_weigh_comp.h"

namespace lambent {

bool keeps_one_map(const RsmSettings& settings) {
  return settings.pattern == RsmPattern::whole && settings.layout != RsmLayout::full &&
         settings.texels > 0 && !settings.from_camera;
}

ReflectiveShadowMap download_map(const vulkan::Device& device, const RsmMapsOnDevice& maps,
                                 std::size_t map) {
  ReflectiveShadowMap result;
  result.projection = maps.projections[map];
  result.resolution = maps.resolution;
  result.texels.resize(maps.texels_of_map());
  vulkan::read(device, maps.texels, std::span(result.texels), maps.first_texel(map));
  return result;
}

std::vector<ReflectiveShadowMap> download_maps(const vulkan::Device& device,
                                               const RsmMapsOnDevice& maps) {
  assert(!maps.one_at_a_time);
  std::vector<ReflectiveShadowMap> result;
  for (std::size_t i = 0; i < maps.projections.size(); ++i) {
    result.push_back(download_map(device, maps, i));
  }
  return result;
}

RsmMapKernels::RsmMapKernels(const vulkan::Device& device)
    : map_rays(device, shaders::rsm_map_rays_comp(), "rsm.map_rays"),
      map_texels(device, shaders::rsm_map_texels_comp(), "rsm.map_texels"),
      camera_texels(device, shaders::rsm_camera_texels_comp(), "rsm.camera_texels"),
      view_points(device, shaders::rsm_view_points_comp(), "rsm.view_points"),
      clusters(device, shaders::rsm_clusters_comp(), "rsm.clusters"),
      weigh(device, shaders::rsm_weigh_comp(), "rsm.weigh") {}

RsmMapperVulkan::RsmMapperVulkan(const vulkan::Device& device)
    : device_(device), kernels_(device.kept<RsmMapKernels>()), shading_(device) {}

void RsmMapperVulkan::trace(vulkan::Recorder& to, const DeviceWorld& world,
                            const MapProjection& projection, int resolution) {
  const auto edge = static_cast<std::uint32_t>(resolution);
  const MapRaysArguments arguments = {{rays_.address()}, projection, resolution, kRayMeetsAll};
  to.run(kernels_.map_rays, arguments, edge, edge);
  to.barrier();
  world.tracer().closest_hits(to, {{rays_.address()}, edge * edge}, {hits_.address()});
  to.barrier();
}

void RsmMapperVulkan::make_texels(vulkan::Recorder& to, const DeviceWorld& world,
                                  const RsmMapsOnDevice& maps, std::size_t light) {
  const MapProjection projection = to_record(maps.projections[light]);
  trace(to, world, projection, maps.resolution);
  const MapTexelsArguments arguments = {world.scene().address(),
                                        {rays_.address()},
                                        {hits_.address()},
                                        maps.of(light),
                                        projection,
                                        maps.resolution,
                                        static_cast<uint>(light),
                                        0};
  const auto edge = static_cast<std::uint32_t>(maps.resolution);
  to.run(kernels_.map_texels, arguments, edge, edge);
  to.barrier();
}

void RsmMapperVulkan::make_camera_texels(vulkan::Recorder& to, const DeviceWorld& world,
                                         const RsmMapsOnDevice& maps, const RsmSettings& settings) {
  const MapProjection projection = to_record(maps.projections.front());
  const auto edge = static_cast<std::uint32_t>(maps.resolution);
  to.fill(first_index_, 0u);
  trace(to, world, projection, maps.resolution);
  const DeviceShadedHits shaded = {
      {points_.address()}, {shaded_.address()}, {irradiance_.address()}};
  shading_.shade_hits(to, {world.scene(), world.tracer()},
                      {{rays_.address()}, {hits_.address()}, edge * edge}, {first_index_.address()},
                      edge * edge, camera_shading(settings), shaded);
  const CameraTexelsArguments arguments = {
      world.scene().address(), {rays_.address()}, {hits_.address()}, shaded.points,   shaded.shaded,
      shaded.irradiance,       maps.of(0),        projection,        maps.resolution, 0};
  to.run(kernels_.camera_texels, arguments, edge, edge);
  to.barrier();
}

void RsmMapperVulkan::reserve(const World& world, const Camera& camera, float aspect,
                              const RsmSettings& settings, RsmMapsOnDevice& maps) {
  assert(check(settings) && device_world_of(world) != nullptr);
  maps.resolution = settings.resolution;
  maps.projections.clear();
  if (settings.from_camera) {
    maps.projections.push_back(camera_projection(camera, aspect));
  } else {
    for (const Light& light : world.scene().lights) {
      maps.projections.push_back(fit_projection(world.scene(), light));
    }
  }
  const std::size_t rays = maps.texels_of_map();
  const std::size_t kept = maps.one_at_a_time ? 1 : maps.projections.size();
  maps.texels.reserve(device_, kept * rays * sizeof(RsmTexel), "rsm.maps");
  rays_.reserve(device_, rays * sizeof(RayRecord), "rsm.map_rays");
  hits_.reserve(device_, rays * sizeof(HitRecord), "rsm.map_hits");
  if (settings.from_camera) {
    points_.reserve(device_, rays * sizeof(LitPointRecord), "rsm.map_points");
    shaded_.reserve(device_, rays * sizeof(ShadedHitRecord), "rsm.map_shaded");
    irradiance_.reserve(device_, rays * sizeof(vec3), "rsm.map_irradiance");
    first_index_.reserve(device_, sizeof(std::uint32_t), "rsm.map_first_index");
  }
}

void RsmMapperVulkan::render(const World& world, const Camera& camera, float aspect,
                             const RsmSettings& settings, RsmMapsOnDevice& maps) {
  maps.one_at_a_time = false;
  reserve(world, camera, aspect, settings, maps);
  const DeviceWorld& on_device = *device_world_of(world);
  device_.run([&](vulkan::Recorder& to) {
    to.bind_textures(on_device.scene().textures());
    if (settings.from_camera) return make_camera_texels(to, on_device, maps, settings);
    for (std::size_t i = 0; i < maps.projections.size(); ++i) make_texels(to, on_device, maps, i);
  });
}

void RsmMapperVulkan::prepare(const World& world, const Camera& camera, float aspect,
                              const RsmSettings& settings, RsmMapsOnDevice& maps) {
  if (!keeps_one_map(settings)) return render(world, camera, aspect, settings, maps);
  maps.one_at_a_time = true;
  reserve(world, camera, aspect, settings, maps);
}

double RsmMapperVulkan::make(const DeviceWorld& world, const RsmMapsOnDevice& maps,
                             std::size_t light) {
  Stopwatch watch;
  device_.run([&](vulkan::Recorder& to) {
    to.bind_textures(world.scene().textures());
    make_texels(to, world, maps, light);
  });
  return watch.lap();
}

ViewPoints RsmMapperVulkan::find_view_points(const RsmViewOnDevice& view,
                                             const RsmSettings& settings) {
  view_point_memory_.reserve(device_, 2 * kViewPoints * sizeof(vec3), "rsm.view_points");
  view_point_count_.reserve(device_, sizeof(int), "rsm.view_point_count");
  const ViewPointsArguments arguments = {view.arrays,
                                         {view_point_memory_.address()},
                                         {view_point_count_.address()},
                                         view.width,
                                         view.height,
                                         settings.seed,
                                         0};
  device_.run([&](vulkan::Recorder& to) { to.run(kernels_.view_points, arguments, 1); });
  std::vector<vec3> vectors(2 * kViewPoints);
  int count = 0;
  vulkan::read(device_, view_point_memory_, std::span(vectors));
  vulkan::read(device_, view_point_count_, std::span(&count, 1));
  ViewPoints points(kViewPoints);
  for (int i = 0; i < count; ++i) points.add(vectors[i], vectors[kViewPoints + i]);
  return points;
}

std::vector<ClusterRecord> RsmMapperVulkan::cluster_blocks(const RsmMapsOnDevice& maps,
                                                           std::size_t map, bool weigh) {
  const int blocks = (maps.resolution + kBlockEdge - 1) / kBlockEdge;
  const int count = blocks * blocks * kBlockSurfaces;
  cluster_memory_.reserve(device_, static_cast<std::size_t>(count) * sizeof(ClusterRecord),
                          "rsm.clusters");
  device_.run([&](vulkan::Recorder& to) {
    const ClusterArguments arguments = {
        maps.of(map), {cluster_memory_.address()}, maps.resolution, blocks};
    to.run(kernels_.clusters, arguments, static_cast<std::uint32_t>(blocks),
           static_cast<std::uint32_t>(blocks));
    to.barrier();
    if (!weigh) return;
    const WeighArguments weighing = {
        {view_point_memory_.address()}, {cluster_memory_.address()}, count, 0};
    to.run(kernels_.weigh, weighing, static_cast<std::uint32_t>(count));
    to.barrier();
  });
  std::vector<ClusterRecord> records(count);
  vulkan::read(device_, cluster_memory_, std::span(records));
  return records;
}

RsmLights RsmMapperVulkan::choose(const RsmMapsOnDevice& maps, const RsmViewOnDevice& view,
                                  const RsmSettings& settings, const DeviceWorld* world,
                                  double* map_ms) {
  assert(!maps.one_at_a_time || (world != nullptr && map_ms != nullptr));
  // Where all texels are gathered, or read in the order as rendered, download all maps
  const bool full = settings.layout == RsmLayout::full;
  std::vector<ReflectiveShadowMap> on_host;
  if (settings.texels == 0 || full) on_host = download_maps(device_, maps);
  const bool by_view = settings.view_importance && settings.texels > 0;
  const ViewPoints points = by_view ? find_view_points(view, settings) : ViewPoints(0);
  const bool weigh = points.count > 0;
  std::vector<ChosenOfMap> chosen(maps.projections.size());
  for (std::size_t m = 0; m < chosen.size(); ++m) {
    chosen[m].texels = static_cast<std::uint32_t>(maps.texels_of_map());
    if (settings.texels == 0) {
      chosen[m].chosen = all_texels(on_host[m]);
      continue;
    }
    if (maps.one_at_a_time) *map_ms += make(*world, maps, m);
    std::vector<Cluster> clusters;
    std::vector<TermSums> sums;
    for (const ClusterRecord& record : cluster_blocks(maps, m, weigh)) {
      if (record.found == 0) continue;
      clusters.push_back({to_texel(record.texel), record.place, 0.0f, 0.0f});
      sums.push_back(weigh ? record.brought : TermSums{1.0f, 1.0f});
    }
    chosen[m].chosen = choose_clusters(std::move(clusters), sums, points, settings);
  }
  if (merges_maps(settings, chosen.size())) chosen = {merge_maps(chosen, points, settings)};
  RsmLights lights = deal_lights(chosen, settings);
  if (!full) return lights;
  std::vector<RsmTexel> rendered;
  for (const ReflectiveShadowMap& map : on_host) {
    rendered.insert(rendered.end(), map.texels.begin(), map.texels.end());
  }
  place_rendered(std::move(rendered), lights);
  return lights;
}

}  // namespace lambent
