// SPDX-License-Identifier: Apache-2.0
// Unlit surfaces in pictures for displays.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lambent/image.h"
#include "scenes/glb_writer.h"
#include "support/program.h"
#include "support/temporary_directory.h"
#include "support/unlit_scene.h"

namespace lambent::unlit_test {
namespace {

const std::string kQuick = " --size 32x32 --probes 4x4x4 --rays 32 --updates 2 --samples 4 ";

/// The red channel of the sign, of a picture by these options.
float sign_in(const std::string& scene, const std::string& options, const std::string& output) {
  const auto run = test::run_program("render " + scene + options + " -o " + output);
  EXPECT_EQ(run.status, 0) << run.errors;
  const auto image = read_image(output);
  if (!image) return -1.0f;
  const Image& all = image->layers[0].image;
  return *all.at(static_cast<int>(test::kSignX * 32.0f), 16);
}

TEST(UnlitSurfaces, ShowTheirColourInAnyLightAndByEachMethod) {
  const test::TemporaryDirectory directory;
  const std::string scene = directory.file("sign.glb"), png = directory.file("sign.png");
  constexpr float kLinear = 0.4f;
  constexpr float kStep = 0.01f;  // of eight sRGB-encoded bits, which are decoded here
  const std::string linear = " --tone-map linear ", simple = " --size 32x32 --samples 4 ";
  for (const float lamp : {0.01f, 1e5f}) {
    ASSERT_TRUE(scenes::write_glb(test::scene_with_sign(glm::vec3(kLinear), lamp), scene));
    EXPECT_NEAR(sign_in(scene, linear + kQuick, png), kLinear, kStep);
    EXPECT_NEAR(sign_in(scene, linear + simple + "--method direct", png), kLinear, kStep);
    EXPECT_NEAR(sign_in(scene, linear + simple + "--method reference", png), kLinear, kStep);
    EXPECT_NEAR(sign_in(scene, linear + simple + "--method direct --exposure=-3", png), kLinear,
                kStep);
    // In a file of radiance it is the colour's own
    EXPECT_NEAR(sign_in(scene, simple + "--method direct", directory.file("sign.exr")), kLinear,
                1e-3f);
  }
}

}  // namespace
}  // namespace lambent::unlit_test
