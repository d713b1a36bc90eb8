// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "support/program.h"
#include "support/temporary_directory.h"

namespace lambent::make_scene_test {
namespace {

using test::ProgramResult;
using test::run_program;
using testing::HasSubstr;

class MakeScene : public testing::Test {
 protected:
  std::string file(const char* name) const { return folder.file(name); }
  std::size_t files() const { return folder.entries(); }

  lambent::test::TemporaryDirectory folder;
};

TEST_F(MakeScene, WritesOneFileAndSaysWhatIsInIt) {
  const ProgramResult outcome = run_program("make-scene cornell -o " + file("a.glb"));
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_THAT(outcome.errors, HasSubstr("a.glb: 38 triangles, "));
  EXPECT_EQ(outcome.output, "");
  EXPECT_EQ(files(), 1u);
}

TEST_F(MakeScene, SealsTheTwoRooms) {
  const ProgramResult open = run_program("make-scene two-rooms -o " + file("a.glb"));
  const ProgramResult sealed = run_program("make-scene two-rooms --sealed -o " + file("b.glb"));
  EXPECT_THAT(open.errors, HasSubstr("144 triangles"));
  EXPECT_THAT(sealed.errors, HasSubstr("120 triangles"));
}

TEST_F(MakeScene, RejectsAnUnknownNameAndListsTheKnownOnes) {
  const ProgramResult outcome = run_program("make-scene nowhere -o " + file("a.glb"));
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.errors, HasSubstr("nowhere"));
  EXPECT_THAT(outcome.errors, HasSubstr("cornell"));
  EXPECT_THAT(outcome.errors, HasSubstr("two-rooms"));
  EXPECT_EQ(files(), 0u);
}

TEST_F(MakeScene, RejectsSealedWhereThereIsNothingToSeal) {
  const ProgramResult outcome = run_program("make-scene cornell --sealed -o " + file("a.glb"));
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.errors, HasSubstr("--sealed"));
}

TEST_F(MakeScene, LeavesNothingBehindWhereItCannotWrite) {
  std::filesystem::create_directories(file("taken.glb"));
  const ProgramResult outcome = run_program("make-scene cornell -o " + file("taken.glb"));
  EXPECT_NE(outcome.status, 0);
  EXPECT_THAT(outcome.errors, HasSubstr("taken.glb"));
  EXPECT_EQ(files(), 1u);
}

TEST_F(MakeScene, RequiresAnOutputThatIsNamedAsWhatItIs) {
  EXPECT_EQ(run_program("make-scene cornell").status, 2);
  const ProgramResult outcome = run_program("make-scene cornell -o " + file("a.gltf"));
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.errors, HasSubstr("must end in .glb"));
  EXPECT_EQ(files(), 0u);
}

}  // namespace
}  // namespace lambent::make_scene_test
