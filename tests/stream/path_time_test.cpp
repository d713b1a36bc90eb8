// SPDX-License-Identifier: Apache-2.0
// What the system tells of the time that bytes are on their way.
#include "stream/pace/path_time.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <thread>

namespace lambent::stream::path_time_test {
namespace {

/// Both ends of a TCP connection on loopback.
class PathOfAConnection : public ::testing::Test {
 protected:
  void SetUp() override {
    listener = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    ASSERT_EQ(::bind(listener, reinterpret_cast<sockaddr*>(&address), size), 0);
    ASSERT_EQ(::listen(listener, 1), 0);
    ASSERT_EQ(::getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size), 0);
    reader = ::socket(AF_INET, SOCK_STREAM, 0);
    ASSERT_EQ(::connect(reader, reinterpret_cast<sockaddr*>(&address), size), 0);
    writer = ::accept4(listener, nullptr, nullptr, SOCK_NONBLOCK);
    ASSERT_GE(writer, 0);
    if (!path_time_of(writer)) GTEST_SKIP() << "this system does not count it";
  }
  void TearDown() override {
    for (const int one : {writer, reader, listener}) {
      if (one >= 0) ::close(one);
    }
  }

  /// Waits until it no longer grows; whether that comes.
  [[nodiscard]] bool stands_still() const {
    constexpr int kLooks = 200;
    PathTime last = *path_time_of(writer);
    for (int i = 0; i < kLooks; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(60));
      const PathTime now = *path_time_of(writer);
      if (now == last) return true;
      last = now;
    }
    return false;
  }

  int listener = -1, reader = -1, writer = -1;
};

TEST_F(PathOfAConnection, CountsWhatTravelsAndNotWhatNobodyHasReadYet) {
  std::array<char, 10'000> bytes{};
  constexpr int kMostWrites = 10'000'000;
  for (int i = 0; *path_time_of(writer) == PathTime(0) && i < kMostWrites; ++i) {
    static_cast<void>(!::write(writer, bytes.data(), bytes.size()));
    static_cast<void>(!::recv(reader, bytes.data(), bytes.size(), MSG_DONTWAIT));
  }
  EXPECT_GT(*path_time_of(writer), PathTime(0));
  EXPECT_TRUE(stands_still()) << "the other system has all of it, though its program sleeps";
}

TEST_F(PathOfAConnection, LeavesOutTheTimeOfAReaderWhoHasNoRoomLeft) {
  constexpr std::array<char, 10'000> kBytes{};
  while (::write(writer, kBytes.data(), kBytes.size()) > 0) {
  }
  EXPECT_TRUE(stands_still());
}

TEST(PathTime, IsNotKnownOfWhatIsNoConnection) {
  EXPECT_FALSE(path_time_of(-1));
}

}  // namespace
}  // namespace lambent::stream::path_time_test
