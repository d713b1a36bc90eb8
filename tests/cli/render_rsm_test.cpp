// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "lambent/image.h"
#include "support/program.h"
#include "support/temporary_directory.h"

namespace lambent::render_rsm_test {
namespace {

using test::ProgramResult;
using test::run_program;
using ::testing::HasSubstr;
using ::testing::Not;

class RenderRsm : public ::testing::Test {
 protected:
  ProgramResult render(const std::string& arguments) const {
    return run_program("render " + arguments + " -o " + exr);
  }
  double mean(const std::string& layer) const {
    const auto image = read_image(exr);
    double sum = 0.0;
    for (const float value : image->find(layer)->pixels) sum += value;
    return sum / static_cast<double>(image->find(layer)->pixels.size());
  }
  test::TemporaryDirectory directory;
  std::string exr = directory.file("out.exr");
};

TEST_F(RenderRsm, KeepsALayerOfEachStage) {
  const ProgramResult result =
      render("cornell-spot --method rsm --rsm-size 64 --size 37x23 --samples 1 --layers");
  ASSERT_EQ(result.status, 0) << result.errors;
  const auto image = read_image(exr);
  ASSERT_TRUE(image) << image.error().message();
  for (const char* name :
       {"rsm.flux", "rsm.mosaic", "rsm.gathered", "rsm.interleaved", "rsm.blurred"}) {
    ASSERT_NE(image->find(name), nullptr) << name;
    EXPECT_GT(mean(name), 0.0) << name;
  }
  EXPECT_GT(mean("indirect"), 0.0);
}

TEST_F(RenderRsm, RendersOddSizesPatternsLayoutsAndScales) {
  for (const std::string options :
       {"--size 1x1", "--size 5x3 --sub-images 16 --sub-maps 8", "--size 33x17 --rsm-downscale 3",
        "--size 16x16 --rsm-pattern disk --rsm-radius 1", "--size 16x16 --rsm-layout full",
        "--size 16x16 --rsm-layout sub-maps --sub-blur 0", "--size 16x16 --rsm-from-camera",
        "--size 16x16 --rsm-visibility 2 --irregular-blur", "--size 16x16 --rsm-texels 0"}) {
    const ProgramResult result =
        render("cornell-spot --method rsm --rsm-size 32 --samples 1 --layers " + options);
    ASSERT_EQ(result.status, 0) << options << ": " << result.errors;
    EXPECT_GE(mean("indirect"), 0.0) << options;
  }
}

TEST_F(RenderRsm, IsBlackWhereNoLightIsWithoutExtent) {
  ASSERT_EQ(render("cornell --method rsm --size 16x16 --samples 1 --layers").status, 0);
  EXPECT_EQ(mean("indirect"), 0.0);
  EXPECT_GT(mean("direct"), 0.0);
}

TEST_F(RenderRsm, WithTheFieldBringsTheLightOfLaterBounces) {
  const std::string common = "cornell-spot --size 24x24 --samples 1 --layers ";
  ASSERT_EQ(render(common + "--method rsm --rsm-visibility 4").status, 0);
  const double first_bounce = mean("indirect");
  const std::string field = "--probes 6x6x6 --rays 64 --updates 4 ";
  ASSERT_EQ(render(common + field + "--method field").status, 0);
  const double all = mean("indirect");
  ASSERT_EQ(render(common + field + "--method rsm+field --rsm-visibility 4").status, 0);
  EXPECT_GT(mean("indirect"), 1.2 * first_bounce);
  EXPECT_NEAR(mean("indirect") / all, 1.0, 0.1);  // nothing is counted twice
}

TEST_F(RenderRsm, WithTheFieldCountsEmissionOnce) {
  const std::string common =
      "cornell --size 16x16 --samples 1 --layers --probes 6x6x6 --rays 64 "
      "--quality draft --no-corrections ";
  ASSERT_EQ(render(common + "--method field").status, 0);
  const double all = mean("indirect");
  ASSERT_EQ(render(common + "--method rsm+field").status, 0);
  EXPECT_NEAR(mean("indirect") / all, 1.0, 1e-4);
}

TEST_F(RenderRsm, TellsOfManyLightsThatAreSlow) {
  const std::string common = "house --size 8x5 --samples 1 --rsm-size 16 --method rsm ";
  EXPECT_THAT(render(common).errors, Not(HasSubstr("--rsm-merge-maps")));
  const ProgramResult many = render(common + "--rsm-texels 1025");
  EXPECT_EQ(many.status, 0);
  EXPECT_THAT(many.errors, HasSubstr("16 lights have 16400 texels to gather, 1025 each"));
  EXPECT_THAT(many.errors, HasSubstr("--rsm-merge-maps"));
  EXPECT_THAT(render(common + "--rsm-texels 1025 --rsm-merge-maps").errors,
              Not(HasSubstr("texels to gather")));
}

TEST_F(RenderRsm, AsksLightsInSubImages) {
  const std::string common = "house --size 48x27 --samples 1 --layers --rsm-size 16 --method ";
  ASSERT_EQ(render(common + "rsm").status, 0);
  const double plain = mean("direct");
  for (const std::string options :
       {"rsm --rsm-direct", "rsm --rsm-direct --rsm-direct-lights 4 --rsm-merge-maps",
        "rsm+field --probes 4x4x4 --rays 32 --updates 1 --rsm-direct --rsm-direct-lights 65536"}) {
    const ProgramResult result = render(common + options);
    ASSERT_EQ(result.status, 0) << options << ": " << result.errors;
    EXPECT_NEAR(mean("direct") / plain, 1.0, 0.02) << options;
    EXPECT_GT(mean("indirect"), 0.0) << options;
  }
}

struct BadUse {
  const char* arguments;
  const char* named;
};

TEST_F(RenderRsm, RefusesWhatMakesNoSenseAndSaysWhy) {
  for (const BadUse& use :
       {BadUse{"--method field --rsm-size 64", "--rsm-size"},
        BadUse{"--method rsm --rsm-size 0", "--rsm-size"},
        BadUse{"--method rsm --rsm-size 100000", "--rsm-size"},
        BadUse{"--method rsm --rsm-texels 1000000000", "--rsm-texels"},
        BadUse{"--method rsm --sub-images 4 --sub-maps 3", "--sub-maps 3"},
        BadUse{"--method rsm --probes 4x4x4", "--probes"},
        BadUse{"--method rsm --bounces 2", "--bounces"},
        BadUse{"--method rsm+field --gather 4", "--gather"},
        BadUse{"--method rsm+field --rsm-from-camera", "--rsm-from-camera"},
        BadUse{"--method rsm --rsm-pattern square", "--rsm-pattern"},
        BadUse{"--method rsm --rsm-radius 0.5", "--rsm-radius"},
        BadUse{"--method rsm --rsm-pattern disk --rsm-texels 0", "--rsm-texels"},
        BadUse{"--method field --rsm-direct", "--rsm-direct"},
        BadUse{"--method direct --rsm-direct", "--rsm-direct"},
        BadUse{"--method rsm --rsm-direct --rsm-from-camera", "--rsm-direct"},
        BadUse{"--method rsm --rsm-direct-lights 4", "--rsm-direct-lights"},
        BadUse{"--method rsm --rsm-direct --rsm-direct-lights -1", "--rsm-direct-lights"},
        BadUse{"--method rsm --rsm-direct --rsm-direct-lights 65537", "--rsm-direct-lights"},
        BadUse{"--method field --rsm-merge-maps", "--rsm-merge-maps"},
        BadUse{"--method rsm --rsm-merge-maps --rsm-texels 0", "--rsm-merge-maps"},
        BadUse{"--method rsm --rsm-merge-maps --rsm-pattern disk", "--rsm-merge-maps"}}) {
    const ProgramResult result = render(std::string("cornell-spot --size 8x8 ") + use.arguments);
    EXPECT_EQ(result.status, 2) << use.arguments;
    EXPECT_THAT(result.errors, HasSubstr(use.named)) << use.arguments;
  }
  EXPECT_EQ(directory.entries(), 0u);
}

}  // namespace
}  // namespace lambent::render_rsm_test
