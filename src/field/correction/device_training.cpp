// SPDX-License-Identifier: Apache-2.0
#include "field/correction/device_training.h"

#include <algorithm>
#include <vector>

#include "field/correction/train_math.h"
#include "field/secondary/secondary_math.h"
#include "field/secondary/secondary_records.h"
#include "field/vulkan/device_arguments.h"
#include "vulkan/device_memory.h"

namespace lambent {
namespace {

using vulkan::Memory;
using vulkan::Recorder;

// The number of points whose rays are in memory at a time: 65,536 rays keep any device busy, and
// take about 11 MB for each depth.
constexpr std::uint32_t kPointsAtATime = 8192;
constexpr std::uint32_t kRaysAtATime = kPointsAtATime * kTrainingRays;

// Each surfel is a point, and the hit of one of its rays is another point.
constexpr std::size_t kPointsPerSurfel = 2;

template <class T>
vulkan::Buffer room_for(const vulkan::Device& device, std::size_t count, const char* name) {
  return {device, count * sizeof(T), Memory::device, name};
}

}  // namespace

DeviceTraining::DeviceTraining(FieldResources& field)
    : field_(field),
      kernels_(TrainingKernels::of(field.device(), field.settings(), field.volumes(),
                                   field.lookups_per_surfel())),
      shading_(field.device()) {
  const vulkan::Device& device = field.device();
  points_ = room_for<TrainingPointRecord>(device, kPointsAtATime, "points to learn at");
  queries_ = room_for<QueryRecord>(device, kPointsAtATime, "queries to learn at");
  lookups_ = room_for<SurfelLookup>(
      device, static_cast<std::size_t>(field.lookups_per_surfel()) * kPointsAtATime,
      "lookups to learn from");
  for (Gathers& gathers : gathers_) {
    gathers = {room_for<RayRecord>(device, kRaysAtATime, "rays to learn by"),
               room_for<LitPointRecord>(device, kRaysAtATime, "points to learn from"),
               room_for<ShadedHitRecord>(device, kRaysAtATime, "surfaces to learn from"),
               room_for<vec3>(device, kRaysAtATime, "direct light to learn from"),
               room_for<vec3>(device, kRaysAtATime, "field to learn by")};
  }
  first_indices_ = room_for<uint>(device, kPointsAtATime, "indices of rays to learn by");
  secondary_indices_ = room_for<uint>(device, kRaysAtATime, "indices of rays that follow");
  hits_ = room_for<HitRecord>(device, kRaysAtATime, "hits to learn by");
  hit_queries_ = room_for<QueryRecord>(device, kRaysAtATime, "queries to learn by");
  ray_count_ = room_for<uint>(device, 1, "count of rays to learn by");
  const auto counter = [&](const char* name) {
    return vulkan::Buffer(device, sizeof(uint), Memory::readback, name);
  };
  rays_read_ = counter("rays to learn by, counted");
  shadow_rays_read_ = counter("shadow rays to learn by, counted");
  lookup_rays_read_ = counter("rays of lookups to learn by, counted");
}

std::size_t DeviceTraining::bytes() const {
  std::size_t bytes =
      bytes_of({&trained_, &samples_, &points_, &queries_, &lookups_, &first_indices_,
                &secondary_indices_, &hits_, &hit_queries_, &ray_count_});
  for (const Gathers& gathers : gathers_) {
    bytes += bytes_of(
        {&gathers.rays, &gathers.points, &gathers.shaded, &gathers.direct, &gathers.arrives});
  }
  return bytes;
}

void DeviceTraining::begin(std::span<const TrainingSurfel> surfels, uint number) {
  const vulkan::Device& device = field_.device();
  std::vector<TrainingSurfelRecord> records;
  records.reserve(surfels.size());
  for (const TrainingSurfel& at : surfels) {
    records.push_back({at.probe, static_cast<uint>(at.probe * field_.surfel_stride() + at.ray),
                       at.ray, field_.ray_set_of(at.probe)});
  }
  number_ = number;
  surfel_count_ = static_cast<std::uint32_t>(surfels.size());
  trained_ = host_buffer<TrainingSurfelRecord>(device, records, "surfels to learn at");
  const std::size_t samples = kPointsPerSurfel * surfels.size() * field_.lookups_per_surfel();
  reserve<CorrectionSampleRecord>(device, samples, "samples to learn", samples_);
  field_.corrections().reserve(samples);
}

/// Records the direct light at the hits of the rays of a depth, and the queries of the field there.
void DeviceTraining::record_light(Recorder& to, const DeviceWorld& world, std::uint32_t rays,
                                  int depth) {
  const Gathers& gathers = gathers_[depth];
  const DeviceHits hits{{gathers.rays.address()}, {hits_.address()}, rays};
  world.tracer().closest_hits(to, {hits.rays, rays}, hits.hits);
  to.barrier();
  ShadeHitsSettings shading = training_shading(field_.settings(), number_);
  shading.salt = gather_salt(shading.salt, depth);
  const vulkan::Buffer& indices = depth == 0 ? first_indices_ : secondary_indices_;
  shading_.shade_hits(
      to, {world.scene(), world.tracer()}, hits, {indices.address()},
      depth == 0 ? kTrainingRays : 1, shading,
      {{gathers.points.address()}, {gathers.shaded.address()}, {gathers.direct.address()}});
  to.run(kernels_.queries,
         HitQueriesArguments{{gathers.points.address()},
                             {gathers.shaded.address()},
                             {gathers.rays.address()},
                             {hit_queries_.address()},
                             rays,
                             0u},
         rays);
  to.barrier();
}

/// Records the lookups at the hits of the rays of a depth, whose queries are in memory.
void DeviceTraining::record_lookup(Recorder& to, const DeviceWorld& world, std::uint32_t rays,
                                   int depth) {
  field_.record_lookup(to, {hit_queries_.address()}, rays, {gathers_[depth].arrives.address()},
                       &world.tracer(), field_.corrections().arrays(CorrectionUse::picked));
}

/// Records the rays of the secondary gathers of a depth.
void DeviceTraining::record_secondary_rays(Recorder& to, std::uint32_t rays, int depth) {
  const Gathers& before = gathers_[depth - 1];
  const ShadeHitsSettings shading = training_shading(field_.settings(), number_);
  to.run(kernels_.secondary_rays,
         SecondaryRaysArguments{{before.rays.address()},
                                {before.points.address()},
                                {before.shaded.address()},
                                {first_indices_.address()},
                                {hit_queries_.address()},
                                {field_.grids().address()},
                                {gathers_[depth].rays.address()},
                                {secondary_indices_.address()},
                                {ray_count_.address()},
                                field_.volumes(),
                                rays,
                                kTrainingRays,
                                gather_salt(shading.salt, depth),
                                shading.seed,
                                1u},
         rays);
  to.barrier();
}

/// Records the gathers of the points in memory: their rays, the light at the rays' hits, and the
/// secondary gathers there.
void DeviceTraining::record_gather(Recorder& to, const DeviceWorld& world, std::uint32_t count) {
  const uint seed = field_.settings().seed;
  const std::uint32_t rays = count * kTrainingRays;
  to.run(kernels_.rays,
         TrainingRaysArguments{{points_.address()},
                               {queries_.address()},
                               {gathers_[0].rays.address()},
                               {first_indices_.address()},
                               {ray_count_.address()},
                               count,
                               number_,
                               seed,
                               0u},
         count);
  to.barrier();
  to.bind_textures(world.scene().textures());
  record_light(to, world, rays, 0);
  for (int depth = 1; depth <= kMaxTrainingSecondaryRays; ++depth) {
    record_secondary_rays(to, rays, depth);
    record_lookup(to, world, rays, depth - 1);
    record_light(to, world, rays, depth);
  }
  record_lookup(to, world, rays, kMaxTrainingSecondaryRays);
  // From the last rays back to the first
  for (int depth = kMaxTrainingSecondaryRays; depth > 0; --depth) {
    const Gathers &before = gathers_[depth - 1], &following = gathers_[depth];
    to.run(kernels_.secondary_light,
           SecondaryLightArguments{{before.points.address()},
                                   {following.rays.address()},
                                   {following.shaded.address()},
                                   {following.direct.address()},
                                   {following.arrives.address()},
                                   {before.arrives.address()},
                                   rays,
                                   0u},
           rays);
    to.barrier();
  }
}

/// Records the samples of the points in memory, and the replacement of each point by the hit of one
/// of its rays.
void DeviceTraining::record_compare(Recorder& to, const DeviceWorld& world, std::uint32_t count,
                                    std::size_t first_sample) {
  field_.record_find_lookups(to, {queries_.address()}, count, {lookups_.address()},
                             &world.tracer());
  const Gathers& first = gathers_[0];
  const std::uint64_t samples = samples_.address() + first_sample * sizeof(CorrectionSampleRecord);
  to.run(kernels_.samples,
         TrainingSamplesArguments{field_.store(),
                                  {points_.address()},
                                  {queries_.address()},
                                  {first.rays.address()},
                                  {first.points.address()},
                                  {first.shaded.address()},
                                  {first.direct.address()},
                                  {first.arrives.address()},
                                  {lookups_.address()},
                                  {samples},
                                  count,
                                  number_,
                                  field_.settings().seed,
                                  0u},
         count);
  to.barrier();
}

void DeviceTraining::record(Recorder& to, const DeviceWorld& world) {
  const std::size_t lookups = field_.lookups_per_surfel();
  to.fill(ray_count_, 0u);
  to.barrier();
  std::size_t sample = 0;
  for (std::uint32_t first = 0; first < surfel_count_; first += kPointsAtATime) {
    const std::uint32_t count = std::min(kPointsAtATime, surfel_count_ - first);
    to.run(kernels_.points,
           TrainingPointsArguments{field_.store(),
                                   {trained_.address()},
                                   field_.surfels(),
                                   field_.ray_sets(),
                                   {points_.address()},
                                   {queries_.address()},
                                   first,
                                   count},
           count);
    to.barrier();
    for (std::size_t k = 0; k < kPointsPerSurfel; ++k) {
      record_gather(to, world, count);
      record_compare(to, world, count, sample);
      sample += lookups * count;
    }
  }
  field_.corrections().record_learn(to, {field_.grids().address()}, {samples_.address()},
                                    static_cast<std::uint32_t>(sample), number_);
  to.copy(ray_count_, rays_read_, sizeof(uint));
  shading_.take_ray_count(to, shadow_rays_read_);
  field_.take_ray_count(to, lookup_rays_read_);
}

std::uint64_t DeviceTraining::rays() const {
  std::uint64_t rays = 0;
  for (const vulkan::Buffer* count : {&rays_read_, &shadow_rays_read_, &lookup_rays_read_}) {
    rays += count->as<uint>().front();
  }
  return rays;
}

}  // namespace lambent
