// SPDX-License-Identifier: Apache-2.0
// Which light a scene without any is given.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "first_picture/daylight.h"
#include "first_picture/seen.h"
#include "lambent/first_picture.h"
#include "raytracing/world_access.h"
#include "scenes/builtin.h"
#include "support/box_scenes.h"
#include "support/hand_made.h"

namespace lambent::first_light_test {
namespace {

using test::box_mesh;
using test::scene_of;

FirstLight chosen(const Scene& scene) {
  const World world(scene);
  return choose_first_light(world, first_view(world).value().camera);
}

Scene unlit(const std::string& name) {
  Scene scene = scenes::make(name).value();
  // Animations may refer to lights: they stay, and are black
  for (Light& light : scene.lights) light.intensity = glm::vec3(0.0f);
  scene.environment = {};
  return scene;
}

/// Clear glass.
Material clear_pane() {
  Material pane;
  pane.metallic = 0.0f;
  pane.roughness = 0.0f;
  pane.transmission = 1.0f;
  return pane;
}

TEST(FirstLight, IsTheScenesWhereItHasOne) {
  Scene lit = scene_of({box_mesh({-1, -1, -1}, {1, 1, 1})});
  lit.lights.emplace_back();
  EXPECT_EQ(chosen(lit), FirstLight::scene);
  Scene sky = scene_of({box_mesh({-1, -1, -1}, {1, 1, 1})});
  sky.environment.radiance = glm::vec3(1.0f);
  EXPECT_EQ(chosen(sky), FirstLight::scene);
}

TEST(FirstLight, DoesNotTakeALightWithoutIntensityForOne) {
  Scene dark = scene_of({box_mesh({-1, -1, -1}, {1, 1, 1})});
  dark.lights.emplace_back().intensity = glm::vec3(0.0f);
  EXPECT_EQ(chosen(dark), FirstLight::studio);
}

TEST(FirstLight, IsAStudioForObjects) {
  EXPECT_EQ(chosen(scene_of({box_mesh({-1, -1, -1}, {1, 1, 1})})), FirstLight::studio);
}

TEST(FirstLight, IsAStudioForAStatueOnAPlinthAndTheSunsForOneOnASlab) {
  const Mesh statue = box_mesh({-0.2f, 1.2f, -0.2f}, {0.2f, 2.2f, 0.2f});
  EXPECT_EQ(chosen(scene_of({box_mesh({-0.3f, 0, -0.3f}, {0.3f, 1.2f, 0.3f}), statue})),
            FirstLight::studio);
  EXPECT_EQ(chosen(scene_of({box_mesh({-0.3f, 1.1f, -0.3f}, {0.3f, 1.2f, 0.3f}), statue})),
            FirstLight::sun);
  const Mesh terrace = box_mesh({-9, 0, -9}, {9, 1.2f, 9});
  EXPECT_EQ(chosen(scene_of({terrace, box_mesh({-2, 1.2f, -2}, {1, 3.2f, 1})})), FirstLight::sun);
}

TEST(FirstLight, IsAStudioForThingsOnASweepOfPaperAndTheSunsBeforeACliff) {
  Scene scene = scene_of({box_mesh({-0.4f, 0, -0.4f}, {0.4f, 0.8f, 0.4f}), test::sweep_mesh()});
  EXPECT_EQ(chosen(scene), FirstLight::studio);
  for (Instance& instance : scene.instances) {
    instance.world_from_object = glm::scale(glm::mat4(1.0f), glm::vec3(20.0f));
  }
  EXPECT_EQ(chosen(scene), FirstLight::sun);
}

TEST(FirstLight, IsTheSunsInAWalledYard) {
  // A bench between walls that are as high as a sweep of paper
  EXPECT_EQ(
      chosen(scene_of({box_mesh({-5, -0.1f, -5}, {5, 0, 5}), box_mesh({-5, 0, -5}, {-4.9f, 2, 5}),
                       box_mesh({4.9f, 0, -5}, {5, 2, 5}), box_mesh({-5, 0, -5}, {5, 2, -4.9f}),
                       box_mesh({-5, 0, 4.9f}, {5, 2, 5}),
                       box_mesh({-0.5f, 0, -0.2f}, {0.5f, 0.5f, 0.2f})})),
      FirstLight::sun);
}

TEST(FirstLight, IsSunAndSkyForOpenScenes) {
  // A ground with things on it, and a court
  EXPECT_EQ(chosen(scene_of({box_mesh({-9, -1, -9}, {9, 0, 9}), box_mesh({-2, 0, -2}, {0, 3, 0}),
                             box_mesh({3, 0, 1}, {5, 2, 3})})),
            FirstLight::sun);
  EXPECT_EQ(chosen(unlit("atrium")), FirstLight::sun);
}

TEST(FirstLight, IsASkyInProportionWhereSunsShineOutOfTheVoid) {
  Scene scene = scene_of({box_mesh({-9, -1, -9}, {9, 0, 9}), box_mesh({-2, 0, -2}, {0, 3, 0}),
                          box_mesh({3, 0, 1}, {5, 2, 3})});
  Light& sun = scene.lights.emplace_back();
  sun.type = Light::Type::directional;
  sun.direction_ws = glm::normalize(glm::vec3(0.3f, -1.0f, 0.2f));
  sun.intensity = glm::vec3(4.0f, 3.6f, 3.0f);  // a fifth of that of a clear afternoon
  EXPECT_EQ(chosen(scene), FirstLight::sky);
  const World world(scene);
  const Camera camera = first_view(world).value().camera;
  set_first_light(FirstLight::sky, world, camera, scene);
  EXPECT_EQ(scene.lights.size(), 1u);
  EXPECT_TRUE(is_day_sky(scene.environment));
  EXPECT_NEAR(scene.environment.radiance.b, 0.2f, 1e-4f);
  EXPECT_EQ(choose_first_light(World(scene), camera), FirstLight::scene) << "it has a sky now";

  // It follows the suns, and nothing changes where it is right
  scene.lights[0].intensity *= 2.0f;
  const std::uint32_t before = scene.environment.revision;
  adjust_first_sky(scene);
  EXPECT_NEAR(scene.environment.radiance.b, 0.4f, 1e-4f);
  const std::uint32_t revision = scene.environment.revision;
  EXPECT_GT(revision, before);
  adjust_first_sky(scene);
  EXPECT_EQ(scene.environment.revision, revision);

  // So it is where the camera looks down on the ground and sees nothing past it
  scene.environment = {};
  const Camera down = look_at({0, 1.5f, 0.5f}, {0, 0, 0.4f}, 0.5f);
  EXPECT_EQ(choose_first_light(World(scene), down), FirstLight::sky);

  // An object by itself stays before the black that its author left, and so does a lamp's light
  Scene object = scene_of({box_mesh({-1, -1, -1}, {1, 1, 1})});
  object.lights.push_back(sun);
  EXPECT_EQ(chosen(object), FirstLight::scene);
  scene.environment = {};
  scene.lights[0].type = Light::Type::point;
  EXPECT_EQ(chosen(scene), FirstLight::scene);
}

TEST(FirstLight, IsASkyWhereTheSunShinesIntoRooms) {
  // A room with a window to the south, seen from its north, and the same with a pane in the window
  Scene room = scene_of({box_mesh({-3, 0, -3}, {3, 0.1f, 3}), box_mesh({-3, 2.9f, -3}, {3, 3, 3}),
                         box_mesh({-3, 0, -3}, {-2.9f, 3, 3}), box_mesh({2.9f, 0, -3}, {3, 3, 3}),
                         box_mesh({-3, 0, -3}, {3, 3, -2.9f}), box_mesh({-3, 0, 2.9f}, {3, 1, 3}),
                         box_mesh({-3, 2.2f, 2.9f}, {3, 3, 3})});
  Light& sun = room.lights.emplace_back();
  sun.type = Light::Type::directional;
  sun.direction_ws = glm::normalize(glm::vec3(0.2f, -1.0f, -1.0f));
  sun.intensity = glm::vec3(4.0f);
  const Camera to_window = look_at({0, 1.6f, -2.5f}, {0, 1.6f, 3}, 1.2f);
  const Camera to_wall = look_at({0, 1.6f, -1.0f}, {0, 1.6f, -3}, 1.2f);
  EXPECT_EQ(choose_first_light(World(room), to_window), FirstLight::sky);
  // Its light is on the wall, even where the window is behind the camera
  EXPECT_EQ(choose_first_light(World(room), to_wall), FirstLight::sky);
  test::add(room, test::quad({-3, 1, 3}, {6, 0, 0}, {0, 1.2f, 0}, 1));
  room.materials.push_back(clear_pane());
  EXPECT_EQ(choose_first_light(World(room), to_window), FirstLight::sky);
  room.materials.back().transmission = 0.0f;
  EXPECT_EQ(choose_first_light(World(room), to_window), FirstLight::scene);
  EXPECT_EQ(choose_first_light(World(room), to_wall), FirstLight::scene);
}

TEST(FirstLight, IsTheSunsUnderSkylightsWithAndWithoutPanes) {
  // A hall with a skylight of 3 x 3 m in its roof
  Scene hall = scene_of(
      {box_mesh({-5, -0.1f, -5}, {5, 0, 5}), box_mesh({-5, 0, -5}, {-4.9f, 4, 5}),
       box_mesh({4.9f, 0, -5}, {5, 4, 5}), box_mesh({-5, 0, -5}, {5, 4, -4.9f}),
       box_mesh({-5, 0, 4.9f}, {5, 4, 5}), box_mesh({-5, 4, -5}, {5, 4.1f, -1.5f}),
       box_mesh({-5, 4, 1.5f}, {5, 4.1f, 5}), box_mesh({-5, 4, -1.5f}, {-1.5f, 4.1f, 1.5f}),
       box_mesh({1.5f, 4, -1.5f}, {5, 4.1f, 1.5f})});
  const Camera camera = look_at({4, 1.6f, 4}, {-2, 1.0f, -2}, 1.0f);
  EXPECT_EQ(choose_first_light(World(hall), camera), FirstLight::sun);
  test::add(hall, test::quad({-1.5f, 4.05f, -1.5f}, {3, 0, 0}, {0, 0, 3}, 1));
  hall.materials.push_back(clear_pane());
  EXPECT_EQ(choose_first_light(World(hall), camera), FirstLight::sun);
  hall.materials.back().transmission = 0.0f;
  EXPECT_EQ(choose_first_light(World(hall), camera), FirstLight::lamps);
}

TEST(FirstLight, IsLampsInClosedRooms) {
  EXPECT_EQ(chosen(unlit("two-rooms")), FirstLight::lamps);
}

TEST(FirstLight, IsTheSunsInACourtThatItsLampsLightInPart) {
  // A court of 12 m, open above, with a lamp that one wall hides from half of it
  const auto court = [](bool divided) {
    std::vector<Mesh> parts = {
        box_mesh({-6, -0.2f, -6}, {6, 0, 6}), box_mesh({-6.2f, 0, -6}, {-6, 8, 6}),
        box_mesh({6, 0, -6}, {6.2f, 8, 6}), box_mesh({-6, 0, -6.2f}, {6, 8, -6}),
        box_mesh({-6, 0, 6}, {6, 8, 6.2f})};
    if (divided) parts.push_back(box_mesh({-6, 0, -1}, {2, 8, -0.8f}));
    Scene scene = scene_of(std::move(parts));
    scene.materials.push_back(test::lambert(glm::vec3(0.0f), glm::vec3(5.0f)));
    test::add(scene, test::quad({-5.9f, 3, 2}, {0, 2, 0}, {0, 0, 2}, 1));
    return scene;
  };
  const Camera camera = look_at({5, 1.6f, 0.5f}, {-6, 1.6f, -4}, 1.0f);
  const Scene lit = court(false), partly = court(true);
  EXPECT_EQ(choose_first_light(World(lit), camera), FirstLight::scene);
  EXPECT_EQ(choose_first_light(World(partly), camera), FirstLight::sun);
}

TEST(FirstLight, IsWhatLampsEmitWhereTheyLightTheRoom) {
  EXPECT_EQ(chosen(unlit("cornell")), FirstLight::scene);
}

TEST(FirstLight, IsWhatALampSendsBesideBrighterOnesBehindAWall) {
  // Two closed rooms; the lamp in the other one has 60 times the power
  Scene scene = scene_of({box_mesh({-3, -0.2f, -3}, {9, 0, 3}), box_mesh({-3, 3, -3}, {9, 3.2f, 3}),
                          box_mesh({-3.2f, 0, -3}, {-3, 3, 3}), box_mesh({9, 0, -3}, {9.2f, 3, 3}),
                          box_mesh({-3, 0, -3.2f}, {9, 3, -3}), box_mesh({-3, 0, 3}, {9, 3, 3.2f}),
                          box_mesh({3, 0, -3}, {3.2f, 3, 3})});
  scene.materials.push_back(test::lambert(glm::vec3(0.0f), glm::vec3(100.0f)));
  Mesh bulb = box_mesh({-0.1f, 2.3f, -0.1f}, {0.1f, 2.5f, 0.1f});
  bulb.material = 1;
  test::add(scene, std::move(bulb));
  scene.materials.push_back(test::lambert(glm::vec3(0.0f), glm::vec3(160.0f)));
  test::add(scene, test::quad({4, 2.9f, -1.5f}, {3, 0, 0}, {0, 0, 3}, 2));
  const Camera camera = look_at({-2.5f, 1.6f, 2.5f}, {2, 1, -2}, 1.0f);
  EXPECT_EQ(choose_first_light(World(scene), camera), FirstLight::scene);
}

TEST(FirstLight, IsWhatLampsInOtherRoomsSendThroughADoor) {
  // A corridor 2 m wide, and a lit room beyond a door at its far end, to the right
  const auto corridor = [](float radiance) {
    Scene scene = scene_of(
        {box_mesh({-1, -0.2f, -10}, {6, 0, 0}), box_mesh({-1, 2.6f, -10}, {6, 2.8f, 0}),
         box_mesh({-1.2f, 0, -10}, {-1, 2.6f, 0}), box_mesh({6, 0, -10}, {6.2f, 2.6f, 0}),
         box_mesh({-1, 0, -10.2f}, {6, 2.6f, -10}), box_mesh({-1, 0, 0}, {6, 2.6f, 0.2f}),
         box_mesh({1, 0, -8.5f}, {1.2f, 2.6f, 0}), box_mesh({1, 0, -10}, {1.2f, 2.6f, -9.3f}),
         box_mesh({1.2f, 0, -7}, {6, 2.6f, -6.8f})});
    scene.materials.push_back(test::lambert(glm::vec3(0.0f), glm::vec3(radiance)));
    test::add(scene, test::quad({3.5f, 2.5f, -7.2f}, {1, 0, 0}, {0, 0, 0.3f}, 1));
    return scene;
  };
  const Camera camera = look_at({0, 1.6f, -0.5f}, {0, 1.4f, -10}, 1.0f);
  const Scene lit = corridor(60.0f), glowing = corridor(0.8f);
  const World world(lit);
  const ViewLight light = measure_view_light(world, sample_view(world, camera));
  ASSERT_LT(light.lit_by_emission, 0.4f);
  EXPECT_EQ(choose_first_light(world, camera), FirstLight::scene) << light.lit_by_emission;
  EXPECT_EQ(choose_first_light(World(glowing), camera), FirstLight::lamps);
  // A lamp whose light does not reach the corridor changes nothing
  Scene sealed = corridor(0.8f);
  sealed.materials.push_back(test::lambert(glm::vec3(0.0f), glm::vec3(60.0f)));
  test::add(sealed, test::quad({3.5f, 2.5f, -3.0f}, {1, 0, 0}, {0, 0, 0.3f}, 2));
  EXPECT_EQ(choose_first_light(World(sealed), camera), FirstLight::lamps);
}

TEST(FirstLight, IsNotWhatASmallEmitterOnAnObjectSends) {
  Scene scene = scene_of({box_mesh({-1, -1, -1}, {1, 1, 1})});
  scene.materials.push_back(test::lambert(glm::vec3(0.0f), glm::vec3(5.0f)));
  test::add(scene, test::quad({-0.2f, -0.2f, 1.01f}, {0.4f, 0, 0}, {0, 0.4f, 0}, 1));
  EXPECT_EQ(chosen(scene), FirstLight::studio);
}

TEST(FirstLight, IsNotWhatABlackEmissiveMaterialSends) {
  Scene scene = scene_of({box_mesh({-1, -1, -1}, {1, 1, 1})});
  Texture black;
  black.levels.push_back({1, 1, {0, 0, 0, 255}});
  scene.textures.push_back(black);
  scene.materials[0].emission = glm::vec3(1.0f);
  scene.materials[0].emission_texture.texture = 0;
  EXPECT_EQ(chosen(scene), FirstLight::studio);
}

TEST(FirstLight, IsNotWhatSignsGlow) {
  // A sign before a wall lights some of it, but the eye would see a white sign and a black wall
  Scene scene = scene_of({box_mesh({-4, -2, -0.2f}, {4, 2, 0})});
  scene.materials.push_back(test::lambert(glm::vec3(0.0f), glm::vec3(1.0f)));
  test::add(scene, test::quad({-0.5f, 1.2f, 0.05f}, {1, 0, 0}, {0, 0.4f, 0}, 1));
  EXPECT_EQ(chosen(scene), FirstLight::studio);
}

TEST(FirstLight, IsWhatSoftBoxesSendWhereTheyLightAll) {
  // One is in the picture, fifty times as bright as what it lights
  Scene scene = scene_of({box_mesh({-0.2f, 0, -0.2f}, {0.2f, 0.5f, 0.2f})});
  scene.materials.push_back(test::lambert(glm::vec3(0.0f), glm::vec3(30.0f)));
  test::add(scene, test::quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, 0));
  test::add(scene, test::quad({-0.9f, 0.9f, 0.9f}, {0.3f, 0, 0.3f}, {0.1f, 0.4f, -0.1f}, 1));
  const World world(scene);
  const Camera camera = look_at({0, 1, 3}, {0, 0.4f, 0}, 0.8f);
  const ViewLight light = measure_view_light(world, sample_view(world, camera));
  ASSERT_LT(light.emission_ratio, 0.1f) << light.lit_by_emission;
  ASSERT_GT(light.lit_by_emission, 0.9f) << light.emission_ratio;
  EXPECT_EQ(choose_first_light(world, camera), FirstLight::scene);
  // A label that glows as brightly as any without emissive strength is no lamp
  scene.materials[1].emission = glm::vec3(1.0f);
  EXPECT_NE(choose_first_light(World(scene), camera), FirstLight::scene);
}

TEST(FirstLight, IsNotTheColourOfAnUnlitPoster) {
  // A room without a front wall, and a poster of two square metres on its back wall
  const auto room = [](bool unlit_walls) {
    Scene scene =
        scene_of({box_mesh({-3, -0.2f, -3}, {3, 0, 3}), box_mesh({-3, 3, -3}, {3, 3.2f, 3}),
                  box_mesh({-3.2f, 0, -3}, {-3, 3, 3}), box_mesh({3, 0, -3}, {3.2f, 3, 3}),
                  box_mesh({-3, 0, -3.2f}, {3, 3, -3}), box_mesh({-3, 0, 3}, {3, 3, 3.2f})});
    scene.materials[0].unlit = unlit_walls;
    scene.materials.push_back(test::lambert(glm::vec3(0.7f)));
    scene.materials.back().unlit = !unlit_walls;
    test::add(scene, test::quad({-1, 1, -2.95f}, {2, 0, 0}, {0, 1, 0}, 1));
    return scene;
  };
  const Camera camera = look_at({0, 1.6f, 2.9f}, {0, 1.4f, 0}, 1.0f);
  const Scene poster = room(false), baked = room(true);
  EXPECT_EQ(choose_first_light(World(poster), camera), FirstLight::lamps);
  EXPECT_EQ(choose_first_light(World(baked), camera), FirstLight::scene)
      << "walls whose light was baked light what stands before them";
}

TEST(FirstLight, IsWhatASmallBulbSendsAllAround) {
  // A bulb 6 cm wide, above a floor and before a wall, in the picture
  Scene scene =
      scene_of({box_mesh({-3, -0.2f, -3}, {3, 0, 3}), box_mesh({-3, 0, -3.2f}, {3, 3, -3}),
                box_mesh({-0.3f, 0, -1}, {0.3f, 1.7f, -0.6f})});
  scene.materials.push_back(test::lambert(glm::vec3(0.0f), glm::vec3(400.0f)));
  Mesh bulb = box_mesh({0.97f, 2.0f, -0.53f}, {1.03f, 2.06f, -0.47f});
  bulb.material = 1;
  test::add(scene, std::move(bulb));
  const World world(scene);
  const Camera camera = look_at({0, 1.6f, 5}, {0, 1.2f, 0}, 1.0f);
  EXPECT_EQ(choose_first_light(world, camera), FirstLight::scene);
}

/// An alley that is open above, with tubes of this height [m] on its walls.
Scene alley(float tube_height, int tubes = 8) {
  Scene scene = scene_of({box_mesh({-3, -0.2f, -20}, {3, 0, 2}), box_mesh({-3, 0, -20}, {-2, 8, 2}),
                          box_mesh({2, 0, -20}, {3, 8, 2}), box_mesh({-3, 0, -21}, {3, 8, -20})});
  scene.materials.push_back(test::lambert(glm::vec3(0.0f), glm::vec3(25.0f)));
  for (int tube = 0; tube < tubes; ++tube) {
    const float side = tube % 2 == 0 ? -1.0f : 1.0f, z = -2.0f * static_cast<float>(tube) - 2.0f;
    test::add(scene, test::quad({side * 1.8f, 2, z}, {0, 0, 0.5f}, {0, tube_height, 0}, 1));
  }
  return scene;
}

TEST(FirstLight, IsWhatNeonTubesSendAtNight) {
  const Camera camera = look_at({0, 1.5f, 1.5f}, {0, 1.5f, -9}, 0.9f);
  const Scene bright_alley = alley(0.25f), dim_alley = alley(0.1f), dark_alley = alley(0.1f, 1);
  const World bright(bright_alley), dim(dim_alley), dark(dark_alley);
  ASSERT_LT(enclosure(bright, camera), 0.75f) << "counts as a room, where darker walls will do";
  // Walls and ground are 200 times as dark as the tubes
  const ViewLight light = measure_view_light(bright, sample_view(bright, camera));
  ASSERT_LT(light.emission_ratio, 0.01f);
  ASSERT_GT(light.lit_by_emission, 0.9f);
  EXPECT_EQ(choose_first_light(bright, camera), FirstLight::scene) << light.emission_ratio;
  ASSERT_LT(measure_view_light(dim, sample_view(dim, camera)).emission_ratio, 0.003f);
  EXPECT_EQ(choose_first_light(dim, camera), FirstLight::scene);
  // Beside a single one, most of the walls would look black
  ASSERT_LT(measure_view_light(dark, sample_view(dark, camera)).emission_ratio, 0.001f);
  EXPECT_EQ(choose_first_light(dark, camera), FirstLight::sun);
}

TEST(FirstLight, LampsReachMostOfWhatTheCameraSees) {
  for (const char* name : {"two-rooms", "house"}) {
    Scene scene = unlit(name);
    World world(scene);
    const Camera camera = first_view(world).value().camera;
    set_first_light(FirstLight::lamps, world, camera, scene);
    ASSERT_TRUE(world.update().has_value());
    const SeenView view = sample_view(world, camera);
    float reached = 0.0f;
    for (const SeenPoint& seen : view.points) {
      bool lit = false;
      for (const Light& lamp : scene.lights) {
        const PunctualSample sample = sample_punctual(lamp, seen.point.position_ws);
        if (glm::dot(sample.to_light, seen.point.normal_ws) <= 0.0f) continue;
        const LightCandidate light{sample.to_light, sample.distance, sample.irradiance, 0};
        lit = lit || !tracer_of(world).occluded(
                         shadow_ray(seen.point.position_ws, seen.point.geometric_normal_ws, light));
      }
      if (lit) reached += 1.0f;
    }
    EXPECT_GT(reached, 0.7f * static_cast<float>(view.points.size())) << name;
  }
}

TEST(FirstLight, StudioLightsTheSideThatTheCameraSees) {
  Scene scene = scene_of({box_mesh({-1, -1, -1}, {1, 1, 1})});
  World world(scene);
  for (const glm::vec3& eye : {glm::vec3(0, 1, 5), glm::vec3(5, 1, 0), glm::vec3(-3, 1, -4)}) {
    set_first_light(FirstLight::studio, world, look_at(eye, glm::vec3(0.0f), 0.8f), scene);
    ASSERT_EQ(scene.lights.size(), 1u);
    EXPECT_LT(glm::dot(scene.lights[0].direction_ws, eye), 0.0f);
    EXPECT_GT(scene.environment.map.width, 0);
  }
}

TEST(FirstLight, LeavesTheSceneAsItIsWhereItsOwnIsChosen) {
  Scene scene = scenes::make("two-rooms").value();
  World world(scene);
  const std::vector<Light> before = scene.lights;
  set_first_light(FirstLight::scene, world, scene.cameras[0], scene);
  EXPECT_EQ(scene.lights, before);
}

}  // namespace
}  // namespace lambent::first_light_test
