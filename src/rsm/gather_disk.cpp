// SPDX-License-Identifier: Apache-2.0
// Based on: Dachsbacher and Stamminger, "Reflective Shadow Maps", I3D 2005, sec. 3.2.
#include <algorithm>

#include "rsm/deinterleave.h"
#include "rsm/gather.h"
#include "rsm/maps/projection.h"
#include "rsm/to_records.h"

namespace lambent {
namespace {

/// The sub-map that each lane gathers from, and the addresses of its texels.
struct LaneMaps {
  int column[kLanes];  // of the sub-map
  int width[kLanes];   // of the sub-map [texels]
  std::size_t first[kLanes];
  std::size_t step_x, step_y[kLanes];
};

LaneMaps lane_maps(const DiskGather& disk, int first_column, int column_step, int sub_row) {
  const int n = disk.sub_maps, resolution = disk.map->resolution;
  LaneMaps lanes{};
  lanes.step_x = disk.restructured ? 1 : n;
  for (int l = 0; l < kLanes; ++l) {
    const int column = (first_column + l * column_step) % n;
    lanes.column[l] = column;
    lanes.width[l] = sub_image_size(resolution, column, n);
    lanes.first[l] = disk.restructured ? sub_map_start(resolution, n, column, sub_row)
                                       : static_cast<std::size_t>(sub_row) * resolution + column;
    lanes.step_y[l] = disk.restructured ? static_cast<std::size_t>(lanes.width[l])
                                        : static_cast<std::size_t>(resolution) * n;
  }
  return lanes;
}

/// Reads one sample of a lane into its column of the fields.
void read_sample(const DiskGather& disk, const LaneMaps& maps, int lane, int sub_row,
                 const vec2& place, float weight, float (*fields)[kLanes]) {
  const int n = disk.sub_maps;
  const int height = sub_image_size(disk.map->resolution, sub_row, n);
  const ivec2 at = nearest_in_sub_map(place, {maps.column[lane], sub_row}, n);
  if (at.x < 0 || at.y < 0 || at.x >= maps.width[lane] || at.y >= height) {
    for (int k = 0; k < kTexelFields; ++k) fields[k][lane] = 0.0f;
    fields[6][lane] = 1.0f;  // any softening above 0, to avoid a division by 0
    return;
  }
  const RsmTexelRecord t = weigh_disk_texel(
      to_record(disk.texels[maps.first[lane] + at.x * maps.step_x + at.y * maps.step_y[lane]]),
      weight, n, disk.softening);
  for (int c = 0; c < 3; ++c) {
    fields[c][lane] = t.position_ws[c];
    fields[3 + c][lane] = t.normal_ws[c];
    fields[7 + c][lane] = t.flux[c];
  }
  fields[6][lane] = t.softening;
}

}  // namespace

std::vector<RsmTexel> restructure_map(const ReflectiveShadowMap& map, int sub_maps) {
  std::vector<RsmTexel> texels;
  texels.reserve(map.texels.size());
  for (int j = 0; j < sub_maps; ++j) {
    for (int i = 0; i < sub_maps; ++i) {
      for (int y = j; y < map.resolution; y += sub_maps) {
        for (int x = i; x < map.resolution; x += sub_maps) {
          texels.push_back(map.texels[static_cast<std::size_t>(y) * map.resolution + x]);
        }
      }
    }
  }
  return texels;
}

void gather_disk(const GatherRow& row, const DiskGather& disk, int first_column, int column_step,
                 int sub_row) {
  const int n = disk.sub_maps, subs = n * n;
  const MapProjection projection = to_record(disk.map->projection);
  for (int i = 0; i < row.count; i += kLanes) {
    const LaneMaps maps = lane_maps(disk, first_column + i * column_step, column_step, sub_row);
    vec2 middle[kLanes];
    for (int l = 0; l < kLanes; ++l) {
      const float* position = row.guide.at(kPositionPlane) + i + l;
      const std::ptrdiff_t y = row.guide.stride, z = 2 * y;
      middle[l] =
          project_to_map(projection, {position[0], position[y], position[z]}, disk.map->resolution);
    }
    for (int k = 0; k < static_cast<int>(disk.samples.size()) / subs; ++k) {
      float fields[kTexelFields][kLanes];
      for (int l = 0; l < kLanes; ++l) {
        // Sub-maps share out the disk's samples, and each represents all of them
        const DiskSample& sample =
            disk.samples[k * subs + sub_map_of({maps.column[l], sub_row}, n)];
        read_sample(disk, maps, l, sub_row, middle[l] + sample.offset,
                    sample.weight * static_cast<float>(subs), fields);
      }
      gather_fetched(row, i, fields,
                     row.directions.first != nullptr && k % kTexelsPerDirection == 0);
    }
  }
}

}  // namespace lambent
