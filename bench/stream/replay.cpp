// SPDX-License-Identifier: Apache-2.0
// lambent_stream_replay: replays a session of `lambent serve --record` to a server.
#include "stream/session/replay.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <fstream>
#include <string>

namespace lambent::stream_load {
namespace {

struct Options {
  std::string session, token_file;
  stream::ReplaySettings replay;
};

int run(Options& options) {
  if (!options.token_file.empty()) {
    std::ifstream file(options.token_file);
    if (!(file >> options.replay.token)) {
      std::fprintf(stderr, "%s: holds no token\n", options.token_file.c_str());
      return 1;
    }
  }
  const auto session = stream::read_session(options.session);
  if (!session) {
    std::fprintf(stderr, "%s\n", session.error().message().c_str());
    return 1;
  }
  const auto start = std::chrono::steady_clock::now();
  const auto played = stream::replay_session(*session, options.replay);
  if (!played) {
    std::fprintf(stderr, "%s\n", played.error().message().c_str());
    return 1;
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  std::printf(
      "| clients | messages | edits refused | pictures | updates of light | recorded, played [s] "
      "|\n"
      "|---|---|---|---|---|---|\n");
  const double recorded =
      session->empty() ? 0.0 : std::chrono::duration<double>(session->back().time).count();
  std::printf("| %llu | %llu | %llu | %llu | %llu | %.1f, %.1f |\n",
              static_cast<unsigned long long>(played->clients),
              static_cast<unsigned long long>(played->messages),
              static_cast<unsigned long long>(played->refused_inputs),
              static_cast<unsigned long long>(played->pictures),
              static_cast<unsigned long long>(played->updates), recorded, took.count());
  return 0;
}

}  // namespace
}  // namespace lambent::stream_load

int main(int argc, char** argv) try {
  lambent::stream_load::Options options;
  CLI::App app("Plays a session of lambent serve --record to a server");
  app.add_option("SESSION", options.session, "The file")->required();
  app.add_option("--host", options.replay.connect.host, "The server")->capture_default_str();
  app.add_option("--port", options.replay.connect.port, "Its port")->capture_default_str();
  app.add_flag("--tls", options.replay.connect.tls, "It has a certificate");
  app.add_option("--authority", options.replay.connect.authority, "Whom to trust, PEM");
  app.add_option("--token-file", options.token_file, "Holds the token of all clients");
  app.add_option("--speed", options.replay.speed, "So many times as fast as it was")
      ->check(CLI::Range(0.01, 100.0))
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  return lambent::stream_load::run(options);
} catch (const std::exception& failure) {
  std::fprintf(stderr, "lambent_stream_replay: %s\n", failure.what());
  return 1;
}
