// SPDX-License-Identifier: Apache-2.0
// lambent_stream_load: the number of clients of light that a server can serve. Prints the tables of
// docs/serve.md. The server runs in a separate process, whose usage is measured.
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "bench/stream/light_clients.h"
#include "bench/stream/process_usage.h"

namespace lambent::stream_load {
namespace {

struct Options {
  Address address;
  std::vector<int> clients = {1, 100, 250, 500, 1000};
  int server = 0;  // the server's process
  int decode_every = 100;
  double seconds = 5.0;
  bool timeline = false;
};

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

/// Waits until all clients have light, or no more get it. Returns whether all have it.
bool wait_for_all(LightClients& clients, std::size_t count) {
  constexpr std::chrono::seconds kPatience{120};
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (clients.seen().joined < count && std::chrono::steady_clock::now() < end) {
    if (clients.seen().failed > 0) return false;
    clients.run_for(std::chrono::milliseconds(50));
  }
  return clients.seen().joined >= count;
}

void raise_descriptors() {
  rlimit limit{};
  getrlimit(RLIMIT_NOFILE, &limit);
  limit.rlim_cur = limit.rlim_max;
  setrlimit(RLIMIT_NOFILE, &limit);
}

int run(const Options& options) {
  raise_descriptors();
  const auto clients = LightClients::make(options.address, options.decode_every);
  std::printf(
      "| clients | updates/s | server [ms of a core an update] | server [MB] | missed | "
      "keys again | join: median, 95 %%, last [ms] |\n|---|---|---|---|---|---|---|\n");
  std::size_t count = 0;
  for (const int wanted : options.clients) {
    const std::size_t more = static_cast<std::size_t>(wanted) - count;
    clients->add(static_cast<int>(more));
    count = static_cast<std::size_t>(wanted);
    const std::size_t first_join = clients->seen().join_ms.size();
    if (!wait_for_all(*clients, count)) {
      std::fprintf(stderr, "%zu of %zu clients joined, %zu failed\n", clients->seen().joined, count,
                   clients->seen().failed);
      return 1;
    }
    const std::vector<double> joins(
        clients->seen().join_ms.begin() + static_cast<std::ptrdiff_t>(first_join),
        clients->seen().join_ms.end());
    clients->run_for(std::chrono::seconds(1));  // the last clients catch up
    const Seen before = clients->seen();
    const ProcessUsage from = usage_of(options.server);
    const auto start = std::chrono::steady_clock::now();
    clients->run_for(std::chrono::milliseconds(static_cast<int>(1e3 * options.seconds)));
    const double took_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const ProcessUsage to = usage_of(options.server);
    const Seen& after = clients->seen();
    const double each = static_cast<double>(after.updates - before.updates) / wanted;
    std::printf("| %d | %.2f | %.2f | %.0f | %llu | %llu | %.0f, %.0f, %.0f |\n", wanted,
                each / took_s, each > 0.0 ? 1e3 * (to.cpu_s - from.cpu_s) / each : 0.0, to.rss_mb,
                static_cast<unsigned long long>(after.missed),
                static_cast<unsigned long long>(after.keys - before.keys), percentile(joins, 0.5),
                percentile(joins, 0.95), percentile(joins, 1.0));
    std::fflush(stdout);
    if (after.failed + after.broken > 0) {
      std::fprintf(stderr, "%zu connections failed, %llu messages were refused\n", after.failed,
                   static_cast<unsigned long long>(after.broken));
      return 1;
    }
  }
  if (options.timeline) print_timeline(clients->seen());
  return 0;
}

}  // namespace
}  // namespace lambent::stream_load

int main(int argc, char** argv) try {
  lambent::stream_load::Options options;
  CLI::App app("Loads a server of light (lambent serve) with clients, and prints a table");
  app.add_option("--host", options.address.host, "Address of the server")->capture_default_str();
  app.add_option("--port", options.address.port, "Its port")->capture_default_str();
  app.add_flag("--tls", options.address.tls, "It has a certificate, which is not looked at");
  app.add_option("--server", options.server, "Its process, whose time is told")->required();
  app.add_option("--clients", options.clients, "Numbers of clients, growing")
      ->delimiter(',')
      ->check(CLI::Range(1, 10'000));
  app.add_option("--decode", options.decode_every, "One client in so many decodes; 0: none")
      ->capture_default_str();
  app.add_option("--seconds", options.seconds, "Measure each number for so long")
      ->check(CLI::Range(1.0, 3600.0))
      ->capture_default_str();
  app.add_flag("--timeline", options.timeline, "Tell what the first client got, and when");
  CLI11_PARSE(app, argc, argv);
  if (!std::is_sorted(options.clients.begin(), options.clients.end())) {
    std::fprintf(stderr, "numbers of clients must grow\n");
    return 2;
  }
  return lambent::stream_load::run(options);
} catch (const std::exception& failure) {
  std::fprintf(stderr, "lambent_stream_load: %s\n", failure.what());
  return 1;
}
