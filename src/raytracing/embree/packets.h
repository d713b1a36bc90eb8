// SPDX-License-Identifier: Apache-2.0
// Rays as Embree has them, alone and several together.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <span>

#include "raytracing/embree/geometry.h"
#include "raytracing/raytracer.h"

namespace lambent::embree {

inline RTCRay to_embree(const Ray& ray) {
  RTCRay result{};
  result.org_x = ray.origin.x;
  result.org_y = ray.origin.y;
  result.org_z = ray.origin.z;
  result.tnear = ray.t_min;
  result.dir_x = ray.direction.x;
  result.dir_y = ray.direction.y;
  result.dir_z = ray.direction.z;
  result.tfar = ray.t_max;
  result.mask = ray.mask;
  return result;
}

/// Which lanes of a packet have rays; as Embree wants it aligned.
struct alignas(64) Lanes {
  explicit Lanes(std::size_t count) {
    for (std::size_t lane = 0; lane < kPacket; ++lane) valid[lane] = lane < count ? -1 : 0;
  }
  std::array<int, kPacket> valid;
};

/// Writes rays, kPacket at most, into lanes.
inline void pack(std::span<const Ray> rays, RTCRay16& packet) {
  for (std::size_t lane = 0; lane < rays.size(); ++lane) {
    const Ray& ray = rays[lane];
    packet.org_x[lane] = ray.origin.x;
    packet.org_y[lane] = ray.origin.y;
    packet.org_z[lane] = ray.origin.z;
    packet.tnear[lane] = ray.t_min;
    packet.dir_x[lane] = ray.direction.x;
    packet.dir_y[lane] = ray.direction.y;
    packet.dir_z[lane] = ray.direction.z;
    packet.time[lane] = 0.0f;
    packet.tfar[lane] = ray.t_max;
    packet.mask[lane] = ray.mask;
    packet.id[lane] = 0;
    packet.flags[lane] = 0;
  }
}

/// What a lane met, as of a ray that was traced alone.
inline RTCRayHit unpack(const RTCRayHit16& packet, std::size_t lane) {
  RTCRayHit found{};
  found.ray.tfar = packet.ray.tfar[lane];
  found.hit.Ng_x = packet.hit.Ng_x[lane];
  found.hit.Ng_y = packet.hit.Ng_y[lane];
  found.hit.Ng_z = packet.hit.Ng_z[lane];
  found.hit.u = packet.hit.u[lane];
  found.hit.v = packet.hit.v[lane];
  found.hit.primID = packet.hit.primID[lane];
  found.hit.geomID = packet.hit.geomID[lane];
  found.hit.instID[0] = packet.hit.instID[0][lane];
  return found;
}

/// Calls trace(rays, first) for packets of a list.
template <class Trace>
void for_each_packet(std::span<const Ray> rays, Trace trace) {
  for (std::size_t first = 0; first < rays.size(); first += kPacket) {
    trace(rays.subspan(first, std::min<std::size_t>(kPacket, rays.size() - first)), first);
  }
}

/// RayTracer::coherent_hits; hit_of(ray, found) is what a ray found as a Hit.
template <class HitOf>
void find_hits(RTCScene scene, std::span<const Ray> rays, std::span<Hit> hits, HitOf hit_of) {
  assert(rays.size() == hits.size());
  for_each_packet(rays, [&](std::span<const Ray> together, std::size_t first) {
    assert(!crosses_glass(together.front().mask));
    RTCRayHit16 packet;
    pack(together, packet.ray);
    std::fill_n(packet.hit.geomID, kPacket, RTC_INVALID_GEOMETRY_ID);
    std::fill_n(packet.hit.instID[0], kPacket, RTC_INVALID_GEOMETRY_ID);
    Query asked(Query::Kind::closest, together.front());
    intersect(scene, asked, Lanes(together.size()).valid.data(), packet);
    for (std::size_t lane = 0; lane < together.size(); ++lane) {
      hits[first + lane] = hit_of(together[lane], unpack(packet, lane));
    }
  });
}

/// RayTracer::coherent_occlusions.
inline void find_occlusions(RTCScene scene, std::span<const Ray> rays,
                            std::span<std::uint8_t> is_occluded) {
  assert(rays.size() == is_occluded.size());
  for_each_packet(rays, [&](std::span<const Ray> together, std::size_t first) {
    RTCRay16 packet;
    pack(together, packet);
    Query asked(Query::Kind::occlusion, together.front());
    occluded(scene, asked, Lanes(together.size()).valid.data(), packet);
    // Embree marks an occluded ray by a far end of minus infinity
    for (std::size_t lane = 0; lane < together.size(); ++lane) {
      is_occluded[first + lane] = packet.tfar[lane] < 0.0f ? 1 : 0;
    }
  });
}

}  // namespace lambent::embree
