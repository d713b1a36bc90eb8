// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <cassert>
#include <chrono>
#include <glm/gtc/type_ptr.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "raytracing/embree/api.h"
#include "raytracing/raytracer.h"
#include "raytracing/surface.h"
#include "shared/random.h"

namespace lambent {
namespace {

template <class T, void (*release)(T)>
struct Releaser {
  using pointer = T;
  void operator()(T handle) const { release(handle); }
};
using Device = std::unique_ptr<RTCDevice, Releaser<RTCDevice, rtcReleaseDevice>>;
using SceneHandle = std::unique_ptr<RTCScene, Releaser<RTCScene, rtcReleaseScene>>;
using Geometry = std::unique_ptr<RTCGeometry, Releaser<RTCGeometry, rtcReleaseGeometry>>;

bool count_bytes(void* total, ssize_t bytes, bool /*post*/) {
  *static_cast<std::atomic<std::int64_t>*>(total) += bytes;
  return true;
}

/// A random number in [0, 1) that belongs to this hit alone, so that coverage is decided without
/// state.
float uniform_of_hit(float u, float v, float distance, std::uint32_t triangle) {
  const uvec3 mixed = hash_pcg3d(uvec3(floatBitsToUint(u) ^ (triangle * 0x9E3779B9u),
                                       floatBitsToUint(v), floatBitsToUint(distance)));
  return uniform_from_bits(mixed.x);
}

/// Embree asks of each candidate hit on a triangle that may be see-through: does it count?
void filter_by_coverage(const RTCFilterFunctionNArguments* args) {
  const auto& scene = *static_cast<const Scene*>(args->geometryUserPtr);
  for (unsigned lane = 0; lane < args->N; ++lane) {
    if (args->valid[lane] == 0) continue;
    const RTCHit hit = rtcGetHitFromHitN(args->hit, args->N, lane);
    const bool instanced = hit.instID[0] != RTC_INVALID_GEOMETRY_ID;
    const std::uint32_t instance = instanced ? hit.instID[0] : hit.geomID;
    const Material& material =
        scene.materials[scene.meshes[scene.instances[instance].mesh].material];
    const float coverage = coverage_at(scene, instance, hit.primID, {hit.u, hit.v});
    const float threshold =
        material.alpha_mode == AlphaMode::mask
            ? material.alpha_cutoff
            : uniform_of_hit(hit.u, hit.v, RTCRayN_tfar(args->ray, args->N, lane), hit.primID);
    const bool counts =
        material.alpha_mode == AlphaMode::mask ? coverage >= threshold : coverage > threshold;
    if (!counts) args->valid[lane] = 0;
  }
}

class EmbreeRayTracer final : public RayTracer {
 public:
  explicit EmbreeRayTracer(const Scene& scene);

  void closest_hits(std::span<const Ray> rays, std::span<Hit> hits) const override;
  void occlusions(std::span<const Ray> rays, std::span<std::uint8_t> occluded) const override;
  AccelerationStatistics statistics() const override { return statistics_; }

 private:
  Geometry make_mesh(const Mesh& mesh, const glm::mat4* world_from_object);
  [[noreturn]] void fail_with_device_error(const char* doing) const;

  const Scene& scene_;
  std::atomic<std::int64_t> bytes_ = 0;
  Device device_;
  std::vector<SceneHandle> mesh_scenes_;  // of the meshes placed more than once
  SceneHandle world_;
  std::vector<std::uint8_t> mirrored_;  // by instance: its transform turns faces inside out
  AccelerationStatistics statistics_;
};

EmbreeRayTracer::EmbreeRayTracer(const Scene& scene) : scene_(scene) {
  const auto start = std::chrono::steady_clock::now();
  device_.reset(rtcNewDevice(nullptr));
  if (!device_) throw std::runtime_error("Embree cannot start: this processor lacks SSE2");
  rtcSetDeviceMemoryMonitorFunction(device_.get(), count_bytes, &bytes_);

  // Meshes placed once go into the world's own hierarchy, which is faster to traverse; the others
  // are built once and instanced.
  std::vector<int> uses(scene.meshes.size(), 0);
  for (const Instance& instance : scene.instances) ++uses[instance.mesh];

  mesh_scenes_.resize(scene.meshes.size());
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    if (uses[i] < 2) continue;
    mesh_scenes_[i].reset(rtcNewScene(device_.get()));
    rtcSetSceneFlags(mesh_scenes_[i].get(), RTC_SCENE_FLAG_ROBUST);
    const Geometry geometry = make_mesh(scene.meshes[i], nullptr);
    rtcAttachGeometry(mesh_scenes_[i].get(), geometry.get());
    rtcCommitScene(mesh_scenes_[i].get());
  }

  world_.reset(rtcNewScene(device_.get()));
  // Robust: neighbouring triangles leave no crack, so that closed rooms stay dark.
  rtcSetSceneFlags(world_.get(), RTC_SCENE_FLAG_ROBUST);
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    const Mesh& mesh = scene.meshes[instance.mesh];
    statistics_.triangles += mesh.triangles.size();
    mirrored_.push_back(glm::determinant(glm::mat3(instance.world_from_object)) < 0.0f);
    Geometry geometry;
    if (mesh_scenes_[instance.mesh]) {
      geometry.reset(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_INSTANCE));
      rtcSetGeometryInstancedScene(geometry.get(), mesh_scenes_[instance.mesh].get());
      rtcSetGeometryTransform(geometry.get(), 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR,
                              glm::value_ptr(instance.world_from_object));
      rtcCommitGeometry(geometry.get());
    } else {
      geometry = make_mesh(mesh, &instance.world_from_object);
    }
    rtcAttachGeometryByID(world_.get(), geometry.get(), static_cast<unsigned>(i));
  }
  rtcCommitScene(world_.get());
  if (rtcGetDeviceError(device_.get()) != RTC_ERROR_NONE) fail_with_device_error("building");

  statistics_.instances = scene.instances.size();
  statistics_.bytes = static_cast<std::size_t>(std::max<std::int64_t>(bytes_, 0));
  statistics_.build_ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

void EmbreeRayTracer::fail_with_device_error(const char* doing) const {
  throw std::runtime_error(std::string("Embree failed while ") + doing +
                           " the acceleration structure (out of memory?)");
}

Geometry EmbreeRayTracer::make_mesh(const Mesh& mesh, const glm::mat4* world_from_object) {
  Geometry geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
  auto* vertices = static_cast<glm::vec3*>(
      rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                              sizeof(glm::vec3), mesh.positions.size()));
  auto* triangles = static_cast<glm::uvec3*>(
      rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              sizeof(glm::uvec3), mesh.triangles.size()));
  if ((vertices == nullptr && !mesh.positions.empty()) ||
      (triangles == nullptr && !mesh.triangles.empty())) {
    fail_with_device_error("filling");
  }
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    vertices[v] = world_from_object != nullptr
                      ? glm::vec3(*world_from_object * glm::vec4(mesh.positions[v], 1.0f))
                      : mesh.positions[v];
  }
  std::copy(mesh.triangles.begin(), mesh.triangles.end(), triangles);
  if (scene_.materials[mesh.material].alpha_mode != AlphaMode::opaque) {
    rtcSetGeometryUserData(geometry.get(), const_cast<Scene*>(&scene_));
    rtcSetGeometryIntersectFilterFunction(geometry.get(), filter_by_coverage);
    rtcSetGeometryOccludedFilterFunction(geometry.get(), filter_by_coverage);
  }
  rtcCommitGeometry(geometry.get());
  return geometry;
}

RTCRay to_embree(const Ray& ray) {
  RTCRay result{};
  result.org_x = ray.origin.x;
  result.org_y = ray.origin.y;
  result.org_z = ray.origin.z;
  result.tnear = ray.t_min;
  result.dir_x = ray.direction.x;
  result.dir_y = ray.direction.y;
  result.dir_z = ray.direction.z;
  result.tfar = ray.t_max;
  result.mask = 0xFFFFFFFFu;
  return result;
}

void EmbreeRayTracer::closest_hits(std::span<const Ray> rays, std::span<Hit> hits) const {
  assert(rays.size() == hits.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    RTCRayHit query{};
    query.ray = to_embree(rays[i]);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    embree::intersect(world_.get(), query);

    Hit& hit = hits[i];
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
      hit.distance = kInfiniteDistance;
      continue;
    }
    const bool instanced = query.hit.instID[0] != RTC_INVALID_GEOMETRY_ID;
    hit.instance = instanced ? query.hit.instID[0] : query.hit.geomID;
    hit.distance = query.ray.tfar;
    hit.triangle = query.hit.primID;
    hit.barycentrics = {query.hit.u, query.hit.v};

    // Embree's normal is of object space for instances; so must the direction be.
    glm::vec3 normal(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z);
    if (instanced) {
      const glm::mat3 linear(scene_.instances[hit.instance].world_from_object);
      normal = glm::transpose(glm::inverse(linear)) * normal;
    }
    const bool faces_ray = glm::dot(normal, rays[i].direction) < 0.0f;
    // Baked vertices of a mirrored placement run the other way round; instanced normals do not.
    hit.front_face = faces_ray != (!instanced && mirrored_[hit.instance] != 0);
  }
}

void EmbreeRayTracer::occlusions(std::span<const Ray> rays,
                                 std::span<std::uint8_t> occluded) const {
  assert(rays.size() == occluded.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    RTCRay query = to_embree(rays[i]);
    embree::occluded(world_.get(), query);
    // Embree marks an occluded ray by a far end of minus infinity.
    occluded[i] = query.tfar < 0.0f ? 1 : 0;
  }
}

}  // namespace

std::unique_ptr<RayTracer> make_embree_raytracer(const Scene& scene) {
  return std::make_unique<EmbreeRayTracer>(scene);
}

}  // namespace lambent
