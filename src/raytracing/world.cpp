// SPDX-License-Identifier: Apache-2.0
#include "lambent/world.h"

#include "raytracing/raytracer.h"
#include "scene/light_sampling.h"

namespace lambent {

World::World(const Scene& scene)
    : scene_(&scene),
      tracer_(make_embree_raytracer(scene)),
      emissive_(std::make_unique<EmissiveTriangles>(scene)) {}

World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

double World::build_ms() const {
  return tracer_->statistics().build_ms;
}
std::size_t World::bytes() const {
  return tracer_->statistics().bytes;
}

}  // namespace lambent
