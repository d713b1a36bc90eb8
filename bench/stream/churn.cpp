// SPDX-License-Identifier: Apache-2.0
// lambent_stream_churn: a server whose clients constantly connect and are killed, while some stay.
// Fails if clients that stay miss an update, or the server's use of resources grows.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "bench/stream/churn_clients.h"
#include "bench/stream/light_clients.h"
#include "bench/stream/process_usage.h"
#include "bench/stream/server_process.h"

namespace lambent::stream_load {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kStaying = 3;

struct Options {
  std::string program = "build/release/lambent", scene = "cornell-spot";
  std::uint16_t port = 18'090;
  double seconds = 1800.0;
  int at_once = 6;
  double most_growth_mb = 4.0;
  std::uint32_t seed = 1;
};

std::vector<std::string> command_of(const Options& options) {
  return {options.program,
          "serve",
          options.scene,
          "--port",
          std::to_string(options.port),
          "--size",
          "64x64",
          "--quality",
          "draft",
          "--clients",
          "24",
          "--idle",
          "5",
          "--probes",
          "8x8x8",
          "--rays",
          "64",
          "--picture-clients",
          "8"};
}

struct Sample {
  double rss_mb = 0.0;
  int descriptors = 0;
};

/// The median of the samples between two shares of the time.
Sample middle(const std::vector<Sample>& samples, double from, double to) {
  const auto at = [&](double share) {
    return samples.begin() +
           static_cast<std::ptrdiff_t>(share * static_cast<double>(samples.size()));
  };
  std::vector<double> rss, descriptors;
  for (auto one = at(from); one != at(to); ++one) {
    rss.push_back(one->rss_mb);
    descriptors.push_back(one->descriptors);
  }
  if (rss.empty()) throw std::runtime_error("there was not enough time to look");
  const auto half = static_cast<std::ptrdiff_t>(rss.size() / 2);
  std::nth_element(rss.begin(), rss.begin() + half, rss.end());
  std::nth_element(descriptors.begin(), descriptors.begin() + half, descriptors.end());
  return {rss[rss.size() / 2], static_cast<int>(descriptors[descriptors.size() / 2])};
}

/// Connects the clients that stay, and waits until all have light. Throws where the server does not
/// answer.
std::unique_ptr<LightClients> join_staying(const Options& options) {
  constexpr std::chrono::seconds kPatience{120};
  Address address;
  address.port = options.port;
  const auto end = Clock::now() + kPatience;
  while (Clock::now() < end) {
    auto staying = LightClients::make(address, 1);
    staying->add(kStaying);
    while (staying->seen().failed == 0 && Clock::now() < end) {
      staying->run_for(std::chrono::milliseconds(20));
      if (staying->seen().joined == kStaying) return staying;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
  throw std::runtime_error("the server does not answer");
}

void print_row(double seconds, const ChurnClients& churn, const Seen& seen, const Sample& sample) {
  const auto& came = churn.came();
  std::printf("| %.0f | %d | %d | %d | %d | %llu | %llu | %llu | %.1f | %d |\n", seconds,
              came[ChurnClients::light], came[ChurnClients::pictures],
              came[ChurnClients::mute] + came[ChurnClients::silent],
              came[ChurnClients::garbage] + came[ChurnClients::broken_messages],
              static_cast<unsigned long long>(seen.updates / kStaying),
              static_cast<unsigned long long>(seen.missed),
              static_cast<unsigned long long>(seen.keys), sample.rss_mb, sample.descriptors);
  std::fflush(stdout);
}

int run(const Options& options) {
  ServerProcess server(command_of(options));
  const auto staying = join_staying(options);
  stream::ConnectSettings address;
  address.host = "127.0.0.1";
  address.port = options.port;
  ChurnClients churn(address, options.seed);
  std::printf(
      "| after [s] | clients of light | of pictures | that say or read nothing | garbage | updates "
      "of those that stay | missed | keys | server [MB] | descriptors |\n"
      "|---|---|---|---|---|---|---|---|---|---|\n");
  std::vector<Sample> samples;
  const auto start = Clock::now();
  constexpr int kRows = 10;
  int row = 1;
  for (;;) {
    churn.step(static_cast<std::size_t>(options.at_once));
    staying->run_for(std::chrono::milliseconds(150));
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    const Sample now = {usage_of(server.process()).rss_mb, descriptors_of(server.process())};
    samples.push_back(now);
    if (seconds >= options.seconds * row / kRows) {
      print_row(seconds, churn, staying->seen(), now);
      ++row;
    }
    if (seconds >= options.seconds || staying->seen().failed > 0) break;
  }
  const Sample early = middle(samples, 0.2, 0.4), late = middle(samples, 0.8, 1.0);
  const Seen& seen = staying->seen();
  const double cpu_s = usage_of(server.process()).cpu_s;
  std::printf(
      "server: %.1f MB, then %.1f MB; %d, then %d descriptors (medians of the second and of "
      "the last fifth); %.0f s of a core; %d clients killed\n",
      early.rss_mb, late.rss_mb, early.descriptors, late.descriptors, cpu_s, churn.killed());
  std::vector<std::string> wrong;
  if (seen.failed > 0) wrong.emplace_back("a client that stays lost its connection");
  if (seen.missed + seen.broken > 0) wrong.emplace_back("updates were missed");
  if (late.rss_mb > early.rss_mb + options.most_growth_mb) wrong.emplace_back("the server grows");
  if (late.descriptors > early.descriptors + options.at_once) {
    wrong.emplace_back("the server keeps descriptors");
  }
  if (server.end() != 0) wrong.emplace_back("the server did not end well");
  for (const std::string& one : wrong) std::fprintf(stderr, "%s\n", one.c_str());
  return wrong.empty() ? 0 : 1;
}

}  // namespace
}  // namespace lambent::stream_load

int main(int argc, char** argv) try {
  lambent::stream_load::Options options;
  CLI::App app("Has clients of a server come and die, and fails where that does harm");
  app.add_option("--program", options.program, "The lambent program")->capture_default_str();
  app.add_option("--scene", options.scene, "What is served; it has a lamp")->capture_default_str();
  app.add_option("--port", options.port, "Of the server")->capture_default_str();
  app.add_option("--seconds", options.seconds, "For so long")
      ->check(CLI::Range(5.0, 1e6))
      ->capture_default_str();
  app.add_option("--at-once", options.at_once,
                 "Clients that live at a time, besides those that stay")
      ->check(CLI::Range(1, 16));
  app.add_option("--most-growth", options.most_growth_mb, "Of the server [MB]")
      ->capture_default_str();
  app.add_option("--seed", options.seed, "Of what clients do");
  CLI11_PARSE(app, argc, argv);
  return lambent::stream_load::run(options);
} catch (const std::exception& failure) {
  std::fprintf(stderr, "lambent_stream_churn: %s\n", failure.what());
  return 1;
}
