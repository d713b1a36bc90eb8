// SPDX-License-Identifier: Apache-2.0
// lambent bake, lambent field, and what lambent render makes of field files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "lambent/image.h"
#include "support/program.h"
#include "support/temporary_directory.h"

namespace lambent::field_test {
namespace {

using test::ProgramResult;
using test::run_program;
using ::testing::HasSubstr;

const std::string kShape = " --probes 4x5x3 --rays 32 ";

class FieldFiles : public ::testing::Test {
 protected:
  std::string bytes_of(const std::string& path) const {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  /// A field of two updates of cornell.
  std::string baked() const {
    const ProgramResult result = run_program("bake cornell --updates 2 -o " + field + kShape);
    EXPECT_EQ(result.status, 0) << result.errors;
    return field;
  }

  test::TemporaryDirectory directory;
  std::string field = directory.file("a.field"), exr = directory.file("a.exr");
};

TEST_F(FieldFiles, BakeRunsUntilTheLightHasSettled) {
  const std::string stats = directory.file("stats.json");
  const ProgramResult result =
      run_program("bake cornell -o " + field + kShape + "--stats " + stats);
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(result.errors, HasSubstr("60 probes, "));
  EXPECT_THAT(result.errors, HasSubstr("; settled after "));
  EXPECT_EQ(result.output, "");
  const auto json = nlohmann::json::parse(bytes_of(stats));
  EXPECT_TRUE(json["settled"]);
  EXPECT_LT(json["field_change_last_update"], 0.002);
  EXPECT_GT(json["updates"], 2);
}

TEST_F(FieldFiles, BakeWritesTheSameFileOnAnyNumberOfThreads) {
  const std::string first = bytes_of(baked());
  EXPECT_EQ(run_program("bake cornell --updates 2 --threads 1 -o " + field + kShape).status, 0);
  EXPECT_EQ(bytes_of(field), first);
}

TEST_F(FieldFiles, BakeSaysWhatIsWrong) {
  for (const std::string& arguments :
       {std::string("bake cornell"), "bake none -o " + field,
        "bake cornell --updates 0 -o " + field, "bake cornell --time 1 -o " + field,
        "bake cornell --camera 0 -o " + field, "bake cornell --probes 1x1x1 -o " + field}) {
    const ProgramResult result = run_program(arguments);
    EXPECT_EQ(result.status, 2) << arguments;
    EXPECT_THAT(result.errors, HasSubstr("lambent: ")) << arguments;
  }
  EXPECT_FALSE(std::filesystem::exists(field));
}

TEST_F(FieldFiles, RenderStartsFromThem) {
  // Two updates baked are as good as two updates made on the way
  const std::string picture = " --size 32x18 --samples 1 --visibility moments ";
  ASSERT_EQ(run_program("render cornell --updates 2 -o " + exr + picture + kShape).status, 0);
  const std::string direct = bytes_of(exr);
  const ProgramResult result =
      run_program("render cornell --updates 0 --field " + baked() + " -o " + exr + picture);
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(result.errors, ::testing::Not(HasSubstr("warning")));
  EXPECT_EQ(bytes_of(exr), direct);

  const ProgramResult other =
      run_program("render cornell --sky 1,1,1 --field " + field + " -o " + exr + picture);
  EXPECT_EQ(other.status, 0);
  EXPECT_THAT(other.errors, HasSubstr("under other light"));
}

TEST_F(FieldFiles, RenderRefusesWhatDoesNotFit) {
  baked();
  const auto refusal = [&](const std::string& arguments) {
    const ProgramResult result =
        run_program("render " + arguments + " --size 32x18 -o " + directory.file("x.exr"));
    EXPECT_EQ(result.status, 2) << arguments;
    return result.errors;
  };
  EXPECT_THAT(refusal("two-rooms --field " + field), HasSubstr("is of another scene"));
  EXPECT_THAT(refusal("cornell --probes 3x3x3 --field " + field), HasSubstr("--probes: "));
  EXPECT_THAT(refusal("cornell --updates 0"), HasSubstr("--updates: "));
  EXPECT_THAT(refusal("cornell --method direct --field " + field), HasSubstr("--field: "));
  EXPECT_THAT(refusal("cornell --field " + directory.file("none")), HasSubstr("no such file"));
  std::filesystem::resize_file(field, std::filesystem::file_size(field) - 1);
  EXPECT_THAT(refusal("cornell --field " + field), HasSubstr("is cut short"));
  EXPECT_EQ(directory.entries(), 1u);
}

TEST_F(FieldFiles, InfoPrintsWhatTheyHold) {
  const ProgramResult text = run_program("field info " + baked());
  EXPECT_EQ(text.status, 0);
  for (const char* part : {"60: 4 x 5 x 3", "rgb9e5", "14 x 14 texels, rg16f", "updates      2"}) {
    EXPECT_THAT(text.output, HasSubstr(part));
  }
  const auto json = nlohmann::json::parse(run_program("field info --json " + field).output);
  EXPECT_EQ(json["version"], 3);
  EXPECT_EQ(json["updates"], 2);
  EXPECT_EQ(json["probe_counts"][0], (std::vector<int>{4, 5, 3}));
  EXPECT_EQ(json["mean_samples"][0], 2.0 * 32 / 32);
  EXPECT_GT(json["mean_irradiances"][0][0], 0.0);
  int probes = 0;
  for (const auto& [key, value] : json.items()) {
    if (key.rfind("probes_", 0) == 0 && key != "probes_relocated") probes += value[0].get<int>();
  }
  EXPECT_EQ(probes, 60);

  const ProgramResult none = run_program("field info " + directory.file("none"));
  EXPECT_EQ(none.status, 2);
  EXPECT_EQ(run_program("field").status, 2);
}

TEST_F(FieldFiles, ExportWritesBothAtlasesGuttersIncluded) {
  const std::string prefix = directory.file("atlas");
  ASSERT_EQ(run_program("field export " + baked() + " -o " + prefix).status, 0);
  const auto light = read_image(prefix + ".irradiance.exr");
  const auto distance = read_image(prefix + ".distance.exr");
  ASSERT_TRUE(light && distance);
  EXPECT_EQ(light->width, 4 * 6);
  EXPECT_EQ(light->height, 5 * 3 * 6);
  EXPECT_EQ(distance->width, 4 * 16);
  EXPECT_EQ(distance->height, 5 * 3 * 16);
  const Image &irradiance = light->layers[0].image, &mean = *distance->find("");
  const Image& square = *distance->find("mean_square");
  float brightest = 0.0f;
  for (int y = 0; y < light->height; y += 6) {
    for (int x = 0; x < light->width; x += 6) {
      // A corner of the gutter repeats the texel in the opposite corner
      EXPECT_EQ(irradiance.at(x, y)[1], irradiance.at(x + 4, y + 4)[1]);
      brightest = std::max(brightest, irradiance.at(x + 2, y + 2)[1]);
    }
  }
  EXPECT_GT(brightest, 0.0f);
  for (int y = 0; y < distance->height; ++y) {
    for (int x = 0; x < distance->width; ++x) {
      // Never less than the mean's square, but for the rounding of halves
      EXPECT_GE(*square.at(x, y) * 1.01f, *mean.at(x, y) * *mean.at(x, y));
    }
  }
  EXPECT_EQ(run_program("field export " + field + " -o /dev/null/a").status, 1);
}

TEST_F(FieldFiles, ProbesShowInPictures) {
  const std::string picture = " --updates 0 --size 64x48 --samples 1 --layers -o " + exr;
  for (const std::string aspect : {"irradiance", "distance", "state", "age"}) {
    const ProgramResult result =
        run_program("render cornell --show-probes " + aspect + " --field " + baked() + picture);
    ASSERT_EQ(result.status, 0) << result.errors;
    const auto image = read_image(exr);
    ASSERT_TRUE(image);
    const Image* probes = image->find("probes");
    ASSERT_NE(probes, nullptr);
    ASSERT_EQ(probes->channels, 4);
    float covered = 0.0f;
    for (int i = 0; i < 64 * 48; ++i) covered += probes->pixels[4 * i + 3];
    EXPECT_GT(covered, 20.0f) << aspect;
  }
  EXPECT_EQ(run_program("render cornell --show-probes colour" + picture).status, 2);
  EXPECT_EQ(run_program("render cornell --show-probes age --verify 2 -o " + exr).status, 2);
}

}  // namespace
}  // namespace lambent::field_test
