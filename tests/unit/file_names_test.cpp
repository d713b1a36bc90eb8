// SPDX-License-Identifier: Apache-2.0
#include "core/files/file_names.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "support/temporary_directory.h"

namespace lambent::file_names_test {
namespace {

namespace fs = std::filesystem;

class FileNames : public ::testing::Test {
 protected:
  FileNames() {
    fs::create_directory(directory.path() / "folder");
    fs::create_directory_symlink("folder", directory.path() / "linked");
    std::ofstream(directory.file("folder/there")) << "text";
  }
  std::string file(const std::string& name) const { return directory.file(name); }

  test::TemporaryDirectory directory;
};

TEST_F(FileNames, KnowAFileByAnySpellingOfItsPath) {
  EXPECT_TRUE(same_file(file("folder/there"), file("folder/there")));
  EXPECT_TRUE(same_file(file("folder/there"), file("folder/.././folder//there")));
  EXPECT_TRUE(same_file(file("folder/new"), file("./folder/../folder/new")));
  EXPECT_FALSE(same_file(file("folder/there"), file("folder/new")));
  EXPECT_FALSE(same_file(file("folder/new"), file("new")));
}

TEST_F(FileNames, KnowAFileByLinksOfEitherKind) {
  fs::create_symlink("folder/there", directory.path() / "soft");
  fs::create_symlink("soft", directory.path() / "softer");
  fs::create_hard_link(directory.path() / "folder/there", directory.path() / "hard");
  EXPECT_TRUE(same_file(file("softer"), file("folder/there")));
  EXPECT_TRUE(same_file(file("hard"), file("folder/there")));
  EXPECT_TRUE(same_file(file("hard"), file("soft")));
}

TEST_F(FileNames, KnowAFileThatIsNotThereYet) {
  fs::create_symlink("linked/later", directory.path() / "dangling");
  EXPECT_TRUE(same_file(file("linked/later"), file("folder/later")));
  EXPECT_TRUE(same_file(file("dangling"), file("folder/later")));
  EXPECT_TRUE(same_file(file("linked/deep/later"), file("folder/deep/later")));
  EXPECT_FALSE(same_file(file("linked/later"), file("later")));
  EXPECT_FALSE(fs::exists(file("folder/later")));
}

TEST_F(FileNames, FollowTheCaseOfTheFileSystem) {
  std::ofstream(file("probe")) << "text";
  const bool case_counts = !fs::exists(file("PROBE"));
  EXPECT_EQ(same_file(file("new.png"), file("NEW.png")), !case_counts);
  EXPECT_FALSE(fs::exists(file("new.png")));
}

TEST_F(FileNames, OfDevicesAndLoopsAreNeverTheSame) {
  EXPECT_FALSE(same_file("/dev/null", "/dev/null"));
  fs::create_symlink("loop", directory.path() / "loop");
  EXPECT_FALSE(same_file(file("loop"), file("folder/there")));
}

TEST_F(FileNames, ThatClashAreToldWithWhatTheyAreFor) {
  const std::string there = file("folder/there"), linked = file("linked/there");
  const std::vector<NamedFile> over = {{linked, "-o", true}, {there, "the scene", false}};
  const auto written_over = check_distinct_files(over);
  ASSERT_FALSE(written_over);
  EXPECT_EQ(written_over.error().message(),
            linked + ": -o would write over the scene (" + there + ")");
  const std::vector<NamedFile> twice = {{"x", "-o", true}, {"x", "--stats", true}};
  const auto written_twice = check_distinct_files(twice);
  ASSERT_FALSE(written_twice);
  EXPECT_EQ(written_twice.error().message(), "x: both -o and --stats would write this file");
}

TEST_F(FileNames, MayBeReadTwiceOrEmpty) {
  const std::string there = file("folder/there");
  const std::vector<NamedFile> files = {{there, "A", false},       {there, "B", false},
                                        {"", "-o", true},          {"", "--stats", true},
                                        {"/dev/null", "-o", true}, {"/dev/null", "--stats", true}};
  EXPECT_TRUE(check_distinct_files(files));
}

}  // namespace
}  // namespace lambent::file_names_test
