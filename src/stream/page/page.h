// SPDX-License-Identifier: Apache-2.0
// The pages that show pictures and light in a browser.
#pragma once

#include <span>
#include <string_view>

namespace lambent::stream {

struct PageFile {
  std::string_view path;  ///< Path of requests, such as "/page.js".
  std::string_view type;  ///< Value of the header Content-Type.
  std::string_view bytes;
};

/// All files of the pages; the first one is "/". "/light" exists in builds with
/// LAMBENT_STREAM_WASM.
std::span<const PageFile> page_files();

}  // namespace lambent::stream
