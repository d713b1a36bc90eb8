// SPDX-License-Identifier: Apache-2.0
#include "scenes/parts.h"

namespace lambent::scenes {

int add_lambert(Scene& scene, std::string name, const glm::vec3& albedo,
                const glm::vec3& emission) {
  Material material;
  material.name = std::move(name);
  material.base_color = glm::vec4(albedo, 1.0f);
  material.metallic = 0.0f;
  material.specular = 0.0f;
  material.emission = emission;
  material.lambert = true;
  scene.materials.push_back(std::move(material));
  return static_cast<int>(scene.materials.size()) - 1;
}

int add_object(Scene& scene, Mesh mesh, const glm::mat4& world_from_object) {
  std::string name = mesh.name;
  scene.meshes.push_back(std::move(mesh));
  return add_instance(scene, std::move(name), static_cast<int>(scene.meshes.size()) - 1,
                      world_from_object);
}

int add_instance(Scene& scene, std::string name, int mesh, const glm::mat4& world_from_object) {
  scene.instances.push_back({std::move(name), mesh, world_from_object});
  return static_cast<int>(scene.instances.size()) - 1;
}

void add_camera(Scene& scene, std::string name, const glm::vec3& eye, const glm::vec3& target,
                float vertical_fov, float aspect) {
  Camera camera = look_at(eye, target, vertical_fov);
  camera.name = std::move(name);
  camera.aspect = aspect;
  scene.cameras.push_back(std::move(camera));
}

}  // namespace lambent::scenes
