// SPDX-License-Identifier: Apache-2.0
#include "raytracing/embree/geometry.h"

#include <algorithm>
#include <glm/gtc/type_ptr.hpp>

#include "raytracing/glass/absorption.h"
#include "raytracing/raytracer.h"
#include "raytracing/surface.h"
#include "scene/attributes.h"

namespace lambent::embree {
namespace {

/// Whether a ray ends at a transmissive triangle. For queries of transmittance, multiplies the
/// query's share.
bool stops_at_glass(const Scene& scene, const SeenTriangle& seen, float distance, Query& query) {
  const vec3& direction_ws = query.ray.direction;
  const bool crosses = crosses_glass(query.ray.mask);
  if (query.kind == Query::Kind::closest) {
    return !crosses || !passes_glass_at(scene, seen, query.ray);
  }
  const vec3 share = straight_share_of(scene, seen, direction_ws);
  if (share == vec3(0.0f)) return true;
  if (query.kind == Query::Kind::occlusion) return false;
  if (stops_at_bends(query.ray.mask) && bends_light(scene, seen)) return true;
  query.through *= crosses ? share / passing_probability(share) : share;
  const Material& material =
      scene.materials[scene.meshes[scene.instances[seen.instance].mesh].material];
  if (material.bounds_volume) {
    query.optical_depth += depth_at_boundary(material.absorption, distance, seen.from_front);
  }
  return false;
}

/// Embree's filter function: rejects candidate hits that are transparent or transmit the ray.
void filter_see_through(const RTCFilterFunctionNArguments* args) {
  const auto& slots = *static_cast<const Slots*>(args->geometryUserPtr);
  const Scene& scene = *slots.scene;
  for (unsigned lane = 0; lane < args->N; ++lane) {
    if (args->valid[lane] == 0) continue;
    const RTCHit hit = rtcGetHitFromHitN(args->hit, args->N, lane);
    bool baked = false;
    const std::uint32_t instance =
        slots.instance_of[Slots::slot_of(hit.geomID, hit.instID[0], baked)];
    const float distance = RTCRayN_tfar(args->ray, args->N, lane);
    auto& query = *static_cast<Query*>(args->context);
    const vec2 barycentrics(hit.u, hit.v);
    const HitCoverage coverage = hit_coverage_at(scene, instance, hit.primID, barycentrics);
    const Instance& placed = scene.instances[instance];
    const bool glass = is_transmissive(scene.materials[scene.meshes[placed.mesh].material]);
    if (query.kind == Query::Kind::transmittance && !glass &&
        dims_ray(coverage, crosses_glass(query.ray.mask))) {
      query.through *= 1.0f - covered_share(coverage);
      if (query.through != vec3(0.0f)) args->valid[lane] = 0;
      continue;
    }
    bool stops = stops_ray(coverage, hit.primID, barycentrics, distance,
                           RTCRayN_mask(args->ray, args->N, lane), query.passed);
    if (stops && glass) {
      const vec3 normal(hit.Ng_x, hit.Ng_y, hit.Ng_z);
      const vec3 direction(RTCRayN_dir_x(args->ray, args->N, lane),
                           RTCRayN_dir_y(args->ray, args->N, lane),
                           RTCRayN_dir_z(args->ray, args->N, lane));
      const bool turned = baked && glm::determinant(mat3(placed.world_from_object)) < 0.0f;
      const bool from_front = (dot(normal, direction) < 0.0f) != turned;
      stops =
          stops_at_glass(scene, {instance, hit.primID, barycentrics, from_front}, distance, query);
    }
    if (!stops) args->valid[lane] = 0;
  }
}

}  // namespace

Geometry make_mesh(RTCDevice device, const Mesh& mesh, const Slots& slots,
                   const glm::mat4* world_from_object) {
  Geometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
  auto* vertices = static_cast<glm::vec3*>(
      rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                              sizeof(glm::vec3), mesh.positions.size()));
  auto* triangles = static_cast<glm::uvec3*>(
      rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              sizeof(glm::uvec3), mesh.triangles.size()));
  if ((vertices == nullptr && !mesh.positions.empty()) ||
      (triangles == nullptr && !mesh.triangles.empty())) {
    return nullptr;
  }
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    vertices[v] = world_from_object != nullptr
                      ? glm::vec3(*world_from_object * glm::vec4(mesh.positions[v], 1.0f))
                      : mesh.positions[v];
  }
  std::copy(mesh.triangles.begin(), mesh.triangles.end(), triangles);
  if (!stops_all_rays(slots.scene->materials[mesh.material])) {
    rtcSetGeometryUserData(geometry.get(), const_cast<Slots*>(&slots));
    rtcSetGeometryIntersectFilterFunction(geometry.get(), filter_see_through);
    rtcSetGeometryOccludedFilterFunction(geometry.get(), filter_see_through);
  }
  rtcSetGeometryMask(geometry.get(), kRayMeetsAll);
  return geometry;
}

bool has_triangles_of(RTCGeometry geometry, const Mesh& mesh) {
  const auto* triangles =
      static_cast<const glm::uvec3*>(rtcGetGeometryBufferData(geometry, RTC_BUFFER_TYPE_INDEX, 0));
  return std::equal(mesh.triangles.begin(), mesh.triangles.end(), triangles);
}

void move_vertices(RTCGeometry geometry, const Mesh& mesh) {
  auto* vertices =
      static_cast<glm::vec3*>(rtcGetGeometryBufferData(geometry, RTC_BUFFER_TYPE_VERTEX, 0));
  std::copy(mesh.positions.begin(), mesh.positions.end(), vertices);
  rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
  rtcCommitGeometry(geometry);
}

Geometry make_instance(RTCDevice device, RTCScene mesh, const glm::mat4& world_from_object,
                       std::uint32_t mask) {
  Geometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE));
  rtcSetGeometryInstancedScene(geometry.get(), mesh);
  rtcSetGeometryTransform(geometry.get(), 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR,
                          glm::value_ptr(world_from_object));
  rtcSetGeometryMask(geometry.get(), mask);
  rtcCommitGeometry(geometry.get());
  return geometry;
}

}  // namespace lambent::embree
