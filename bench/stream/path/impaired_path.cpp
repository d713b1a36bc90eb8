// SPDX-License-Identifier: Apache-2.0
#include "bench/stream/path/impaired_path.h"

#include <poll.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <deque>
#include <fstream>
#include <stdexcept>
#include <thread>
#include <vector>

namespace lambent::stream_path {
namespace {

using Clock = PathModel::Clock;

constexpr std::size_t kMaxPacketBytes = 65'536;

struct Travelling {
  Clock::time_point arrives;
  std::vector<char> bytes;
};

/// The path from one device to the other.
struct Direction {
  int from, to;
  PathModel model;
  std::deque<Travelling> travelling{};

  /// Reads the packets that were sent since the last call.
  void take(std::atomic<std::uint64_t>& sent, std::atomic<std::uint64_t>& lost) {
    std::array<char, kMaxPacketBytes> packet;
    for (;;) {
      const ssize_t size = ::read(from, packet.data(), packet.size());
      if (size <= 0) return;
      ++sent;
      const auto arrives = model.send(Clock::now(), static_cast<std::size_t>(size));
      if (arrives) {
        travelling.push_back({*arrives, {packet.data(), packet.data() + size}});
      } else {
        ++lost;
      }
    }
  }
  /// Writes the packets that are due.
  void deliver() {
    const Clock::time_point now = Clock::now();
    while (!travelling.empty() && travelling.front().arrives <= now) {
      const std::vector<char>& bytes = travelling.front().bytes;
      // Packets for which the system has no room are lost, as on real paths
      static_cast<void>(!::write(to, bytes.data(), bytes.size()));
      travelling.pop_front();
    }
  }
};

void set_congestion(const Network& network, const std::string& name) {
  bool done = false;
  std::thread([&] {
    network.enter();
    std::ofstream file("/proc/sys/net/ipv4/tcp_congestion_control");
    file << name << std::flush;
    done = file.good();
  }).join();
  if (!done) throw std::runtime_error("this system allows no congestion control " + name);
}

}  // namespace

struct ImpairedPath::State {
  Network near, far;
  int near_device = -1, far_device = -1;
  std::atomic<std::uint64_t> sent = 0, lost = 0;
  std::atomic<bool> ends = false;
  std::thread thread;

  ~State() {
    ends = true;
    if (thread.joinable()) thread.join();
    for (const int device : {near_device, far_device}) {
      if (device >= 0) ::close(device);
    }
  }

  void forward(const PathSettings& settings) {
    PathSettings back = settings;
    ++back.seed;
    std::array<Direction, 2> both = {{{near_device, far_device, PathModel(settings)},
                                      {far_device, near_device, PathModel(back)}}};
    while (!ends) {
      constexpr std::chrono::milliseconds kLook{50};
      Clock::time_point next = Clock::now() + kLook;
      for (Direction& one : both) {
        one.take(sent, lost);
        one.deliver();
        if (!one.travelling.empty()) next = std::min(next, one.travelling.front().arrives);
      }
      const auto wait = std::max(next - Clock::now(), Clock::duration(0));
      const timespec time = {0, std::chrono::duration_cast<std::chrono::nanoseconds>(wait).count()};
      std::array<pollfd, 2> files = {{{near_device, POLLIN, 0}, {far_device, POLLIN, 0}}};
      ::ppoll(files.data(), files.size(), &time, nullptr);
    }
  }
};

ImpairedPath::ImpairedPath(const PathSettings& settings, const std::string& congestion)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  if (!congestion.empty()) {
    set_congestion(s.near, congestion);
    set_congestion(s.far, congestion);
  }
  s.near_device = s.near.open_device(kNear);
  s.far_device = s.far.open_device(kFar);
  s.thread = std::thread([&s, settings] { s.forward(settings); });
}

ImpairedPath::~ImpairedPath() = default;

const Network& ImpairedPath::near() const {
  return state_->near;
}
const Network& ImpairedPath::far() const {
  return state_->far;
}

ImpairedPath::Counts ImpairedPath::counts() const {
  return {state_->sent, state_->lost};
}

}  // namespace lambent::stream_path
