// SPDX-License-Identifier: Apache-2.0
// The memory of a field on a device.
#include "field/vulkan/field_resources.h"

#include <algorithm>
#include <cassert>
#include <numeric>

#include "field/probes/tile_fit.h"
#include "field/transport/blend_math.h"
#include "raytracing/raytracer.h"
#include "vulkan/device_memory.h"

namespace lambent {
namespace {

static_assert(sizeof(FieldQuery) == sizeof(QueryRecord));
static_assert(sizeof(ProbeGrid) == 31 * sizeof(float));
static_assert(sizeof(SurfelLookup) == 13 * sizeof(float));
static_assert(kRg16f == static_cast<uint>(DistanceFormat::rg16f) &&
              kRg32f == static_cast<uint>(DistanceFormat::rg32f));
static_assert(kSurfelSurface == static_cast<uint>(SurfelKind::surface) &&
              kSurfelSky == static_cast<uint>(SurfelKind::sky) &&
              kSurfelSolidSide == static_cast<uint>(SurfelKind::solid_side));

SurfelRecord to_record(const Surfel& surfel) {
  return {surfel.position_ws,
          surfel.material,
          surfel.albedo_over_pi,
          surfel.normal_ws,
          surfel.light,
          surfel.geometric_normal_ws,
          static_cast<uint>(surfel.kind),
          surfel.gi_share,
          surfel.mirror_distance};
}

/// The matrix of tile_fit.h as the product needs it: rows padded to whole lane groups, columns to
/// whole blocks.
std::vector<float> padded_fit(int edge) {
  const std::vector<float> fit = tile_fit_matrix(edge);
  const int texels = edge * edge, columns = round_up(texels, kIrradianceBlock);
  std::vector<float> padded(static_cast<std::size_t>(round_up(texels, kLaneGroupSize)) * columns);
  for (int row = 0; row < texels; ++row) {
    std::copy_n(&fit[static_cast<std::size_t>(row) * texels], texels,
                &padded[static_cast<std::size_t>(row) * columns]);
  }
  return padded;
}

}  // namespace

FieldResources::FieldResources(const vulkan::Device& device, const FieldSettings& settings,
                               const ProbeStore& shape)
    : device_(device),
      settings_(settings),
      probes_(shape.probes()),
      volumes_(shape.volumes()),
      lookups_(std::min(volumes_, kMaxSurfelLookups)),
      words_per_irradiance_texel_(shape.words_per_irradiance_texel()),
      words_per_distance_texel_(shape.words_per_distance_texel()),
      kernels_(FieldKernels::of(device, settings, volumes_, lookups_)),
      corrections_(device, probes_),
      slot_of_(shape.probes(), -1) {
  using vulkan::Memory;
  const auto texels = static_cast<std::size_t>(probes_) * tile_texels();
  grids_ = vulkan::upload(device, shape.grids(), "grids");
  offsets_ = vulkan::upload(device, shape.offset_words(), "offsets of probes");
  irradiance_ = vulkan::upload(device, shape.irradiance_words(), "irradiance");
  distance_ = vulkan::upload(device, shape.distance_words(), "distances");
  corners_ = vulkan::upload(device, shape.corner_table(), "corners of cells");
  fit_ = vulkan::upload(device, padded_fit(settings.irradiance_texels), "tile fit");
  light_ = vulkan::Buffer(device, texels * sizeof(vec4), Memory::device, "light");
  last_irradiance_estimate_ =
      vulkan::Buffer(device, texels * sizeof(vec4), Memory::device, "last irradiance estimate");
  if (settings.visibility != Visibility::moments) {
    cell_visibility_ =
        std::make_unique<DeviceVisibility>(device, settings, probes_, volumes_, lookups_);
  }
  device.run([&](vulkan::Recorder& to) {
    to.fill(light_, 0u);
    to.fill(last_irradiance_estimate_, 0u);
  });
}

std::size_t FieldResources::bytes() const {
  std::size_t bytes = bytes_of({&grids_, &offsets_, &irradiance_, &distance_, &corners_, &fit_,
                                &light_, &last_irradiance_estimate_, &surfels_, &lookup_records_,
                                &sets_, &ray_distances_, &blocked_, &radiance_, &at_centres_,
                                &ray_distances_before_, &blocked_before_, &ray_lights_before_});
  for (const RaySlot& slot : slots_) {
    bytes += bytes_of({&slot.directions, &slot.irradiance_weights, &slot.distance_weights});
  }
  if (cell_visibility_) bytes += cell_visibility_->bytes();
  return bytes + corrections_.bytes();
}

void FieldResources::reserve_visibility_around() {
  if (cell_visibility_) cell_visibility_->reserve_cells_around();
}

UintArray FieldResources::cell_visibility() const {
  return cell_visibility_ ? cell_visibility_->of_cells() : UintArray{};
}

void FieldResources::set_places(const ProbeStore& store) {
  vulkan::write(device_, store.grids(), grids_);
  vulkan::write(device_, store.offset_words(), offsets_);
}

void FieldResources::write_store(const ProbeStore& store) {
  set_places(store);
  vulkan::write(device_, store.irradiance_words(), irradiance_);
  vulkan::write(device_, store.distance_words(), distance_);
}

void FieldResources::write_distances(const ProbeStore& store, std::span<const int> probes) {
  if (probes.empty()) return;
  const std::size_t tile = store.distance_words().size() / probes_;
  std::vector<uint> words;
  for (const int probe : probes) {
    const std::span<const uint> from = store.distance_words().subspan(probe * tile, tile);
    words.insert(words.end(), from.begin(), from.end());
  }
  const vulkan::Buffer staged = host_buffer<uint>(device_, words, "distances to come");
  device_.run([&](vulkan::Recorder& to) {
    const std::size_t bytes = tile * sizeof(uint);
    for (std::size_t k = 0; k < probes.size(); ++k) {
      to.copy(staged, distance_, bytes, k * bytes, probes[k] * bytes);
    }
  });
}

void FieldResources::read_store(ProbeStore& store) const {
  store.restore(0, std::vector<uint>(store.offset_words().begin(), store.offset_words().end()),
                vulkan::download<uint>(device_, irradiance_),
                vulkan::download<uint>(device_, distance_));
}

void FieldResources::reserve_surfels(int rays) {
  if (rays <= stride_) return;
  const auto slots = static_cast<std::size_t>(probes_) * rays;
  vulkan::Buffer surfels(device_, slots * sizeof(SurfelRecord), vulkan::Memory::device, "surfels");
  vulkan::Buffer lookups(device_, slots * lookups_ * sizeof(SurfelLookup), vulkan::Memory::device,
                         "lookups of surfels");
  device_.run([&](vulkan::Recorder& to) {
    for (int probe = 0; probe < probes_; ++probe) {
      if (slot_of_[probe] < 0 || stride_ == 0) continue;
      const std::size_t a = sizeof(SurfelRecord), b = lookups_ * sizeof(SurfelLookup);
      const std::size_t from = static_cast<std::size_t>(probe) * stride_;
      const std::size_t into = static_cast<std::size_t>(probe) * rays;
      to.copy(surfels_, surfels, stride_ * a, from * a, into * a);
      to.copy(lookup_records_, lookups, stride_ * b, from * b, into * b);
    }
  });
  surfels_ = std::move(surfels);
  lookup_records_ = std::move(lookups);
  stride_ = rays;
  if (cell_visibility_) cell_visibility_->reserve(rays);
}

void FieldResources::write_surfels(std::span<const int> probes,
                                   std::span<const ProbeTrace> traces) {
  for (const int probe : probes) {
    const ProbeTrace& trace = traces[probe];
    set_rays(std::span(&probe, 1), trace.rays);
    std::vector<SurfelRecord> surfels;
    for (const Surfel& surfel : trace.surfels) surfels.push_back(to_record(surfel));
    std::vector<SurfelLookup> lookups(trace.surfels.size() * lookups_);
    std::vector<int> found(trace.surfels.size(), 0);
    for (SurfelLookup& lookup : lookups) lookup.tile_corner = kNoLookup;
    for (std::size_t i = 0; i < trace.surfels.size(); ++i) {
      if (!trace.surfels[i].reflects() || trace.surfels[i].gi_share <= 0.0f) continue;
      lookups[i * lookups_] = trace.lookups[i];
      found[i] = 1;
    }
    for (const FurtherLookup& further : trace.further) {
      if (found[further.ray] == lookups_) continue;
      lookups[further.ray * lookups_ + found[further.ray]++] = further.lookup;
    }
    const std::size_t first = static_cast<std::size_t>(probe) * stride_;
    vulkan::write<SurfelRecord>(device_, surfels, surfels_, first);
    vulkan::write<SurfelLookup>(device_, lookups, lookup_records_, first * lookups_);
  }
}

std::vector<SurfelLookup> FieldResources::read_lookups(int probe) const {
  std::vector<SurfelLookup> lookups(static_cast<std::size_t>(rays_of(probe)->rays()) * lookups_);
  vulkan::read<SurfelLookup>(device_, lookup_records_, lookups,
                             static_cast<std::size_t>(probe) * stride_ * lookups_);
  return lookups;
}

std::vector<SurfelRecord> FieldResources::read_surfels(int probe) const {
  std::vector<SurfelRecord> surfels(rays_of(probe)->rays());
  vulkan::read<SurfelRecord>(device_, surfels_, surfels, static_cast<std::size_t>(probe) * stride_);
  return surfels;
}

std::shared_ptr<const RaySet> FieldResources::rays_of(int probe) const {
  return slot_of_[probe] < 0 ? nullptr : slots_[slot_of_[probe]].rays;
}

void FieldResources::set_rays(std::span<const int> probes,
                              const std::shared_ptr<const RaySet>& rays) {
  const int slot = rays ? slot_for(rays) : -1;
  for (const int probe : probes) {
    if (slot >= 0) ++slots_[slot].users;
    if (slot_of_[probe] >= 0 && --slots_[slot_of_[probe]].users == 0) {
      slots_[slot_of_[probe]] = {};
    }
    slot_of_[probe] = slot;
  }
}

/// The slot that holds a ray set. Makes one if there is none.
int FieldResources::slot_for(const std::shared_ptr<const RaySet>& rays) {
  int empty = -1;
  for (std::size_t s = 0; s < slots_.size(); ++s) {
    if (slots_[s].rays == rays) return static_cast<int>(s);
    if (!slots_[s].rays && empty < 0) empty = static_cast<int>(s);
  }
  if (empty < 0) {
    empty = static_cast<int>(slots_.size());
    slots_.emplace_back();
  }
  reserve_surfels(rays->rays());
  slots_[empty].rays = rays;
  fill_weights(slots_[empty]);
  write_sets();
  return empty;
}

std::size_t FieldResources::irradiance_weight_bytes(int rays) const {
  return sizeof(float) * round_up(rays, kLaneGroupSize) * round_up(tile_texels(), kIrradianceBlock);
}

std::size_t FieldResources::distance_weight_bytes(int rays) const {
  const int texels = settings_.distance_texels * settings_.distance_texels;
  return sizeof(float) * round_up(rays, kLaneGroupSize) * round_up(texels, kDistanceBlock);
}

void FieldResources::record_weights(vulkan::Recorder& to, Vec3Array directions, int rays,
                                    FloatArray irradiance, FloatArray distance) const {
  const auto fill = [&](int edge, int block, float exponent, FloatArray weights) {
    const int rows = round_up(rays, kLaneGroupSize), columns = round_up(edge * edge, block);
    const RayWeightsArguments arguments = {directions, weights, rays, columns, edge, exponent};
    to.run(kernels_.ray_weights, arguments, columns, rows);
  };
  fill(settings_.irradiance_texels, kIrradianceBlock, 1.0f, irradiance);
  fill(settings_.distance_texels, kDistanceBlock, kDistanceExponent, distance);
  to.barrier();
}

void FieldResources::fill_weights(RaySlot& slot) const {
  const int rays = slot.rays->rays();
  slot.directions = vulkan::upload(device_, slot.rays->directions, "directions of rays");
  slot.irradiance_weights = vulkan::Buffer(device_, irradiance_weight_bytes(rays),
                                           vulkan::Memory::device, "weights of rays");
  slot.distance_weights = vulkan::Buffer(device_, distance_weight_bytes(rays),
                                         vulkan::Memory::device, "weights of rays");
  device_.run([&](vulkan::Recorder& to) {
    record_weights(to, {slot.directions.address()}, rays, {slot.irradiance_weights.address()},
                   {slot.distance_weights.address()});
  });
}

void FieldResources::write_sets() {
  std::vector<RaySetRecord> records;
  for (const RaySlot& slot : slots_) {
    records.push_back({{slot.directions.address()},
                       {slot.irradiance_weights.address()},
                       {slot.distance_weights.address()},
                       slot.rays ? slot.rays->rays() : 0,
                       slot.rays ? slot.rays->update : 0u});
  }
  sets_ = host_buffer<RaySetRecord>(device_, records, "ray sets");
}

DeviceProbes FieldResources::list(std::span<const int> probes) const {
  DeviceProbes list;
  std::vector<std::size_t> order(probes.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return slot_of_[probes[a]] < slot_of_[probes[b]];
  });
  list.position.resize(probes.size());
  std::vector<int> sets;
  std::vector<ProbeBlock> blocks;
  for (const std::size_t named : order) {
    const int k = list.count(), set = slot_of_[probes[named]];
    assert(set >= 0);
    if (blocks.empty() || blocks.back().ray_set != set || blocks.back().count == kBlockProbes) {
      blocks.push_back({k, 0, set});
    }
    ++blocks.back().count;
    list.position[named] = static_cast<std::size_t>(k);
    list.probes.push_back(probes[named]);
    list.most_rays = std::max(list.most_rays, slots_[set].rays->rays());
    sets.push_back(set);
  }
  list.block_count = static_cast<int>(blocks.size());
  list.indices = host_buffer<int>(device_, list.probes, "probes");
  list.ray_sets = host_buffer<int>(device_, sets, "their ray sets");
  list.blocks = host_buffer<ProbeBlock>(device_, blocks, "blocks of probes");
  return list;
}

}  // namespace lambent
