// SPDX-License-Identifier: Apache-2.0
#include "bench/stream/churn_clients.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <system_error>

#include "stream/light/message.h"

namespace lambent::stream_load {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

// Range of factors on the intensity of the lamp that all clients change.
constexpr float kDimmest = 0.3f, kBrightest = 1.5f;

std::vector<std::byte> random_bytes(std::mt19937& random) {
  std::vector<std::byte> bytes(random() % 700);
  for (std::byte& byte : bytes) byte = static_cast<std::byte>(random() & 255u);
  return bytes;
}

void answer(stream::Client& client, const stream::Message& message) {
  if (const auto* picture = std::get_if<stream::Picture>(&message)) {
    static_cast<void>(client.send(stream::Received{picture->number, 0.0f}));
  } else if (const auto* light = std::get_if<stream::LightPayload>(&message)) {
    const auto opened = stream::open_message(light->bytes);
    if (!opened) return;
    static_cast<void>(
        client.send(stream::LightReceived{light->update, opened->header.geometry, 0}));
  }
}

/// A correct client that changes the lamp repeatedly.
void take_part(const stream::ConnectSettings& server, std::uint32_t wants, std::mt19937& random) {
  stream::Hello hello;
  hello.wants = wants;
  hello.size = {64, 64};
  auto joined = stream::join(server, hello);
  if (!joined || joined->welcome.lights.empty()) return;
  stream::Client& client = *joined->client;
  const glm::vec3 full = joined->welcome.lights.front().intensity;
  stream::LightInput lamp;
  lamp.edits = stream::kEditsIntensity;
  stream::CameraInput camera = joined->welcome.camera;
  Clock::time_point next;
  for (;;) {
    const auto message = client.receive(50ms);
    if (!message) return;
    if (*message) answer(client, **message);
    if (Clock::now() < next) continue;
    next = Clock::now() + 150ms;
    const float share = std::uniform_real_distribution<float>(kDimmest, kBrightest)(random);
    lamp.input = camera.input + 1;
    // Clamp the intensity, so that it neither vanishes nor grows without bound
    lamp.intensity = glm::clamp(share * full, glm::vec3(1.0f), glm::vec3(100.0f));
    camera.input = lamp.input + 1;
    if (!client.send(lamp) || !client.send(camera)) return;
  }
}

/// Repeatedly writes bytes that are not a request.
void write_garbage(const stream::ConnectSettings& server, std::mt19937& random) {
  const int file = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(server.port);
  inet_pton(AF_INET, server.host.c_str(), &address.sin_addr);
  if (::connect(file, reinterpret_cast<sockaddr*>(&address), sizeof(address)) != 0) return;
  for (;;) {
    const std::vector<std::byte> bytes = random_bytes(random);
    if (::send(file, bytes.data(), bytes.size(), MSG_NOSIGNAL) < 0) return;
    ::usleep(20'000);
  }
}

/// Sends a Hello, then invalid or truncated messages.
void break_messages(const stream::ConnectSettings& server, std::mt19937& random) {
  stream::Hello hello;
  hello.wants = stream::kWantsLight;
  for (;;) {
    auto joined = stream::join(server, hello);
    if (!joined) return;
    std::vector<std::byte> bytes = random_bytes(random);
    if (random() % 2 == 0) {
      bytes = stream::write_message(stream::LightInput{});
      bytes.resize(random() % bytes.size());
    }
    static_cast<void>(joined->client->send_bytes(bytes, random() % 4 != 0));
    while (joined->client->receive(200ms)) {
    }
    ::usleep(100'000);
  }
}

}  // namespace

void ChurnClients::live(Kind kind, std::uint32_t seed) const {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  std::mt19937 random(seed);
  switch (kind) {
    case light:
      take_part(server_, stream::kWantsLight, random);
      break;
    case pictures:
      take_part(server_, stream::kWantsPicture, random);
      break;
    case mute: {
      // Reads none of the data that it requested
      const auto joined = stream::join(server_, stream::Hello{});
      ::pause();
      break;
    }
    case silent: {
      const auto client = stream::Client::connect(server_);
      ::pause();
      break;
    }
    case garbage:
      write_garbage(server_, random);
      break;
    default:
      break_messages(server_, random);
  }
  ::pause();
  ::_exit(0);
}

void ChurnClients::step(std::size_t most) {
  const Clock::time_point now = Clock::now();
  std::erase_if(processes_, [&](const Process& process) {
    if (now < process.dies) return false;
    ::kill(process.id, SIGKILL);
    ::waitpid(process.id, nullptr, 0);
    ++killed_;
    return true;
  });
  if (processes_.size() >= most) return;
  const auto kind = static_cast<Kind>(random_() % kKinds);
  const auto life = std::chrono::milliseconds(20 + random_() % 1500);
  const std::uint32_t seed = random_();
  const pid_t child = ::fork();
  if (child < 0) throw std::system_error(errno, std::generic_category(), "fork");
  if (child == 0) {
    try {
      live(kind, seed);
    } catch (...) {
      ::_exit(1);
    }
  }
  ++came_[kind];
  processes_.push_back({child, now + life});
}

ChurnClients::~ChurnClients() {
  for (const Process& process : processes_) {
    ::kill(process.id, SIGKILL);
    ::waitpid(process.id, nullptr, 0);
  }
}

}  // namespace lambent::stream_load
