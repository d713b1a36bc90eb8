// SPDX-License-Identifier: Apache-2.0
// OpenEXR: every layer of every part, float or half.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfVersion.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <exception>
#include <new>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "core/image/codecs/formats.h"

namespace lambent {
namespace {

/// No codec of OpenEXR compresses a picture by more than this factor; files that claim more are
/// refused before anything is allocated. (Deflate reaches 1032:1; DWA on top of it stores one
/// coefficient for 64 pixels of a flat picture first.)
constexpr std::uint64_t kMaxExrCompression = 1 << 16;

class MemoryInput final : public Imf::IStream {
 public:
  explicit MemoryInput(ByteView bytes) : Imf::IStream(""), bytes_(bytes) {}

  bool read(char c[], int n) override {
    const std::uint64_t count = static_cast<std::uint64_t>(std::max(n, 0));
    if (position_ > bytes_.size() || count > bytes_.size() - position_) {
      throw std::runtime_error("the file is truncated");
    }
    std::memcpy(c, bytes_.data() + position_, count);
    position_ += count;
    return position_ < bytes_.size();
  }
  std::uint64_t tellg() override { return position_; }
  void seekg(std::uint64_t position) override { position_ = position; }

 private:
  ByteView bytes_;
  std::uint64_t position_ = 0;
};

/// OpenEXR begins its messages with the name of the (here unnamed) file, which is in Error::file
/// already.
std::string exr_cause(const std::exception& error) {
  std::string cause = error.what();
  const std::size_t named = cause.find("file \"\". ");
  if (named != std::string::npos) cause.erase(0, named + std::string_view("file \"\". ").size());
  return "broken or unsupported EXR: " + cause;
}

/// Channels of one layer, in the order in which the image interleaves them.
struct ChannelGroup {
  std::string layer;
  std::vector<std::string> channels;
};

/// Channel letters of the same layer that form one image, in this order.
constexpr std::string_view kComponentSets[] = {"RGBA", "XYZW", "UV"};

/// Splits a name: "direct.R" is component 'R' of the layer "direct"; a channel without a one-letter
/// suffix has no component (0).
std::pair<std::string, char> split_channel_name(const std::string& name) {
  const std::size_t dot = name.rfind('.');
  const std::string end = dot == std::string::npos ? name : name.substr(dot + 1);
  if (end.size() != 1) return {name, '\0'};
  const char letter = static_cast<char>(std::toupper(static_cast<unsigned char>(end[0])));
  return {dot == std::string::npos ? "" : name.substr(0, dot), letter};
}

/// Removes from `left` the channels that form one image of `layer`, or a single channel.
ChannelGroup take_group(const std::string& layer, std::vector<std::string>& left) {
  const auto is_component = [](const std::string& name, char letter) {
    return split_channel_name(name).second == letter;
  };
  for (std::string_view set : kComponentSets) {
    ChannelGroup group{layer, {}};
    for (char letter : set) {
      const auto found = std::find_if(left.begin(), left.end(), [&](const std::string& name) {
        return is_component(name, letter);
      });
      if (found == left.end()) continue;
      group.channels.push_back(*found);
      left.erase(found);
    }
    if (!group.channels.empty()) return group;
  }
  ChannelGroup group{left.front(), {left.front()}};
  left.erase(left.begin());
  return group;
}

/// The layers of one part: the unnamed layer first, then by name, since EXR stores its channels
/// sorted.
std::vector<ChannelGroup> group_channels(const Imf::ChannelList& list) {
  std::vector<std::pair<std::string, std::vector<std::string>>> by_layer;
  for (auto channel = list.begin(); channel != list.end(); ++channel) {
    const std::string layer = split_channel_name(channel.name()).first;
    const auto same = [&](const auto& entry) { return entry.first == layer; };
    auto found = std::find_if(by_layer.begin(), by_layer.end(), same);
    if (found == by_layer.end()) found = by_layer.insert(by_layer.end(), {layer, {}});
    found->second.emplace_back(channel.name());
  }
  std::sort(by_layer.begin(), by_layer.end());

  std::vector<ChannelGroup> groups;
  for (auto& [layer, names] : by_layer) {
    groups.push_back(take_group(layer, names));
    // A channel that does not belong to the layer's colour or vector (such as a root "Z" beside
    // "R", "G", "B") becomes an image of its own.
    while (!names.empty()) {
      groups.push_back({names.front(), {names.front()}});
      names.erase(names.begin());
    }
  }
  return groups;
}

/// Adds the part's channels to `channels`.
Expected<void> check_part(const std::string& path, const std::string& place,
                          const Imf::Header& header, std::int64_t& channels) {
  if (header.hasType() && Imf::isDeepData(header.type())) {
    return fail(path, place, "deep images are not supported");
  }
  for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
    ++channels;
    if (c.channel().xSampling != 1 || c.channel().ySampling != 1) {
      return fail(path, place + "channel " + c.name(), "subsampled channels are not supported");
    }
  }
  return {};
}

void read_part(Imf::InputPart& part, const std::string& prefix, LayeredImage& result) {
  const Imath::Box2i window = part.header().dataWindow();
  Imf::FrameBuffer frame;
  std::vector<Layer> layers;
  for (const ChannelGroup& group : group_channels(part.header().channels())) {
    const bool nested = !prefix.empty() && !group.layer.empty();
    Layer layer{nested ? prefix + "." + group.layer : prefix + group.layer,
                Image(result.width, result.height, static_cast<int>(group.channels.size()))};
    const std::size_t pixel_bytes = sizeof(float) * group.channels.size();
    const std::size_t row_bytes = pixel_bytes * static_cast<std::size_t>(result.width);
    for (std::size_t c = 0; c < group.channels.size(); ++c) {
      char* base = reinterpret_cast<char*>(layer.image.pixels.data() + c);
      frame.insert(group.channels[c],
                   Imf::Slice::Make(Imf::FLOAT, base, window, pixel_bytes, row_bytes));
    }
    layers.push_back(
        std::move(layer));  // Moving keeps the vector's memory, and so the slice's pointer, valid.
  }
  part.setFrameBuffer(frame);
  part.readPixels(window.min.y, window.max.y);
  std::move(layers.begin(), layers.end(), std::back_inserter(result.layers));
}

}  // namespace

bool is_exr(ByteView bytes) {
  return bytes.size() >= 4 && Imf::isImfMagic(reinterpret_cast<const char*>(bytes.data()));
}

Expected<LayeredImage> decode_exr(const std::string& path, ByteView bytes) try {
  MemoryInput stream(bytes);
  Imf::MultiPartInputFile file(stream, /*numThreads=*/0, /*reconstructChunkOffsetTable=*/false);

  // Check every part against the limits before any of them is allocated.
  const Imath::Box2i window = file.header(0).dataWindow();
  const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
  const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
  std::int64_t channels = 0;
  for (int i = 0; i < file.parts(); ++i) {
    const Imf::Header& header = file.header(i);
    const std::string place = file.parts() > 1 ? "part " + std::to_string(i) + " " : "";
    if (const auto ok = check_part(path, place, header, channels); !ok)
      return tl::unexpected(ok.error());
    if (header.dataWindow() != window) return fail(path, place, "parts differ in size");
  }
  if (const auto ok = check_image_size(path, width, height, channels, kMaxExrFloats); !ok) {
    return tl::unexpected(ok.error());
  }

  const std::uint64_t decoded_bytes =
      static_cast<std::uint64_t>(width * height * channels) * sizeof(float);
  if (decoded_bytes / kMaxExrCompression > bytes.size()) {
    return fail(path, "",
                "broken EXR: " + std::to_string(bytes.size()) + " bytes cannot hold " +
                    std::to_string(decoded_bytes) + " bytes of pixels");
  }

  LayeredImage result{static_cast<int>(width), static_cast<int>(height), {}};
  for (int i = 0; i < file.parts(); ++i) {
    Imf::InputPart part(file, i);
    const Imf::Header& header = file.header(i);
    read_part(part, file.parts() > 1 && header.hasName() ? header.name() : "", result);
  }
  return result;
} catch (const std::bad_alloc&) {
  throw;
} catch (const std::exception& error) {
  return fail(path, "", exr_cause(error));
}

}  // namespace lambent
