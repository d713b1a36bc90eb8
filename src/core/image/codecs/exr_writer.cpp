// SPDX-License-Identifier: Apache-2.0
// OpenEXR, written by scanlines.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfOutputFile.h>

#include <algorithm>
#include <cassert>
#include <exception>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/files/atomic_file.h"
#include "core/image/codecs/formats.h"
#include "core/image/codecs/row_writers.h"

namespace lambent {
namespace {

/// The stream through which OpenEXR writes to a file. OpenEXR's destructor swallows exceptions, so
/// this stores the first failure.
class FileOutput final : public Imf::OStream {
 public:
  explicit FileOutput(AtomicFile file)
      : Imf::OStream(file.path().c_str()), file_(std::move(file)) {}

  void write(const char c[], int n) override {
    const std::span<const char> bytes(c, static_cast<std::size_t>(n));
    check(file_.write(std::as_bytes(bytes)));
    position_ += bytes.size();
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override {
    check(file_.seek(position));
    position_ = position;
  }
  const std::optional<Error>& failure() const { return failure_; }
  AtomicFile& file() { return file_; }

 private:
  void check(const Expected<void>& done) {
    if (done) return;
    if (!failure_) failure_ = done.error();
    throw std::runtime_error(failure_->cause);
  }

  AtomicFile file_;
  std::uint64_t position_ = 0;
  std::optional<Error> failure_;
};

/// The names of a layer's channels as write_exr documents them.
std::vector<std::string> channel_names(const Layer& layer) {
  const std::string prefix = layer.name.empty() ? "" : layer.name + ".";
  switch (layer.image.channels) {
    case 1:
      return {prefix + "Y"};
    case 2:
      return {prefix + "U", prefix + "V"};
    case 3:
      return {prefix + "R", prefix + "G", prefix + "B"};
    case 4:
      return {prefix + "R", prefix + "G", prefix + "B", prefix + "A"};
    default:
      return {};
  }
}

Expected<Imf::Header> header_of(const std::string& path, const LayeredImage& image, int height) {
  Imf::Header header(std::max(image.width, 1), std::max(height, 1));
  header.compression() = Imf::ZIP_COMPRESSION;
  std::int64_t channels = 0;
  for (const Layer& layer : image.layers) {
    const std::string place = "layer \"" + layer.name + "\"";
    const std::vector<std::string> names = channel_names(layer);
    if (names.empty()) return fail(path, place, "an EXR layer has 1 to 4 channels");
    for (const std::string& name : names) {
      if (header.channels().findChannel(name) != nullptr) {
        return fail(path, place, "two layers share a name");
      }
      header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    }
    channels += layer.image.channels;
  }
  if (const auto ok = check_image_sides(path, image.width, height, channels); !ok) {
    return tl::unexpected(ok.error());
  }
  return header;
}

}  // namespace

struct ExrWriter::State {
  State(AtomicFile file, const Imf::Header& header, int image_height)
      : output(std::move(file)),
        exr(std::in_place, output, header, /*numThreads=*/0),
        height(image_height) {}

  /// The error of the file if it failed, otherwise `cause`.
  tl::unexpected<Error> failure(const char* cause) {
    if (output.failure()) return tl::unexpected<Error>(*output.failure());
    return fail(output.file().path(), "", std::string("cannot encode the EXR: ") + cause,
                Error::Kind::failed);
  }

  FileOutput output;
  std::optional<Imf::OutputFile> exr;
  int height;
  int next_row = 0;
};

ExrWriter::ExrWriter(std::unique_ptr<State> state) : state_(std::move(state)) {}
ExrWriter::ExrWriter(ExrWriter&&) noexcept = default;
ExrWriter::~ExrWriter() = default;

Expected<ExrWriter> ExrWriter::open(const std::string& path, const LayeredImage& like,
                                    int height) try {
  const Expected<Imf::Header> header = header_of(path, like, height);
  if (!header) return tl::unexpected(header.error());
  Expected<AtomicFile> file = AtomicFile::open(path);
  if (!file) return tl::unexpected(file.error());
  return ExrWriter(std::make_unique<State>(std::move(*file), *header, height));
} catch (const std::bad_alloc&) {
  throw;
} catch (const std::exception& error) {
  return fail(path, "", error.what(), Error::Kind::failed);
}

Expected<void> ExrWriter::write(const LayeredImage& rows) {
  State& s = *state_;
  Imf::FrameBuffer frame;
  for (const Layer& layer : rows.layers) {
    const std::vector<std::string> names = channel_names(layer);
    const std::size_t floats = static_cast<std::size_t>(rows.width) * rows.height * names.size();
    if (layer.image.width != rows.width || layer.image.height != rows.height ||
        layer.image.pixels.size() != floats) {
      return fail(s.output.file().path(), "layer \"" + layer.name + "\"", "layers differ in size");
    }
    const std::size_t pixel_bytes = sizeof(float) * names.size();
    for (std::size_t c = 0; c < names.size(); ++c) {
      // OpenEXR's slices are not const, though writing only reads them.
      char* base = reinterpret_cast<char*>(const_cast<float*>(layer.image.pixels.data() + c));
      frame.insert(names[c], Imf::Slice::Make(Imf::FLOAT, base, {0, s.next_row}, rows.width,
                                              rows.height, pixel_bytes, pixel_bytes * rows.width));
    }
  }
  assert(s.next_row + rows.height <= s.height);
  try {
    s.exr->setFrameBuffer(frame);
    s.exr->writePixels(rows.height);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    return s.failure(error.what());
  }
  s.next_row += rows.height;
  return {};
}

Expected<void> ExrWriter::finish() {
  State& s = *state_;
  assert(s.next_row == s.height);
  s.exr.reset();  // its destructor writes the table of scanline offsets
  if (s.output.failure()) return tl::unexpected(*s.output.failure());
  return s.output.file().commit();
}

Expected<void> write_exr(const std::string& path, const LayeredImage& image) {
  Expected<ExrWriter> file = ExrWriter::open(path, image, image.height);
  if (!file) return tl::unexpected(file.error());
  if (const auto written = file->write(image); !written) return written;
  return file->finish();
}

}  // namespace lambent
