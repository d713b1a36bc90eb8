// SPDX-License-Identifier: Apache-2.0
#include "core/atomic_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "core/file_bytes.h"
#include "support/temporary_directory.h"

namespace lambent {
namespace {

namespace fs = std::filesystem;

std::string text_of(const std::string& path) {
  const auto bytes = read_file(path);
  if (!bytes) return "(" + bytes.error().message() + ")";
  return {reinterpret_cast<const char*>(bytes->data()), bytes->size()};
}

TEST(AtomicFile, ReplacesTheFileAndLeavesNothingElse) {
  const testing::TemporaryDirectory directory;
  ASSERT_TRUE(write_file_atomically(directory.file("a.txt"), "first"));
  ASSERT_TRUE(write_file_atomically(directory.file("a.txt"), "second"));
  EXPECT_EQ(text_of(directory.file("a.txt")), "second");
  EXPECT_EQ(directory.entries(), 1u);
}

TEST(AtomicFile, MissingDirectoryIsBadInputThatNamesThePath) {
  const testing::TemporaryDirectory directory;
  const std::string path = directory.file("missing/a.txt");
  const auto written = write_file_atomically(path, "text");
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().kind, Error::Kind::bad_input);
  EXPECT_EQ(written.error().file, path);
  EXPECT_NE(written.error().cause.find("No such file or directory"), std::string::npos);
  EXPECT_EQ(directory.entries(), 0u);
}

TEST(AtomicFile, RefusesADirectoryAndLeavesItAlone) {
  const testing::TemporaryDirectory directory;
  fs::create_directory(directory.path() / "d");
  const auto written = write_file_atomically(directory.file("d"), "text");
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().kind, Error::Kind::bad_input);
  EXPECT_EQ(directory.entries(), 1u);
}

TEST(AtomicFile, WritesThroughASymbolicLink) {
  const testing::TemporaryDirectory directory;
  ASSERT_TRUE(write_file_atomically(directory.file("target"), "old"));
  fs::create_symlink("target", directory.path() / "link");
  ASSERT_TRUE(write_file_atomically(directory.file("link"), "new"));
  EXPECT_TRUE(fs::is_symlink(directory.path() / "link"));
  EXPECT_EQ(text_of(directory.file("target")), "new");
}

TEST(AtomicFile, TellsBeforehandWhatCouldNotBeWritten) {
  const testing::TemporaryDirectory directory;
  EXPECT_TRUE(check_writable(directory.file("new.txt")));
  EXPECT_TRUE(check_writable("/dev/null"));
  EXPECT_FALSE(check_writable(""));
  EXPECT_FALSE(check_writable(directory.path().string()));
  EXPECT_FALSE(check_writable(directory.file("missing/a.txt")));
  EXPECT_EQ(directory.entries(), 0u);
}

TEST(AtomicFile, FullDiskIsAFailureNotBadInput) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full on this system";
  const auto written = write_file_atomically("/dev/full", "text");
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().kind, Error::Kind::failed);
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST(ReadFile, RefusesWhatIsMissingTooLargeOrADirectory) {
  const testing::TemporaryDirectory directory;
  EXPECT_EQ(read_file("").error().cause, "the name of the file to read is empty");
  EXPECT_EQ(read_file(directory.file("none")).error().cause, "no such file");
  EXPECT_EQ(read_file(directory.path().string()).error().cause, "is a directory, not a file");
  ASSERT_TRUE(write_file_atomically(directory.file("a"), "four"));
  EXPECT_TRUE(read_file(directory.file("a"), 4));
  EXPECT_FALSE(read_file(directory.file("a"), 3));
}

}  // namespace
}  // namespace lambent
