// SPDX-License-Identifier: Apache-2.0
#include "field/edits/device_history.h"

#include <array>

#include "field/edits/history_ratio_math.h"
#include "shaders/gather_tiles_comp.h"
#include "shaders/history_ratio_comp.h"
#include "shaders/keep_unchanged_comp.h"
#include "shaders/scale_light_comp.h"
#include "vulkan/device_memory.h"

namespace lambent {

using vulkan::Buffer, vulkan::Memory, vulkan::Recorder;

DeviceHistory::DeviceHistory(FieldResources& field, DeviceSolver& solver, const ProbeStates& probes,
                             const DeviceProbes& largest)
    : field_(field), solver_(solver), probes_(probes) {
  const vulkan::Device& device = field.device();
  const std::array constants =
      tile_constants(field.settings(), field.volumes(), field.lookups_per_surfel());
  const auto kernel = [&](vulkan::Spirv spirv, const char* name) {
    return vulkan::Kernel(device, spirv, name, constants);
  };
  gather_tiles_ = kernel(shaders::gather_tiles_comp(), "gather_tiles");
  history_ratio_kernel_ = kernel(shaders::history_ratio_comp(), "history_ratio");
  scale_light_ = kernel(shaders::scale_light_comp(), "scale_light");
  keep_unchanged_ = kernel(shaders::keep_unchanged_comp(), "keep_unchanged");

  const auto count = static_cast<std::size_t>(largest.count());
  const auto tiles = [&](const char* name) {
    return Buffer(device, count * field.tile_texels() * sizeof(vec4), Memory::device, name);
  };
  light_before_ = tiles("light before edits");
  estimate_ = tiles("estimates before edits");
  history_ratio_ = tiles("history ratios");
  edited_light_ = Buffer(device, count * sizeof(EditedLight), Memory::device, "edited light");
  mean_probe_ = Buffer(device, sizeof(ProbeAtEdit), Memory::device, "mean probe at edits");
  history_shares_ = Buffer(device, count * sizeof(float), Memory::device, "shares of history");
  changed_ = Buffer(device, count * sizeof(uint), Memory::device, "probes changed by edits");
  field.reserve_rays_before(largest);
}

std::size_t DeviceHistory::bytes() const {
  return bytes_of({&light_before_, &estimate_, &history_ratio_, &edited_light_, &mean_probe_,
                   &history_shares_, &changed_});
}

void DeviceHistory::record_before(Recorder& to, const DeviceProbes& list) {
  field_.record_rays_before(to, list);
  const Vec4Array light = {field_.light().address()};
  const Vec4Array last_estimate = {field_.last_irradiance_estimate().address()};
  const Vec4Array estimate = {estimate_.address()};
  const GatherTilesArguments tiles = {
      list.index_array(), light, last_estimate, {light_before_.address()}, estimate,
      list.count(),       0};
  field_.run_over(to, gather_tiles_, tiles, list, kOverTexels);
  to.barrier();
  field_.record_transport(to, list, {light, estimate, {}, estimate});
  const HistoryRatioArguments ratio = {
      probes_,  list.index_array(),         last_estimate,           {light_before_.address()},
      estimate, {history_ratio_.address()}, field_.blocked_before(), list.count(),
      0};
  field_.run_over(to, history_ratio_kernel_, ratio, list, kOverTexels);
  to.barrier();
}

void DeviceHistory::record_solve(Recorder& to, const DeviceProbes& list,
                                 const Buffer& blend_weights) {
  field_.record_edited_light(to, list, {edited_light_.address()});
  ScaleLightArguments scale = {list.index_array(),
                               {field_.light().address()},
                               {edited_light_.address()},
                               {mean_probe_.address()},
                               {history_ratio_.address()},
                               {history_shares_.address()},
                               list.count(),
                               kSumLight};
  to.run(scale_light_, scale, kSumLightLanes);
  to.barrier();
  scale.step = kScaleLight;
  to.run(scale_light_, scale, static_cast<std::uint32_t>(list.count()));
  to.barrier();
  solver_.record(to, list, blend_weights, /*largest_blend_weight=*/1.0f, {history_ratio_.address()},
                 solve_settings(field_.settings()));
}

void DeviceHistory::record_keep(Recorder& to, const DeviceProbes& list) const {
  const KeepUnchangedArguments arguments = {probes_,
                                            list.index_array(),
                                            {field_.light().address()},
                                            {field_.last_irradiance_estimate().address()},
                                            {light_before_.address()},
                                            {solver_.solution().address()},
                                            {history_ratio_.address()},
                                            {history_shares_.address()},
                                            {edited_light_.address()},
                                            changed(),
                                            list.count(),
                                            0};
  field_.run_over(to, keep_unchanged_, arguments, list, kOverLanes);
  to.barrier();
}

}  // namespace lambent
