// SPDX-License-Identifier: Apache-2.0
#include "core/files/atomic_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <thread>

#include "core/files/file_bytes.h"
#include "support/temporary_directory.h"

namespace lambent::atomic_file_test {
namespace {

namespace fs = std::filesystem;

std::string text_of(const std::string& path) {
  const auto bytes = read_file(path);
  if (!bytes) return "(" + bytes.error().message() + ")";
  return {reinterpret_cast<const char*>(bytes->data()), bytes->size()};
}

TEST(AtomicFile, ReplacesTheFileAndLeavesNothingElse) {
  const test::TemporaryDirectory directory;
  ASSERT_TRUE(write_file_atomically(directory.file("a.txt"), "first"));
  ASSERT_TRUE(write_file_atomically(directory.file("a.txt"), "second"));
  EXPECT_EQ(text_of(directory.file("a.txt")), "second");
  EXPECT_EQ(directory.entries(), 1u);
}

TEST(AtomicFile, MissingDirectoryIsAFailureThatNamesThePath) {
  const test::TemporaryDirectory directory;
  const std::string path = directory.file("missing/a.txt");
  const auto written = write_file_atomically(path, "text");
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().kind, Error::Kind::failed);
  EXPECT_EQ(written.error().file, path);
  EXPECT_NE(written.error().cause.find("No such file or directory"), std::string::npos);
  EXPECT_EQ(directory.entries(), 0u);
}

TEST(AtomicFile, RefusesADirectoryAndLeavesItAlone) {
  const test::TemporaryDirectory directory;
  fs::create_directory(directory.path() / "d");
  const auto written = write_file_atomically(directory.file("d"), "text");
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().kind, Error::Kind::bad_input);
  EXPECT_EQ(directory.entries(), 1u);
}

TEST(AtomicFile, WritesThroughASymbolicLink) {
  const test::TemporaryDirectory directory;
  ASSERT_TRUE(write_file_atomically(directory.file("target"), "old"));
  fs::create_symlink("target", directory.path() / "link");
  ASSERT_TRUE(write_file_atomically(directory.file("link"), "new"));
  EXPECT_TRUE(fs::is_symlink(directory.path() / "link"));
  EXPECT_EQ(text_of(directory.file("target")), "new");
}

TEST(AtomicFile, MakesTheFileThatADanglingLinkLeadsTo) {
  const test::TemporaryDirectory directory;
  fs::create_directory(directory.path() / "inner");
  fs::create_symlink("inner/later", directory.path() / "link");
  ASSERT_TRUE(write_file_atomically(directory.file("link"), "new"));
  EXPECT_TRUE(fs::is_symlink(directory.path() / "link"));
  EXPECT_EQ(text_of(directory.file("inner/later")), "new");
}

TEST(AtomicFile, KeepsTheRightsOfTheFileThatItReplaces) {
  const test::TemporaryDirectory directory;
  ASSERT_TRUE(write_file_atomically(directory.file("a"), "secret"));
  fs::permissions(directory.file("a"), fs::perms::owner_read | fs::perms::owner_write);
  ASSERT_TRUE(write_file_atomically(directory.file("a"), "another"));
  EXPECT_EQ(fs::status(directory.file("a")).permissions(),
            fs::perms::owner_read | fs::perms::owner_write);
}

std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

class UnfinishedFile : public ::testing::TestWithParam<AtomicFile::Unfinished> {
 protected:
  test::TemporaryDirectory directory;
};

TEST_P(UnfinishedFile, LeavesWhatWasThere) {
  ASSERT_TRUE(write_file_atomically(directory.file("a"), "old"));
  {
    auto file = AtomicFile::open(directory.file("a"), GetParam());
    ASSERT_TRUE(file);
    ASSERT_TRUE(file->write(bytes_of("new")));
    EXPECT_EQ(text_of(directory.file("a")), "old");
  }
  EXPECT_EQ(text_of(directory.file("a")), "old");
  EXPECT_EQ(directory.entries(), 1u);
}

TEST_P(UnfinishedFile, ComesToBeWhenItIsCommitted) {
  for (const char* text : {"first", "second"}) {
    auto file = AtomicFile::open(directory.file("a"), GetParam());
    ASSERT_TRUE(file);
    ASSERT_TRUE(file->write(bytes_of("-----")));
    ASSERT_TRUE(file->seek(0));
    ASSERT_TRUE(file->write(bytes_of(text)));
    ASSERT_TRUE(file->commit());
    EXPECT_EQ(text_of(directory.file("a")), text);
    EXPECT_EQ(directory.entries(), 1u);
  }
}

TEST_P(UnfinishedFile, IsDiscardedByADyingProgram) {
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    auto file = AtomicFile::open(directory.file("a"), GetParam());
    const bool begun = file && file->write(bytes_of("text"));
    discard_unfinished_files();
    _exit(begun ? 0 : 1);
  }
  int status = -1;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(directory.entries(), 0u);
}

INSTANTIATE_TEST_SUITE_P(How, UnfinishedFile,
                         ::testing::Values(AtomicFile::Unfinished::nameless_if_possible,
                                           AtomicFile::Unfinished::named),
                         [](const auto& tested) {
                           return tested.param == AtomicFile::Unfinished::named ? "Named"
                                                                                : "Nameless";
                         });

TEST(AtomicFile, SendsItsContentThroughAPipe) {
  const test::TemporaryDirectory directory;
  const std::string pipe = directory.file("pipe");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  std::string received;
  std::thread reader([&] {
    std::ifstream file(pipe);
    received.assign(std::istreambuf_iterator<char>(file), {});
  });
  const auto written = write_file_atomically(pipe, "through");
  reader.join();
  ASSERT_TRUE(written) << written.error().message();
  EXPECT_EQ(received, "through");
  EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST(AtomicFile, AppendsToAnOpenDescriptor) {
  // As /dev/stdout is one where a shell appends it to a file
  const test::TemporaryDirectory directory;
  const int open_file = ::open(directory.file("log").c_str(), O_WRONLY | O_CREAT, 0600);
  ASSERT_GE(open_file, 0);
  ASSERT_EQ(::write(open_file, "before ", 7), 7);
  ASSERT_TRUE(write_file_atomically("/dev/fd/" + std::to_string(open_file), "after"));
  ::close(open_file);
  EXPECT_EQ(text_of(directory.file("log")), "before after");
  EXPECT_EQ(directory.entries(), 1u);
}

TEST(AtomicFile, TellsBeforehandWhatCouldNotBeWritten) {
  const test::TemporaryDirectory directory;
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
  const test::TemporaryDirectory directory;
  EXPECT_EQ(read_file("").error().cause, "the name of the file to read is empty");
  EXPECT_EQ(read_file(directory.file("none")).error().cause, "no such file");
  EXPECT_EQ(read_file(directory.path().string()).error().cause, "is a directory, not a file");
  ASSERT_TRUE(write_file_atomically(directory.file("a"), "four"));
  EXPECT_TRUE(read_file(directory.file("a"), 4));
  EXPECT_FALSE(read_file(directory.file("a"), 3));
}

}  // namespace
}  // namespace lambent::atomic_file_test
