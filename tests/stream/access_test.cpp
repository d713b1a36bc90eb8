// SPDX-License-Identifier: Apache-2.0
// Who may look and who may change.
#include "stream/server/access.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "support/temporary_directory.h"

namespace lambent::stream::access_test {
namespace {

using ::testing::HasSubstr;

const std::string kLook = "looking-looking-looking", kEdit = "changing-changing-changing";
// 2026-12-31T23:59:59Z [s since 1970]
constexpr std::int64_t kEndOf2026 = 1798761599;

class AccessFile : public ::testing::Test {
 protected:
  void write(const std::string& text) const { std::ofstream(path) << text; }

  const test::TemporaryDirectory directory;
  const std::string path = directory.file("tokens");
};

TEST_F(AccessFile, TokensAllowWhatTheirLinesSay) {
  write("# who\n\nview " + kLook + "\n  change " + kEdit + "\t2026-12-31T23:59:59Z\r\n");
  const auto access = Access::open(path);
  ASSERT_TRUE(access) << access.error().message();
  ASSERT_TRUE(access->admit(kLook, 0));
  EXPECT_EQ(access->admit(kLook, 0)->role, Role::view);
  EXPECT_EQ(access->admit(kEdit, kEndOf2026 - 1)->role, Role::change);
  EXPECT_FALSE(access->admit(kEdit, kEndOf2026)) << "it has expired";
  for (const std::string& wrong :
       {std::string(), kLook + "x", kLook.substr(1), std::string("view")}) {
    EXPECT_FALSE(access->admit(wrong, 0)) << wrong;
  }
}

TEST_F(AccessFile, WhatExpiresOrIsTakenOutIsNoLongerGood) {
  write("view " + kLook + "\nchange " + kEdit + " 2026-12-31T23:59:59Z\n");
  auto access = Access::open(path);
  ASSERT_TRUE(access);
  const auto look = access->admit(kLook, 0), edit = access->admit(kEdit, 0);
  ASSERT_TRUE(look && edit);
  EXPECT_TRUE(access->still_good(*edit, kEndOf2026 - 1));
  EXPECT_FALSE(access->still_good(*edit, kEndOf2026));
  write("view " + kEdit + "\n# and nobody else\n");
  ASSERT_TRUE(access->refresh());
  EXPECT_FALSE(access->still_good(*look, 0)) << "it was revoked";
  EXPECT_FALSE(access->still_good(*edit, 0)) << "its role is another one";
  write("view nonsense\n");
  EXPECT_FALSE(access->refresh());
  EXPECT_FALSE(access->admit(kEdit, 0)) << "a broken file lets nobody in";
}

TEST_F(AccessFile, BrokenFilesAreRefusedWithTheLine) {
  const auto cause = [this](const std::string& text) {
    write(text);
    const auto access = Access::open(path);
    return access ? std::string("was read") : access.error().message();
  };
  EXPECT_THAT(cause("view short\n"), HasSubstr("line 1"));
  EXPECT_THAT(cause("# fine\nadmin " + kEdit + "\n"), HasSubstr("line 2"));
  EXPECT_THAT(cause("view " + kLook + " tomorrow\n"), HasSubstr("2026-12-31T23:59:59Z"));
  EXPECT_THAT(cause("view " + kLook + " 2026-12-31T23:59:59Z more\n"), HasSubstr("more than"));
  EXPECT_THAT(cause("# nobody\n"), HasSubstr("no token"));
  EXPECT_FALSE(Access::open(directory.file("missing")));
}

TEST(HostCheck, OnLoopbackOnlyThisMachinesNamesAreAnswered) {
  const HostCheck here(true, {});
  for (const char* host : {"localhost", "localhost:8080", "127.0.0.1:80", "[::1]:8080"}) {
    EXPECT_TRUE(here.may_be_asked_as(host)) << host;
  }
  for (const char* host : {"", "evil.example", "evil.example:8080", "localhost.evil.example",
                           "127.0.0.1.evil.example", "127.evil.example:8080", "[::2]:8080"}) {
    EXPECT_FALSE(here.may_be_asked_as(host)) << host;
  }
  EXPECT_TRUE(HostCheck(false, {}).may_be_asked_as("light.example.org"));
}

TEST(HostCheck, OnlyOurOwnPagesConnectAndThoseThatAreNamed) {
  const HostCheck check(true, {"https://friend.example"});
  EXPECT_TRUE(check.may_connect("", "localhost:8080", false)) << "no browser asks";
  EXPECT_TRUE(check.may_connect("http://localhost:8080", "localhost:8080", false));
  EXPECT_TRUE(check.may_connect("https://friend.example", "localhost:8080", false));
  for (const char* origin : {"http://evil.example", "null", "http://localhost:8081",
                             "https://localhost:8080", "https://friend.example.evil"}) {
    EXPECT_FALSE(check.may_connect(origin, "localhost:8080", false)) << origin;
  }
}

}  // namespace
}  // namespace lambent::stream::access_test
