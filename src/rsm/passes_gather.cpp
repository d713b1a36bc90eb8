// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>

#include "core/parallel.h"
#include "rsm/deinterleave.h"
#include "rsm/gather.h"
#include "rsm/passes.h"
#include "rsm/visibility.h"

namespace lambent {
namespace {

// Rows of the picture that a task processes.
constexpr std::size_t kRowsPerTask = 16;

/// A row of a sub-image.
struct RowOf {
  int i, j, row;
};

/// For every row of the picture, on all cores: calls before(y), then body(RowOf, directions) for
/// the rows of sub-images that hold its pixels. `directions` has room for one row.
template <class Before, class Body>
void for_each_row(const Mosaic& mosaic, Before before, Body body) {
  const auto p = static_cast<std::size_t>(mosaic.sub_images());
  const auto rows = static_cast<std::size_t>(mosaic.layout().height);
  const int stride = mosaic.layout().stride;
  parallel_chunks(rows * p, kRowsPerTask, [&](std::size_t begin, std::size_t end) {
    AlignedFloats directions(static_cast<std::size_t>(kDirectionPlanes) * stride);
    for (std::size_t y = begin; y < end; ++y) {
      before(static_cast<int>(y));
      for (std::size_t i = 0; i < p; ++i) {
        body(RowOf{static_cast<int>(i), static_cast<int>(y % p), static_cast<int>(y / p)},
             Planes{directions.data(), stride});
      }
    }
  });
}

GatherRow gather_row(Mosaic& mosaic, const RowOf& at, const Planes& directions) {
  return {mosaic.guide(at.i, at.j, at.row),
          mosaic.light(Mosaic::Light::current, at.i, at.j, at.row), directions,
          mosaic.layout().width};
}

void clear(const GatherRow& row) {
  for (int c = 0; c < kLightPlanes; ++c) std::fill_n(row.light.at(c), row.count, 0.0f);
  if (row.directions.first == nullptr) return;
  for (int c = 0; c < kDirectionPlanes; ++c) std::fill_n(row.directions.at(c), row.count, 0.0f);
}

/// Part of a row: `count` pixels from `first` on.
GatherRow part_of(const GatherRow& row, int first, int count) {
  GatherRow part = row;
  part.guide.first += first;
  part.light.first += first;
  if (part.directions.first != nullptr) part.directions.first += first;
  part.count = count;
  return part;
}

/// For each row of sub-maps, and for each column of a row's first pixel: the tables of texel
/// indices for kLanes neighbouring pixels that gather_per_pixel() reads.
struct PlaceTables {
  PlaceTables(const RsmLights& lights, const RsmSettings& settings)
      : sub_maps(settings.sub_maps), count(lights.count(0)) {
    const bool scattered = settings.layout == RsmLayout::full;
    tables.resize(static_cast<std::size_t>(sub_maps) * sub_maps * count * kLanes);
    std::size_t next = 0;
    for (int j = 0; j < sub_maps; ++j) {
      for (int phase = 0; phase < sub_maps; ++phase) {
        for (std::uint32_t k = 0; k < count; ++k) {
          for (int l = 0; l < kLanes; ++l) {
            const std::uint32_t at = lights.starts[sub_map_of({phase + l, j}, sub_maps)] + k;
            tables[next++] = scattered ? lights.places[at] : at;
          }
        }
      }
    }
  }
  const std::uint32_t* of(int j, int phase) const {
    return tables.data() + (static_cast<std::size_t>(j) * sub_maps + phase) * count * kLanes;
  }
  int sub_maps;
  std::size_t count;
  std::vector<std::uint32_t> tables;
};

/// Gathers a row of a picture that is not restructured, where neighbours use different sub-maps.
void gather_mixed_row(const GatherRow& row, int y, const RsmLights& lights,
                      const RsmSettings& settings, const PlaceTables& tables) {
  const RsmTexel* texels =
      settings.layout == RsmLayout::full ? lights.rendered.data() : lights.restructured.data();
  const int n = settings.sub_maps;
  if (kLanes % n == 0) {
    gather_per_pixel(row, texels, tables.of(y % n, 0), tables.count);
    return;
  }
  for (int x = 0; x < row.count; x += kLanes) {
    gather_per_pixel(part_of(row, x, kLanes), texels, tables.of(y % n, x % n), tables.count);
  }
}

std::span<const RsmTexel> sub_map(const RsmLights& lights, int index) {
  return std::span(lights.restructured).subspan(lights.starts[index], lights.count(index));
}

}  // namespace

std::uint64_t gather_whole(const World& world, const RsmView& view, const RsmLights& lights,
                           const RsmSettings& settings, Mosaic& mosaic) {
  const int p = mosaic.sub_images(), n = settings.sub_maps;
  // Where the picture is not restructured, neighbouring pixels use different sub-maps
  const bool mixed = p == 1 && n > 1;
  std::optional<PlaceTables> tables;
  if (mixed) tables.emplace(lights, settings);
  std::atomic<std::uint64_t> rays = 0;
  const auto fill = [&](int y) { mosaic.fill_row(view, y); };
  for_each_row(mosaic, fill, [&](const RowOf& at, const Planes& directions) {
    const GatherRow row = gather_row(mosaic, at, blurs(settings) ? directions : Planes());
    const int sub = sub_map_of({at.i, at.j}, n);
    if (mixed) {
      gather_mixed_row(row, at.row, lights, settings, *tables);
    } else if (settings.layout == RsmLayout::full) {
      gather_scattered(row, lights.rendered.data(), lights.places);
    } else {
      gather_contiguous(row, sub_map(lights, sub));
    }
    if (settings.visibility_rays > 0) {
      const ivec2 first = pixel_of_sub_image({at.i, at.j}, {0, at.row}, p);
      const std::size_t pixel = static_cast<std::size_t>(first.y) * mosaic.width() + first.x;
      for (int x = 0; x < (mixed ? row.count : 1); ++x) {
        const int own = mixed ? sub_map_of({x, at.row}, n) : sub;
        rays += apply_visibility(world, mixed ? part_of(row, x, 1) : row, sub_map(lights, own),
                                 settings.visibility_rays, pixel + x, p, settings.seed);
      }
    }
    if (row.directions.first != nullptr) make_reorientable(row);
  });
  return rays;
}

void gather_disks(const RsmView& view, std::size_t maps, const FetchMap& fetch,
                  const RsmSettings& settings, Mosaic& mosaic) {
  const int n = settings.sub_maps, p = mosaic.sub_images();
  const auto count = static_cast<uint>((settings.texels + n * n - 1) / (n * n) * n * n);
  // The vectors to texels are stored in the planes that blurs will write
  const bool blurred = blurs(settings);
  const auto row_at = [&](const RowOf& at) {
    return gather_row(mosaic, at,
                      blurred ? mosaic.light(Mosaic::Light::next, at.i, at.j, at.row) : Planes());
  };
  const auto fill = [&](int y) { mosaic.fill_row(view, y); };
  const auto nothing = [](int) {};
  for_each_row(mosaic, fill, [&](const RowOf& at, const Planes&) { clear(row_at(at)); });
  for (std::size_t m = 0; m < maps; ++m) {
    const ReflectiveShadowMap& map = fetch(m);
    const float radius = settings.disk_radius * static_cast<float>(map.resolution);
    std::vector<DiskSample> samples(count);
    for (uint k = 0; k < count; ++k) samples[k] = disk_sample(k, count, radius);
    DiskGather disk;
    disk.map = &map;
    disk.sub_maps = n;
    disk.restructured = settings.layout != RsmLayout::full;
    const std::vector<RsmTexel> restructured =
        disk.restructured ? restructure_map(map, n) : std::vector<RsmTexel>();
    disk.texels = disk.restructured ? restructured.data() : map.texels.data();
    disk.samples = samples;
    disk.softening = settings.softening;
    for_each_row(mosaic, nothing, [&](const RowOf& at, const Planes&) {
      const ivec2 first = pixel_of_sub_image({at.i, at.j}, {0, at.row}, p);
      gather_disk(row_at(at), disk, first.x, p, first.y % n);
    });
  }
  if (!blurred) return;
  for_each_row(mosaic, nothing,
               [&](const RowOf& at, const Planes&) { make_reorientable(row_at(at)); });
}

}  // namespace lambent
