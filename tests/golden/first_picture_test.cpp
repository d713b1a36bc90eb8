// SPDX-License-Identifier: Apache-2.0
// The first view of files that nobody tuned for: where they are absent, the test is skipped.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>

#include "first_picture/survey.h"
#include "golden/truth.h"
#include "lambent/first_picture.h"
#include "lambent/world.h"
#include "support/view_coverage.h"

namespace lambent::first_picture_test {
namespace {

std::filesystem::path scenes_dir() {
  return test::shared_dir() / "scenes";
}

/// The scene of a file, without its cameras.
Expected<Scene> load_without_cameras(const std::filesystem::path& path) {
  Expected<Scene> scene = load_scene(path.string());
  if (scene) scene->cameras.clear();
  return scene;
}

TEST(FirstPicture, ShowsObjectsWhole) {
  const std::filesystem::path folder = scenes_dir() / "khronos";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is absent";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::filesystem::path& path = entry.path();
    if (path.extension() != ".gltf" && path.extension() != ".glb") continue;
    const Expected<Scene> scene = load_without_cameras(path);
    ASSERT_TRUE(scene.has_value()) << scene.error().message();
    const World world(*scene);
    const FirstView view = first_view(world).value();
    const test::Coverage coverage = test::coverage_of(world, view.camera, 192, 108);
    std::printf("%-60s %s covers %.2f backs %.2f%s\n", path.filename().c_str(),
                view.inside ? "inside" : "outside", coverage.met, coverage.backs,
                coverage.cut ? " CUT" : "");
    EXPECT_FALSE(view.inside) << path;
    EXPECT_FALSE(coverage.cut) << path;
    // A frame's fifth, unless what is thin or full of holes would have to be cut for that
    EXPECT_TRUE(coverage.met >= 0.2f || coverage.extent >= 0.75f) << path;
    EXPECT_LE(coverage.extent, 0.9f) << path;
    EXPECT_LE(coverage.met, 0.8f) << path;
  }
}

TEST(FirstPicture, StandsInRoomsAndLooksAlongThem) {
  for (const char* name :
       {"hotel_room/hotel_room.glb", "bevy/CornellBox/CornellBox.glb",
        "bevy/VolumetricFogExample/VolumetricFogExample.glb", "cornell_box/cornell_box.glb",
        "two_rooms/two_rooms.glb", "two_rooms/two_rooms_sealed.glb", "Sponza/Sponza.gltf"}) {
    const std::filesystem::path path = scenes_dir() / name;
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is absent";
    const Expected<Scene> scene = load_without_cameras(path);
    ASSERT_TRUE(scene.has_value()) << scene.error().message();
    const World world(*scene);
    const auto start = std::chrono::steady_clock::now();
    const FirstView view = first_view(world).value();
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    const float depth = test::coverage_of(world, view.camera).median_depth;
    const float share = depth / diagonal(world_bounds(*scene));
    std::printf("%-55s %s, median depth %.2f of the diagonal, chosen in %.3f s\n", name,
                view.inside ? "inside" : "OUTSIDE", share, time.count());
    EXPECT_TRUE(view.inside) << name;
    // Sponza is no room but a building of many
    const bool building = std::string(name) == "Sponza/Sponza.gltf";
    EXPECT_GT(share, building ? 0.1f : 0.25f) << name;
  }
}

}  // namespace
}  // namespace lambent::first_picture_test
