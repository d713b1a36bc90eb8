// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <string>

namespace {

using testing::HasSubstr;

struct Outcome {
  int status = -1;
  std::string text;  // stdout and stderr
};

Outcome run_program(const std::string& arguments) {
  Outcome outcome;
  FILE* pipe = popen((LAMBENT_PROGRAM " " + arguments + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return outcome;
  std::array<char, 256> buffer;
  while (std::fgets(buffer.data(), buffer.size(), pipe) != nullptr) outcome.text += buffer.data();
  outcome.status = WEXITSTATUS(pclose(pipe));
  return outcome;
}

class MakeScene : public testing::Test {
 protected:
  MakeScene() {
    folder_ = std::filesystem::path(testing::TempDir()) /
              testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::create_directories(folder_);
  }
  ~MakeScene() override { std::filesystem::remove_all(folder_); }

  std::string file(const char* name) const { return (folder_ / name).string(); }
  std::size_t files() const {
    return std::distance(std::filesystem::directory_iterator(folder_), {});
  }

  std::filesystem::path folder_;
};

TEST_F(MakeScene, WritesOneFileAndSaysWhatIsInIt) {
  const Outcome outcome = run_program("make-scene cornell -o " + file("a.glb"));
  EXPECT_EQ(outcome.status, 0) << outcome.text;
  EXPECT_THAT(outcome.text, HasSubstr("38 triangles"));
  EXPECT_THAT(outcome.text,
              HasSubstr(std::to_string(std::filesystem::file_size(file("a.glb"))) + " bytes"));
  EXPECT_EQ(files(), 1u);
}

TEST_F(MakeScene, SealsTheTwoRooms) {
  const Outcome open = run_program("make-scene two-rooms -o " + file("a.glb"));
  const Outcome sealed = run_program("make-scene two-rooms --sealed -o " + file("b.glb"));
  EXPECT_THAT(open.text, HasSubstr("144 triangles"));
  EXPECT_THAT(sealed.text, HasSubstr("120 triangles"));
}

TEST_F(MakeScene, RejectsAnUnknownNameAndListsTheKnownOnes) {
  const Outcome outcome = run_program("make-scene nowhere -o " + file("a.glb"));
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.text, HasSubstr("nowhere"));
  EXPECT_THAT(outcome.text, HasSubstr("cornell"));
  EXPECT_THAT(outcome.text, HasSubstr("two-rooms"));
  EXPECT_EQ(files(), 0u);
}

TEST_F(MakeScene, RejectsSealedWhereThereIsNothingToSeal) {
  const Outcome outcome = run_program("make-scene cornell --sealed -o " + file("a.glb"));
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.text, HasSubstr("--sealed"));
}

TEST_F(MakeScene, LeavesNothingBehindWhereItCannotWrite) {
  std::filesystem::create_directories(file("taken.glb"));
  const Outcome outcome = run_program("make-scene cornell -o " + file("taken.glb"));
  EXPECT_NE(outcome.status, 0);
  EXPECT_THAT(outcome.text, HasSubstr("taken.glb"));
  EXPECT_EQ(files(), 1u);
}

TEST_F(MakeScene, RequiresAnOutput) {
  EXPECT_EQ(run_program("make-scene cornell").status, 2);
}

}  // namespace
