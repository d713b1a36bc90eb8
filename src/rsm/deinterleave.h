// SPDX-License-Identifier: Apache-2.0
// Based on: Segovia et al., "Non-interleaved Deferred Shading of Interleaved Sample Patterns",
// Graphics Hardware 2006; Gruen and Bavoil, US 9,129,443 B2, 2015. The place of a picture's pixel
// in m x m sub-images, of which (i, j) holds the pixels (x, y) with x mod m = i, y mod m = j.
#ifndef LAMBENT_RSM_DEINTERLEAVE_H
#define LAMBENT_RSM_DEINTERLEAVE_H

#include "shared/lang.h"

LAMBENT_BEGIN

/// The sub-image (i, j) of a pixel.
LAMBENT_FN ivec2 sub_image_of(ivec2 pixel, int sub_images) {
  return ivec2(pixel.x % sub_images, pixel.y % sub_images);
}

/// Place of a pixel in its sub-image.
LAMBENT_FN ivec2 place_in_sub_image(ivec2 pixel, int sub_images) {
  return ivec2(pixel.x / sub_images, pixel.y / sub_images);
}

/// The pixel at a place of a sub-image: the inverse of the two functions above.
LAMBENT_FN ivec2 pixel_of_sub_image(ivec2 sub_image, ivec2 place, int sub_images) {
  return ivec2(place.x * sub_images + sub_image.x, place.y * sub_images + sub_image.y);
}

/// Pixels along an axis of a sub-image, which is number `index` of the `sub_images` along that
/// axis; 0 where the picture is too small to have it.
LAMBENT_FN int sub_image_size(int size, int index, int sub_images) {
  return (size - index + sub_images - 1) / sub_images;
}

/// First pixel of a sub-image along an axis of the mosaic, in which all sub-images are side by
/// side, larger ones first.
LAMBENT_FN int sub_image_start(int size, int index, int sub_images) {
  int larger = size % sub_images;
  return index * (size / sub_images) + (index < larger ? index : larger);
}

/// Index of the sub-map, of n x n, that a sub-image gathers from.
LAMBENT_FN int sub_map_of(ivec2 sub_image, int sub_maps) {
  return (sub_image.y % sub_maps) * sub_maps + sub_image.x % sub_maps;
}

/// Index of a sub-map's first texel, where the map's sub-maps are stored one after the other;
/// `size`: texels along an edge of the map.
LAMBENT_FN int sub_map_start(int size, int sub_maps, int column, int row) {
  return sub_image_start(size, row, sub_maps) * size +
         sub_image_start(size, column, sub_maps) * sub_image_size(size, row, sub_maps);
}

/// Index of a map's texel in that order.
LAMBENT_FN int sub_map_texel(ivec2 texel, int size, int sub_maps) {
  ivec2 sub = sub_image_of(texel, sub_maps);
  ivec2 place = place_in_sub_image(texel, sub_maps);
  return sub_map_start(size, sub_maps, sub.x, sub.y) +
         place.y * sub_image_size(size, sub.x, sub_maps) + place.x;
}

// A mosaic on a device has one sub-image after the other, all with as many rows as the largest.
// Rows are rounded up to whole sectors of the cache.
const int kMosaicSector = 8;  // pixels of 4 bytes

LAMBENT_FN int mosaic_stride(int width, int sub_images) {
  int largest = sub_image_size(width, 0, sub_images);
  return (largest + kMosaicSector - 1) / kMosaicSector * kMosaicSector;
}

/// Index of a picture's pixel in the mosaic.
LAMBENT_FN int mosaic_index(ivec2 pixel, ivec2 size, int sub_images) {
  ivec2 sub = sub_image_of(pixel, sub_images);
  ivec2 place = place_in_sub_image(pixel, sub_images);
  int row = (sub.y * sub_images + sub.x) * sub_image_size(size.y, 0, sub_images) + place.y;
  return row * mosaic_stride(size.x, sub_images) + place.x;
}

/// Number of pixels in the mosaic, with padding.
LAMBENT_FN int mosaic_places(ivec2 size, int sub_images) {
  return sub_images * sub_images * sub_image_size(size.y, 0, sub_images) *
         mosaic_stride(size.x, sub_images);
}

LAMBENT_END
#endif
