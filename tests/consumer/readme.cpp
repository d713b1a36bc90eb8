// SPDX-License-Identifier: Apache-2.0
#include <lambent/lambent.h>

#include <array>
#include <cstdio>

int main(int argc, char** argv) {
  auto scene = lambent::load_scene(argc > 1 ? argv[1] : "scene.glb");  // or fill a Scene by hand
  if (!scene) return std::fprintf(stderr, "%s\n", scene.error().message().c_str()), 2;
  scene->environment.radiance = {1.5f, 2.0f, 2.6f};  // W/(m^2 sr)

  const lambent::World world(*scene);  // refers to the scene
  auto field = lambent::IrradianceField::make({}, lambent::open_bounds(world));
  if (!field) return std::fprintf(stderr, "%s\n", field.error().message().c_str()), 2;
  for (int i = 0; i < 8; ++i) field->update(world);  // an engine updates once a frame

  const std::array query = {lambent::FieldQuery{.position_ws = {0, 1, 0}, .normal_ws = {0, 1, 0}}};
  std::array<glm::vec3, 1> irradiance;
  field->irradiance(query, irradiance);  // what an engine shades with [W/m^2]
  std::printf("irradiance %g %g %g\n", irradiance[0].x, irradiance[0].y, irradiance[0].z);

  const lambent::Camera camera = lambent::look_at({2, 2, 3}, {0, 0, 0}, 0.8f);
  lambent::Renderer renderer(world, {.field = &*field});  // keeps its memory from frame to frame
  const auto frame = renderer.render(camera, {.width = 640, .height = 360});
  if (!frame) return std::fprintf(stderr, "%s\n", frame.error().message().c_str()), 2;
  return lambent::write_exr("frame.exr", frame->image) ? 0 : 1;
}
