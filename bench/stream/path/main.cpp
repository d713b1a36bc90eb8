// SPDX-License-Identifier: Apache-2.0
// lambent_stream_path: the age of light at clients, and the time that they take to join, over a
// path that delays and loses packets. Prints the tables of docs/serve.md.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "bench/stream/light_clients.h"
#include "bench/stream/path/impaired_path.h"
#include "bench/stream/server_process.h"

namespace lambent::stream_path {
namespace {

using stream_load::Address;
using stream_load::LightClients;
using Clock = std::chrono::steady_clock;
using Milliseconds = std::chrono::duration<double, std::milli>;

struct Options {
  std::string program = "build/release/lambent", scene = "atrium", congestion;
  bool play = true, timeline = false;
  double delay_ms = 40.0, loss_percent = 1.0, megabits = 0.0;
  int clients = 8, joins = 10;
  double seconds = 60.0;
};

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

struct Arrival {
  std::uint64_t update = 0;
  Clock::time_point at;
};

/// A folder with a token file, which servers require except on loopback.
class Token {
 public:
  Token() {
    std::string name = std::filesystem::temp_directory_path() / "lambent_path_XXXXXX";
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error(name + ": cannot be made");
    folder_ = name;
    std::ofstream(file()) << "change " << kText << "\n";
  }
  ~Token() { std::filesystem::remove_all(folder_); }
  Token(const Token&) = delete;
  Token& operator=(const Token&) = delete;

  static constexpr const char* kText = "measuring-measuring-measuring";
  std::string file() const { return folder_ + "/tokens"; }

 private:
  std::string folder_;
};

std::vector<std::string> command_of(const Options& options, const std::string& tokens) {
  std::vector<std::string> command = {
      options.program, "serve", options.scene, "--host", ImpairedPath::kNear, "--port", "8080",
      "--tokens",      tokens,  "--clients",   "64",     "--picture-clients", "0"};
  if (options.play) command.emplace_back("--play");
  return command;
}

Address address() {
  Address address;
  address.host = ImpairedPath::kNear;
  address.token = Token::kText;
  return address;
}

/// Connects clients, the first of which decodes, and waits until all have light. Throws if they do
/// not get it.
std::unique_ptr<LightClients> join(int count, const LightClients::OnLight& on_light) {
  constexpr std::chrono::seconds kPatience{120};
  const auto end = Clock::now() + kPatience;
  while (Clock::now() < end) {
    auto clients = LightClients::make(address(), count, on_light);
    clients->add(count);
    while (clients->seen().failed == 0 && Clock::now() < end) {
      clients->run_for(std::chrono::milliseconds(20));
      if (clients->seen().joined >= static_cast<std::size_t>(count)) return clients;
    }
    // Retry, since the server may not listen yet
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
  throw std::runtime_error("the server does not answer");
}

/// Measurements of distant clients.
struct Measured {
  std::vector<std::vector<Arrival>> arrivals;  // of each client
  Clock::time_point begin, end;
  std::uint64_t missed = 0, keys = 0;
  std::vector<double> join_ms;
  stream_load::Seen last_join;
};

Measured measure(const Options& options) {
  Measured measured;
  measured.arrivals.resize(static_cast<std::size_t>(options.clients));
  const auto clients = join(options.clients, [&](std::size_t client, std::uint64_t update) {
    measured.arrivals[client].push_back({update, Clock::now()});
  });
  clients->run_for(std::chrono::seconds(5));  // the last clients catch up
  const std::uint64_t keys = clients->seen().keys;
  measured.begin = Clock::now();
  clients->run_for(std::chrono::milliseconds(static_cast<int>(1e3 * options.seconds)));
  measured.end = Clock::now();
  measured.missed = clients->seen().missed;
  measured.keys = clients->seen().keys - keys;
  if (clients->seen().failed + clients->seen().broken > 0) {
    throw std::runtime_error("a connection ended, or light could not be decoded");
  }
  for (int i = 0; i < options.joins; ++i) {
    const auto late = join(1, nullptr);
    measured.join_ms.push_back(late->seen().join_ms.front());
    for (int slice = 0; slice < 5; ++slice) {  // clients that stay must answer meanwhile
      clients->run_for(std::chrono::milliseconds(50));
      late->run_for(std::chrono::milliseconds(50));
    }
    measured.last_join = late->seen();
  }
  return measured;
}

/// The age of each client's light [ms] at each millisecond of the measured time.
std::vector<double> ages_of(const Measured& measured,
                            const std::map<std::uint64_t, Clock::time_point>& made) {
  std::vector<double> ages;
  for (const std::vector<Arrival>& arrivals : measured.arrivals) {
    std::size_t next = 0;
    for (auto now = measured.begin; now < measured.end; now += std::chrono::milliseconds(1)) {
      while (next < arrivals.size() && arrivals[next].at <= now) ++next;
      if (next == 0) continue;
      const auto then = made.find(arrivals[next - 1].update);
      if (then != made.end()) ages.push_back(Milliseconds(now - then->second).count());
    }
  }
  return ages;
}

/// The age of the light of a client next to the server [ms] at each millisecond of the measured
/// time.
std::vector<double> ages_beside(const Measured& measured,
                                const std::map<std::uint64_t, Clock::time_point>& made) {
  Measured beside = measured;
  beside.arrivals.assign(1, {});
  for (const auto& [update, at] : made) beside.arrivals.front().push_back({update, at});
  return ages_of(beside, made);
}

/// Times from when light was available at the server until a client had it [ms].
std::vector<double> delays_of(const Measured& measured,
                              const std::map<std::uint64_t, Clock::time_point>& made) {
  std::vector<double> delays;
  for (const std::vector<Arrival>& arrivals : measured.arrivals) {
    for (const Arrival& one : arrivals) {
      const auto then = made.find(one.update);
      if (one.at < measured.begin || one.at > measured.end || then == made.end()) continue;
      delays.push_back(Milliseconds(one.at - then->second).count());
    }
  }
  return delays;
}

void print(const Options& options, const Measured& measured,
           const std::map<std::uint64_t, Clock::time_point>& made,
           const ImpairedPath::Counts& counts) {
  const std::vector<double> ages = ages_of(measured, made), delays = delays_of(measured, made),
                            beside = ages_beside(measured, made);
  std::printf(
      "| round trip [ms] | loss [%%] | Mbit/s | congestion control | packets lost | light's way: "
      "median, 95 %%, largest [ms] | age of the light that clients have: median, 95 %%, largest "
      "[ms] | beside the server: median, 95 %% [ms] | updates missed, keys again | late join: "
      "median, largest [ms] |\n"
      "|---|---|---|---|---|---|---|---|---|---|\n");
  std::printf(
      "| %.0f | %g | %s | %s | %llu of %llu | %.0f, %.0f, %.0f | %.0f, %.0f, %.0f | %.0f, %.0f | "
      "%llu, %llu | %.0f, %.0f |\n",
      2.0 * options.delay_ms, options.loss_percent,
      options.megabits > 0.0 ? std::to_string(static_cast<int>(options.megabits)).c_str() : "any",
      options.congestion.empty() ? "the system's" : options.congestion.c_str(),
      static_cast<unsigned long long>(counts.lost), static_cast<unsigned long long>(counts.sent),
      percentile(delays, 0.5), percentile(delays, 0.95), percentile(delays, 1.0),
      percentile(ages, 0.5), percentile(ages, 0.95), percentile(ages, 1.0), percentile(beside, 0.5),
      percentile(beside, 0.95), static_cast<unsigned long long>(measured.missed),
      static_cast<unsigned long long>(measured.keys), percentile(measured.join_ms, 0.5),
      percentile(measured.join_ms, 1.0));
}

int run(const Options& options) {
  PathSettings settings;
  settings.delay = std::chrono::microseconds(static_cast<int>(1e3 * options.delay_ms));
  settings.loss = 0.01 * options.loss_percent;
  settings.rate = 1e6 * options.megabits;
  ImpairedPath path(settings, options.congestion);
  const Token token;

  // Start the server, and a client next to it that records when light is available
  std::map<std::uint64_t, Clock::time_point> made;
  std::atomic<bool> ready = false, done = false;
  std::exception_ptr failure;
  std::thread near([&] {
    try {
      path.near().enter();
      const stream_load::ServerProcess server(command_of(options, token.file()));
      const auto reference = join(
          1, [&](std::size_t, std::uint64_t update) { made.try_emplace(update, Clock::now()); });
      ready = true;
      while (!done) reference->run_for(std::chrono::milliseconds(20));
    } catch (...) {
      failure = std::current_exception();
      ready = true;
    }
  });
  Measured measured;
  std::thread far([&] {
    try {
      while (!ready) std::this_thread::sleep_for(std::chrono::milliseconds(20));
      if (failure) return;
      path.far().enter();
      measured = measure(options);
    } catch (...) {
      failure = std::current_exception();
    }
    done = true;
  });
  far.join();
  near.join();
  if (failure) std::rethrow_exception(failure);
  print(options, measured, made, path.counts());
  if (options.timeline) print_timeline(measured.last_join);
  return 0;
}

}  // namespace
}  // namespace lambent::stream_path

int main(int argc, char** argv) try {
  lambent::stream_path::Options options;
  CLI::App app("Measures light that travels a long path (root alone may: network namespaces)");
  app.add_option("--program", options.program, "The lambent program")->capture_default_str();
  app.add_option("--scene", options.scene, "What is served")->capture_default_str();
  app.add_flag("--play,!--still", options.play, "Its animations are played");
  app.add_option("--delay", options.delay_ms, "One way [ms]")->check(CLI::Range(0.0, 1000.0));
  app.add_option("--loss", options.loss_percent, "Of packets, each way [%]")
      ->check(CLI::Range(0.0, 50.0));
  app.add_option("--megabits", options.megabits, "Each way; 0: any [Mbit/s]")
      ->check(CLI::Range(0.0, 10'000.0));
  app.add_option("--congestion", options.congestion,
                 "TCP's control, as reno or bbr (of those that this system allows)");
  app.add_option("--clients", options.clients, "That get light all the time")
      ->check(CLI::Range(1, 32));
  app.add_option("--joins", options.joins, "Clients that come late, one after the other")
      ->check(CLI::Range(0, 1000));
  app.add_option("--seconds", options.seconds, "Measure for so long")
      ->check(CLI::Range(1.0, 3600.0));
  app.add_flag("--timeline", options.timeline, "Tell what the last late client got, and when");
  CLI11_PARSE(app, argc, argv);
  return lambent::stream_path::run(options);
} catch (const std::exception& failure) {
  std::fprintf(stderr, "lambent_stream_path: %s\n", failure.what());
  return 1;
}
