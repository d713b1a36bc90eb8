// SPDX-License-Identifier: Apache-2.0
// The pages that show pictures and light in a browser.
#pragma once

#include <span>
#include <string_view>

namespace lambent::stream {

struct PageFile {
  std::string_view path;  ///< As it is asked for, such as "/page.js".
  std::string_view type;  ///< As the header Content-Type has it.
  std::string_view bytes;
};

/// All files of the pages; the first one is "/". "/light" is there where LAMBENT_STREAM_WASM was
/// on.
std::span<const PageFile> page_files();

}  // namespace lambent::stream
