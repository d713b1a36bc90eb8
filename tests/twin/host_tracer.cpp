// SPDX-License-Identifier: Apache-2.0
#include "twin/host_tracer.h"

#include "shaders/copy_words_comp.h"
#include "twin/copy_words.h"

namespace lambent::test {

HostTracer::HostTracer(const vulkan::Device& device, const RayTracer& tracer)
    : device_(device), tracer_(tracer), copy_(device, shaders::copy_words_comp(), "copy words") {}

void HostTracer::run(const std::function<void(vulkan::Recorder&)>& record) {
  queries_.clear();
  for (bool complete = false; !complete;) {
    recorded_ = 0;
    device_.run(record);
    complete = true;
    for (Query& query : queries_) {
      if (query.answered) continue;
      answer(query);
      complete = false;
      break;
    }
  }
}

void HostTracer::closest_hits(vulkan::Recorder& recorder, const RayBatch& batch,
                              HitArray hits) const {
  next_query(recorder, batch, true, hits.address);
}

void HostTracer::occlusions(vulkan::Recorder& recorder, const RayBatch& batch,
                            UintArray occluded) const {
  next_query(recorder, batch, false, occluded.address);
}

void HostTracer::next_query(vulkan::Recorder& recorder, const RayBatch& batch, bool closest,
                            std::uint64_t answers) const {
  if (recorded_ == queries_.size()) {
    const std::size_t answer_bytes = closest ? sizeof(HitRecord) : sizeof(std::uint32_t);
    queries_.push_back({batch.count, closest, false,
                        vulkan::Buffer(device_, batch.count * sizeof(RayRecord),
                                       vulkan::Memory::readback, "rays for the host"),
                        vulkan::Buffer(device_, batch.count * answer_bytes, vulkan::Memory::upload,
                                       "answers of the host")});
  }
  Query& query = queries_[recorded_++];
  copy(recorder, batch.rays.address, query.rays.address(), query.rays.bytes());
  copy(recorder, query.answers.address(), answers, query.answers.bytes());
}

void HostTracer::copy(vulkan::Recorder& recorder, std::uint64_t from, std::uint64_t to,
                      std::size_t bytes) const {
  const auto words = static_cast<std::uint32_t>(bytes / sizeof(std::uint32_t));
  recorder.run(copy_, CopyWordsArguments{{from}, {to}, words, 0}, words);
}

void HostTracer::answer(Query& query) const {
  const std::span<RayRecord> rays = query.rays.as<RayRecord>();
  for (std::uint32_t i = 0; i < query.count; ++i) {
    const Ray ray = ray_of(rays[i]);
    if (query.closest) {
      query.answers.as<HitRecord>()[i] =
          record_of(ray.mask != 0 ? tracer_.closest_hit(ray) : Hit{});
    } else {
      query.answers.as<std::uint32_t>()[i] = ray.mask != 0 && tracer_.occluded(ray) ? 1u : 0u;
    }
  }
  query.answered = true;
}

}  // namespace lambent::test
