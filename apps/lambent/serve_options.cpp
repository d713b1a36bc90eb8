// SPDX-License-Identifier: Apache-2.0
#include "lambent/serve_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "lambent/help.h"
#include "lambent/threads.h"
#include "lambent/validators.h"
#include "lambent/words.h"

namespace lambent::cli {
namespace {

constexpr int kMaxClients = 10'000;

/// Accepts origins as browsers send them: a scheme, a host and, unless it is the scheme's own, a
/// port, in small letters; or null, as pages of files have. Others would never match.
CLI::Validator origin() {
  const auto check = [](const std::string& text) -> std::string {
    const std::size_t end = text.find("://");
    const std::string host = end == std::string::npos ? "" : text.substr(end + 3);
    const bool has_scheme = end != std::string::npos && end > 0;
    const bool has_host = !host.empty() && host.find_first_of("/?#@ ") == std::string::npos;
    const bool is_small = std::ranges::none_of(text, [](char c) { return c >= 'A' && c <= 'Z'; });
    const bool has_own_port = (text.starts_with("http://") && text.ends_with(":80")) ||
                              (text.starts_with("https://") && text.ends_with(":443"));
    if (text == "null") return {};
    if (has_scheme && has_host && is_small && !has_own_port) return {};
    return "'" + text + "' is no origin that a browser sends, which is as https://example.org or " +
           "http://localhost:3000: in small letters, with neither a path nor a / at the end, and " +
           "without the port 80 of http and 443 of https";
  };
  return {check, ""};
}

void add_listen_options(CLI::App& command, ServeOptions& o) {
  stream::ListenSettings& listen = o.server.listen;
  command.add_option("--port", listen.port, "Port to listen at; 0: any that is free")
      ->check(whole_number(0, std::numeric_limits<std::uint16_t>::max()))
      ->capture_default_str()
      ->type_name("N");
  command
      .add_option("--host", listen.host,
                  "Address to listen at; those that other machines reach need --tokens")
      ->capture_default_str()
      ->type_name("A");
  command
      .add_option(
          "--tokens", listen.tokens,
          "File of who may look and who may change, a line each: view|change TOKEN [EXPIRY]")
      ->type_name("FILE");
  command.add_option("--certificate", listen.certificate, "TLS certificate chain, PEM")
      ->type_name("FILE");
  command.add_option("--key", listen.key, "Its private key, PEM")->type_name("FILE");
  command.option_defaults()->group("Clients");
  command
      .add_option("--publish", o.publish,
                  "Publish the light at this broker, too: nats://HOST[:PORT]/NAME")
      ->type_name("BROKER");
  command
      .add_option("--record", listen.record,
                  "Write what clients send to this file, which lambent_stream_replay plays again")
      ->type_name("FILE");
  command.add_flag("--share-scene", o.share_scene,
                   "Give the scene to who may look, so that browsers can render it (/light)");
  command
      .add_option("--light-error", o.server.world.light.target_error,
                  "Error that the light stream may have, of the mean irradiance")
      ->check(number(0.001, 0.2))
      ->capture_default_str()
      ->type_name("E");
  command.add_option("--clients", o.server.max_clients, "Clients at a time")
      ->check(whole_number(1, kMaxClients))
      ->capture_default_str()
      ->type_name("N");
  command
      .add_option(
          "--picture-clients", o.picture_clients,
          "Of these, clients of pictures, which take memory; 0: none (as many as --clients)")
      ->check(whole_number(0, kMaxClients))
      ->type_name("N");
  command
      .add_option("--origin", listen.origins,
                  "Pages from here may connect, too, as https://example.org; as often as wanted")
      ->check(origin())
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("O");
  command
      .add_option("--fps", o.server.world.pictures.limits.rate,
                  "Pictures a second that a client gets at most")
      ->check(number(stream::kMinPictureRate, stream::kMaxPictureRate))
      ->capture_default_str()
      ->type_name("F");
  command.add_option("--bitrate", o.max_megabits, "Of a client's pictures at most [Mbit/s]")
      ->check(number(0.1, 1000.0))
      ->capture_default_str()
      ->type_name("M");
  command
      .add_option("--encoder", o.encoder, "Of pictures: " + list_text(stream::picture_encoders()))
      ->check(one_of(stream::picture_encoders()))
      ->capture_default_str()
      ->type_name("E");
  command.add_option("--idle", o.idle_s, "End connections without a sign of life after [s]")
      ->check(number(1.0, 3600.0))
      ->capture_default_str()
      ->type_name("S");
}

void add_world_options(CLI::App& command, ServeOptions& o) {
  command.add_option("--rate", o.server.world.rate, "Updates of the light a second")
      ->check(number(0.1, 1000.0))
      ->capture_default_str()
      ->type_name("R");
  command.add_flag("--play", o.server.world.play, "Play the scene's animations");
  command
      .add_option("--quality", o.quality,
                  "Of pictures: draft, interactive (one ray a pixel) or high (some 64)")
      ->check(one_of({"draft", "interactive", "high"}))
      ->capture_default_str()
      ->type_name("Q");
  command
      .add_option("--size", o.size,
                  "Pixels of pictures at most; or a name: 480p, 720p, 1080p, 1440p, 4k")
      ->capture_default_str()
      ->type_name("WxH");
}

/// Adds --light-from. If the light comes from another server, options of the field, which are those
/// from `first_of_field` on, are refused.
void add_light_from(CLI::App& command, ServeOptions& o, std::size_t first_of_field) {
  std::vector<CLI::Option*> of_own_light = command.get_options();
  of_own_light.erase(of_own_light.begin(),
                     of_own_light.begin() + static_cast<std::ptrdiff_t>(first_of_field));
  for (const char* name : {"--rate", "--play", "--light-error"}) {
    of_own_light.push_back(command.get_option(name));
  }
  add_light_from_options(command, o.light_from, of_own_light);
  command.option_defaults()->group(kMainGroup);
}

}  // namespace

void add_serve_options(CLI::App& command, ServeOptions& o) {
  command.option_defaults()->group(kMainGroup);
  add_world_options(command, o);
  add_listen_options(command, o);
  add_scene_and_view_options(command, o.scene);
  const std::size_t before_field = command.get_options().size();
  add_field_options(command, o.field);
  command.add_option("--updates", o.updates, "Updates of the field before it is served")
      ->check(whole_number(1, kMaxUpdates))
      ->capture_default_str()
      ->type_name("N");
  add_light_from(command, o, before_field);
  command.add_option("--seed", o.seed, "Of all random numbers")
      ->check(whole_number(0, std::numeric_limits<std::uint32_t>::max()))
      ->capture_default_str()
      ->type_name("N");
  command.add_option("--threads", o.threads, "Threads to use (all)")
      ->check(whole_number(1, kMaxThreads))
      ->type_name("N");
  command.option_defaults()->group("Display");
  command.add_option("--exposure", o.exposure, "In stops, or auto")
      ->capture_default_str()
      ->type_name("E");
  command.add_option("--tone-map", o.tone_map, "aces, neutral or linear")
      ->check(one_of({"aces", "neutral", "linear"}))
      ->capture_default_str()
      ->type_name("T");
}

}  // namespace lambent::cli
