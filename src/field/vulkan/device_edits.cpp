// SPDX-License-Identifier: Apache-2.0
// Recording of the passes that apply edits, store last estimates, and scatter importance.
#include "field/schedule/importance_math.h"
#include "field/vulkan/field_resources.h"
#include "vulkan/device_memory.h"

namespace lambent {

void FieldResources::record_surfel_distances(vulkan::Recorder& to, const DeviceProbes& list,
                                             FloatArray distances, UintArray blocked) const {
  const SurfelDistancesArguments arguments = {store(),
                                              arrays(list),
                                              {surfels_.address()},
                                              distances,
                                              blocked,
                                              list.count(),
                                              stride_,
                                              round_up(list.most_rays, kLaneGroupSize)};
  run_over(to, kernels_.surfel_distances, arguments, list, kOverLaneGroups);
  to.barrier();
}

void FieldResources::record_seen_surfels(vulkan::Recorder& to, const DeviceProbes& list) {
  record_surfel_distances(to, list, {ray_distances_.address()}, {blocked_.address()});
}

void FieldResources::reserve_rays_before(const DeviceProbes& list) {
  const auto count = static_cast<std::size_t>(list.count());
  const int stride = round_up(list.most_rays, kLaneGroupSize);
  reserve_seen(list);
  reserve<float>(device_, count * stride, "distances of rays before", ray_distances_before_);
  reserve<uint>(device_, count, "probes in solid matter before", blocked_before_);
  reserve<float>(device_, count * stride, "direct light along rays before", ray_lights_before_);
}

void FieldResources::record_rays_before(vulkan::Recorder& to, const DeviceProbes& list) {
  reserve_rays_before(list);
  record_surfel_distances(to, list, {ray_distances_before_.address()}, {blocked_before_.address()});
  record_ray_lights(to, list, kKeepLight, {});
}

void FieldResources::record_edited_light(vulkan::Recorder& to, const DeviceProbes& list,
                                         EditedLightArray edited) const {
  record_ray_lights(to, list, kCompareLight, edited);
}

void FieldResources::record_ray_lights(vulkan::Recorder& to, const DeviceProbes& list, uint step,
                                       EditedLightArray edited) const {
  const EditedLightArguments arguments = {arrays(list),
                                          {surfels_.address()},
                                          {ray_lights_before_.address()},
                                          edited,
                                          list.count(),
                                          stride_,
                                          round_up(list.most_rays, kLaneGroupSize),
                                          step};
  run_over(to, kernels_.edited_light, arguments, list, kOverLanes);
  to.barrier();
}

void FieldResources::record_move_distances(vulkan::Recorder& to, const DeviceProbes& list,
                                           uint dither_seed) {
  record_seen_surfels(to, list);
  const int edge = settings_.distance_texels;
  const MoveDistancesArguments arguments = {store(),
                                            arrays(list),
                                            {ray_distances_before_.address()},
                                            {blocked_before_.address()},
                                            {ray_distances_.address()},
                                            {blocked_.address()},
                                            list.count(),
                                            round_up(list.most_rays, kLaneGroupSize),
                                            dither_seed};
  to.run(kernels_.move_distances, arguments, edge * edge, list.count());
  to.barrier();
  record_distance_gutters(to, list);
}

void FieldResources::record_scatter_importance(vulkan::Recorder& to, const DeviceProbes& list,
                                               FloatArray received, UintArray sent,
                                               float scale) const {
  const ScatterImportanceArguments arguments = {arrays(list),
                                                {corners_.address()},
                                                {surfels_.address()},
                                                {lookup_records_.address()},
                                                received,
                                                sent,
                                                list.count(),
                                                stride_,
                                                scale};
  to.run(kernels_.scatter_importance, arguments, groups_of(list.most_rays, kSurfelsPerScatter),
         list.count());
  to.barrier();
}

void FieldResources::record_last_estimates(vulkan::Recorder& to, const DeviceProbes& list,
                                           Vec4Array solution) const {
  const ScatterTilesArguments arguments = {
      list.index_array(), solution, {last_irradiance_estimate_.address()}, list.count()};
  to.run(kernels_.scatter_tiles, arguments, tile_texels(), list.count());
  to.barrier();
}

}  // namespace lambent
