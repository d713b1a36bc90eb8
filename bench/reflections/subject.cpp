// SPDX-License-Identifier: Apache-2.0
#include "bench/reflections/subject.h"

#include <utility>

#include "bench/stage.h"
#include "reference/path_tracer.h"
#include "scenes/mesh_builder.h"
#include "scenes/parts.h"

namespace lambent::reflections {
namespace {

IrradianceField lit_field(const World& world, const FieldSettings& settings, int updates) {
  IrradianceField field =
      bench::value_or_throw(IrradianceField::make(settings, open_bounds(world)));
  for (int i = 0; i < updates; ++i) field.update(world);
  return field;
}

}  // namespace

Subject::Subject(Scene made, const FieldSettings& settings, int updates)
    : scene(std::move(made)), world(scene), field(lit_field(world, settings, updates)) {}

Material metal(float roughness) {
  Material material;
  material.base_color = glm::vec4(0.9f, 0.9f, 0.9f, 1.0f);
  material.metallic = 1.0f;
  material.roughness = roughness;
  return material;
}

Scene room_with_plate(const Material& plate) {
  Scene scene;
  const int grey = scenes::add_lambert(scene, "grey", glm::vec3(0.6f));
  const int red = scenes::add_lambert(scene, "red", {0.7f, 0.1f, 0.1f});
  const int lamp = scenes::add_lambert(scene, "lamp", glm::vec3(0.0f), glm::vec3(8.0f));
  scenes::MeshBuilder builder;
  builder.room({-2.0f, 0.0f, -3.0f}, {2.0f, 3.0f, 3.0f});
  scenes::add_object(scene, builder.take("room", grey));
  builder.box({-1.99f, 0.01f, 2.9f}, {1.99f, 2.99f, 2.98f});
  scenes::add_object(scene, builder.take("behind", red));
  builder.box({-0.6f, 2.9f, -0.6f}, {0.6f, 2.95f, 0.6f});
  scenes::add_object(scene, builder.take("lamp", lamp));
  scene.materials.push_back(plate);
  builder.box({-1.5f, 0.4f, -2.95f}, {1.5f, 2.4f, -2.9f});
  scenes::add_object(scene, builder.take("plate", static_cast<int>(scene.materials.size()) - 1));
  return scene;
}

Reflected reflected_in(const Subject& subject, const Camera& camera, int side,
                       const Samples& samples) {
  FrameSettings frame = quality_settings(Quality::high);
  frame.width = frame.height = side;
  frame.samples = samples.ours;
  ReferenceSettings by;
  by.width = by.height = side;
  by.samples = samples.reference;
  by.layer_errors = true;
  const RenderedFrame picture = bench::value_or_throw(
      Renderer(subject.world, {.field = &subject.field}).render(camera, frame));
  const LayeredImage reference = render_reference(subject.world, camera, by).image;
  return {*picture.image.find("glossy"), *reference.find("glossy"),
          *reference.find("glossy.error")};
}

}  // namespace lambent::reflections
