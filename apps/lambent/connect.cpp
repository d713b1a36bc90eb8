// SPDX-License-Identifier: Apache-2.0
// lambent connect: writes the pictures of a server, or pictures of a scene in its light.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lambent/command_files.h"
#include "lambent/commands.h"
#include "lambent/connect.h"
#include "lambent/console.h"
#include "lambent/fog_option.h"
#include "lambent/help.h"
#include "lambent/image.h"
#include "lambent/input.h"
#include "lambent/interrupts.h"
#include "lambent/output.h"
#include "lambent/parse.h"
#include "lambent/render_output.h"
#include "lambent/server_address.h"
#include "lambent/step.h"
#include "lambent/validators.h"
#include "lambent/words.h"
#include "stream/client/client.h"
#include "stream/edits/edits.h"
#include "stream/picture/h264.h"
#include "stream/textures/h265.h"

namespace lambent::cli {
namespace {

constexpr const char* kConnectExamples =
    "  lambent connect localhost -o picture.png\n"
    "  lambent connect localhost --scene scene.glb -o picture.png   render it here\n"
    "  lambent connect https://light.example.org:8443 --token-file token -o p.png --frames 30\n";

Expected<stream::ConnectSettings> parse_server(const ConnectOptions& options) {
  stream::ConnectSettings to = options.connect;
  const auto parsed = parse_server_address("HOST", options.server, to);
  if (!parsed) return tl::unexpected(parsed.error());
  constexpr double kMsOfSecond = 1000.0;
  to.timeout = std::chrono::milliseconds(static_cast<int>(options.timeout_s * kMsOfSecond));
  return to;
}

Expected<stream::Hello> make_hello(const ConnectOptions& options) {
  stream::Hello hello;
  const auto size = parse_size("--size", options.size);
  if (!size) return tl::unexpected(size.error());
  if (std::min(size->x, size->y) < static_cast<int>(stream::kMinPictureSide) ||
      std::max(size->x, size->y) > stream::kMaxEncodedLongSide) {
    return fail("--size", options.size, "pictures are streamed of 16x16 to 3840x2160 pixels");
  }
  hello.size = *size;
  hello.rate = options.rate;
  hello.wants = options.scene.file.empty() ? stream::kWantsPicture
                : options.codec == "h265"  ? stream::kWantsTextures
                                           : stream::kWantsLight;
  auto token = read_token(options.token_file);
  if (!token) return tl::unexpected(token.error());
  hello.token = std::move(*token);
  return hello;
}

/// The camera that replaces the server's, if any.
Expected<std::optional<stream::CameraInput>> make_camera(const ConnectOptions& options) {
  if (options.eye.empty() != options.target.empty()) {
    return fail(options.eye.empty() ? "--target" : "--eye", "", "--eye and --target go together");
  }
  if (options.eye.empty()) return std::nullopt;
  const auto eye = parse_place("--eye", options.eye);
  if (!eye) return tl::unexpected(eye.error());
  const auto target = parse_place("--target", options.target);
  if (!target) return tl::unexpected(target.error());
  stream::CameraInput camera =
      stream::input_of(look_at(*eye, *target, glm::radians(options.fov_degrees)));
  camera.input = kCameraInput;
  return camera;
}

/// Mean costs of pictures.
struct Costs {
  double render_ms = 0.0, encode_ms = 0.0, bytes = 0.0;
  int pictures = 0;

  void add(const stream::Picture& picture) {
    render_ms += static_cast<double>(picture.render_ms);
    encode_ms += static_cast<double>(picture.encode_ms);
    bytes += static_cast<double>(picture.bytes.size());
    ++pictures;
  }
  std::string text() const {
    std::array<char, 128> text;
    std::snprintf(text.data(), text.size(),
                  "each rendered in %.0f ms, encoded in %.1f ms, sent as %s", render_ms / pictures,
                  encode_ms / pictures, cli::bytes_text(bytes / pictures).c_str());
    return text.data();
  }
};

/// The next picture; none where there is an interrupt.
Expected<std::optional<stream::Picture>> next_picture(ServerSession& session,
                                                      const InterruptGuard& guard) {
  const auto end = std::chrono::steady_clock::now() + session.timeout();
  for (;;) {
    auto message = session.receive_until(end, guard);
    if (!message) return tl::unexpected(message.error());
    if (!*message) break;
    if (auto* picture = std::get_if<stream::Picture>(&**message)) return std::move(*picture);
  }
  if (guard.interrupted()) return std::nullopt;
  return fail("", "", "no picture came in time", Error::Kind::failed);
}

/// The pictures written so far.
struct ReceivedFrames {
  std::vector<std::string> written;
  Costs costs;
  glm::uvec2 size{0};
};

/// Writes pictures until there are enough, the connection is lost, or there is an interrupt.
Expected<void> receive_frames(const ConnectOptions& options,
                              const std::optional<stream::CameraInput>& camera,
                              const InterruptGuard& guard, ServerSession& session,
                              ReceivedFrames& frames) {
  auto decoder = stream::PictureDecoder::make();
  if (!decoder) return tl::unexpected(decoder.error());
  if (camera) {
    if (const auto sent = session.send(*camera); !sent) return sent;
  }
  const std::uint32_t first_input = camera ? kCameraInput : 0;
  while (static_cast<int>(frames.written.size()) < options.frames) {
    const auto next = next_picture(session, guard);
    if (!next) return tl::unexpected(next.error());
    if (!*next) return {};
    const stream::Picture& picture = **next;
    const auto decoded = decoder->decode(picture.bytes);
    if (!decoded) return tl::unexpected(decoded.error());
    const auto told = session.send(stream::Received{picture.number, 0.0f});
    if (!told) return told;
    if (picture.input < first_input) continue;  // from the camera before
    const std::string path = name_of_frame(options, frames.written.size());
    if (const auto done = write_png(path, stream::to_display(*decoded)); !done) return done;
    frames.written.push_back(path);
    frames.costs.add(picture);
    frames.size = picture.size;
    session.note_picture();
  }
  return {};
}

/// Writes the pictures of a server, over as many connections as it takes.
Expected<void> receive_pictures(const ConnectOptions& options,
                                const std::optional<stream::CameraInput>& camera,
                                const InterruptGuard& guard, ServerSession& session) {
  ReceivedFrames frames;
  const auto done = session.over_connections(
      guard, [&] { return receive_frames(options, camera, guard, session, frames); });
  if (!done) return done;
  if (frames.written.empty()) return {};
  tell_written(frames.written,
               pixels_text(static_cast<int>(frames.size.x), static_cast<int>(frames.size.y)),
               frames.costs.text());
  return {};
}

Expected<void> check_connect_output(const ConnectOptions& options) {
  if (options.scene.file.empty()) return check_output(options.output, {".png"});
  if (const auto fine = check_output(options.output, kFrameEndings); !fine) return fine;
  if (const auto can = check_layers(options.layers, options.output); !can) return can;
  const auto exposure = parse_exposure(options.exposure);
  if (!exposure) return tl::unexpected(exposure.error());
  return {};
}

Expected<void> connect(const ConnectOptions& options) {
  if (const auto fine = check_connect_output(options); !fine) return fine;
  CommandFiles files;
  files.reads(options.token_file, "--token-file");
  files.reads_scene(options.scene.file);
  files.reads(options.scene.light.environment, "--environment");
  files.reads(options.connect.authority, "--authority");
  if (options.frames == 1) {
    files.writes(options.output, "-o");
  } else {
    files.writes_frames(options.output, options.frames, "-o");
  }
  if (const auto fine = files.check(); !fine) return fine;
  if (!options.scene.file.empty()) {
    if (const auto fine = check_scene_input(options.scene.file); !fine) return fine;
  }
  if (options.interest > 0.0f && options.codec != "lambent") {
    return fail("--interest", "", "is not for light through H.265, which comes as a whole");
  }
  if (options.codec == "h265" && !stream::has_h265()) {
    return fail("--codec", options.codec, "is not in this build (LAMBENT_STREAM_H265)");
  }
  const auto settings = parse_server(options);
  if (!settings) return tl::unexpected(settings.error());
  const auto hello = make_hello(options);
  if (!hello) return tl::unexpected(hello.error());
  const auto camera = make_camera(options);
  if (!camera) return tl::unexpected(camera.error());

  std::unique_ptr<LocalScene> local;
  if (!options.scene.file.empty()) {
    auto opened = open_local_scene(options);
    if (!opened) return tl::unexpected(opened.error());
    local = std::move(*opened);
  }
  begin_step("connecting");
  auto session = ServerSession::join(*settings, *hello);
  if (!session) return tl::unexpected(session.error());
  if (const auto made = make_folders(options.output); !made) return made;
  const InterruptGuard guard;
  Expected<void> done;
  if (local == nullptr) {
    begin_step("receiving pictures");
    done = receive_pictures(options, *camera, guard, *session);
  } else {
    done = render_by_stream(options, local, *session, *camera, guard);
  }
  session->close();
  if (done) guard.end_if_interrupted();
  return done;
}

}  // namespace

std::string name_of_frame(const ConnectOptions& options, std::size_t frame) {
  if (options.frames == 1) return options.output;
  return frame_path(options.output, static_cast<int>(frame));
}

void add_connect(CLI::App& app, Run& run) {
  auto o = std::make_shared<ConnectOptions>();
  CLI::App* command = app.add_subcommand("connect", "Write what a server shows to files");
  command->group(kStreamGroup);
  command
      ->add_option("HOST", o->server,
                   "The server: a name or address, a port after a colon, https:// in front for TLS")
      ->required();
  command->option_defaults()->group(kMainGroup);
  command
      ->add_option("-o,--output", o->output,
                   "The .png file to write; with --scene also .jpg or .exr")
      ->required()
      ->check(file_name())
      ->type_name("FILE");
  command->add_option("--frames", o->frames, "Write so many pictures, numbered")
      ->check(whole_number(1, kMaxUpdates))
      ->capture_default_str()
      ->type_name("N");
  command->add_option("--size", o->size, "Pixels that are asked for; the server may send fewer")
      ->capture_default_str()
      ->type_name("WxH");
  command->add_option("--fps", o->rate, "Pictures a second that are asked for")
      ->check(number(stream::kMinPictureRate, stream::kMaxPictureRate))
      ->capture_default_str()
      ->type_name("F");
  command->add_option("--token-file", o->token_file, "File that holds the token for the server")
      ->type_name("FILE");
  command
      ->add_option("--authority", o->connect.authority,
                   "Whom to trust besides the system's authorities, PEM")
      ->type_name("FILE");
  command
      ->add_option("--timeout", o->timeout_s,
                   "Wait so long for each answer, and for a server that was lost [s]")
      ->check(number(0.1, 3600.0))
      ->capture_default_str()
      ->type_name("S");
  command->add_option("--eye", o->eye, "Look from here [m]; needs --target")->type_name("X,Y,Z");
  command->add_option("--target", o->target, "Look at this point [m]")->type_name("X,Y,Z");
  command->add_option("--fov", o->fov_degrees, "Vertical field of view [degrees], with --eye")
      ->check(number(1.0, 170.0))
      ->capture_default_str()
      ->type_name("DEG");
  command->option_defaults()->group("Pictures of one's own, from the server's light");
  command
      ->add_option("--scene", o->scene.file,
                   "Render this copy of the server's scene, in the light that the server sends")
      ->type_name("SCENE");
  command
      ->add_option("--quality", o->quality,
                   "Of these: draft, interactive (one ray a pixel) or high (some 64)")
      ->check(one_of({"draft", "interactive", "high"}))
      ->capture_default_str()
      ->type_name("Q");
  command
      ->add_option("--codec", o->codec, "Of the light: lambent, or h265 where both sides have it")
      ->check(one_of({"lambent", "h265"}))
      ->needs("--scene")
      ->type_name("C");
  command
      ->add_option(
          "--interest", o->interest,
          "Get light within this, and what is seen within twice, with each update, and the "
          "rest with every eighth [m]")
      ->check(number(0.0, kMaxTime))
      ->needs("--scene")
      ->type_name("M");
  command->add_option("--exposure", o->exposure, "In stops, or auto (the first picture decides)")
      ->needs("--scene")
      ->capture_default_str()
      ->type_name("E");
  command->add_option("--tone-map", o->tone_map, "aces, neutral or linear")
      ->check(one_of({"aces", "neutral", "linear"}))
      ->needs("--scene")
      ->capture_default_str()
      ->type_name("T");
  command->add_flag("--layers", o->layers, "Write every layer of the frame, .exr only")
      ->needs("--scene");
  command->option_defaults()->group("What is there, in which light: as the server has it");
  add_light_options(*command, o->scene.light);
  add_material_options(*command, o->scene);
  add_fog_option(*command, o->scene.fog);
  set_examples(*command, kConnectExamples);
  command->callback([o, &run] { run = [o] { return connect(*o); }; });
}

}  // namespace lambent::cli
